#pragma once

// Designs: arrays of retroreflectors as design files tell them (docs/design_file.md).

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace retrace {

/// A design, read and checked, with its defaults filled in. Copies share what they hold; nothing changes it.
class RETRACE_API Design {
 public:
  /// Reads a design file (retrace.design/1); "-" is standard input.
  /// \param overrides `key=value` texts that take precedence over the file, such as `element.base_mm=0.4`; `key=`
  /// unsets a key
  /// \throw InputError naming file, line and key
  static Design load(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
  /// The same of the text of a design file. \param source stands for the file in messages; files that the text names
  /// are sought from its folder
  static Design parse(std::string_view text, const std::string& source, const std::vector<std::string>& overrides = {});
  /// Returns a copy of the design with some keys changed.
  /// \param overrides texts as in load()
  /// \throw InputError that names the file, line and key, or the override
  Design with(const std::vector<std::string>& overrides) const;

  std::string title() const;   ///< empty if it has none
  std::string source() const;  ///< its file, or what stands for it
  std::string text() const;    ///< of its file, as it was read
  /// What it was read with, so that parse(text(), source(), overrides()) is this design again.
  std::vector<std::string> overrides() const;
  /// Its keys as results quote them, as JSON.
  std::string json() const;
  /// Every file that it names, from the working directory.
  std::vector<std::filesystem::path> files() const;
  /// Returns a warning for each key that has no effect because another key takes precedence over it.
  std::vector<std::string> warnings() const;

  struct Content;
  /// \throw InputError if `content` is null
  explicit Design(std::shared_ptr<const Content> content);
  const Content& content() const { return *content_; }

 private:
  std::shared_ptr<const Content> content_;
};

}  // namespace retrace
