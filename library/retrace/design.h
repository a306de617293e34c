#pragma once

// Designs: arrays of retroreflectors that are described by design files (docs/design_file.md).

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/warning.h"

namespace retrace {

/// A design that has been read and checked, with default values for missing keys. The object is immutable, and copies
/// share their data.
class RETRACE_API Design {
 public:
  /// Reads a design file (format retrace.design/1).
  /// \param file path of the file; "-" is standard input
  /// \param overrides texts `key=value`, which replace values of the file, such as `element.base_mm=0.4`, or `key=`,
  /// which remove a key
  /// \throw InputError with file, line and key
  static Design load(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
  /// Reads a design from the text of a design file.
  /// \param source path of the file, as shown in messages; file names in the text are relative to the folder of this
  /// path
  /// \param overrides texts as in load()
  /// \throw InputError with source, line and key
  static Design parse(std::string_view text, const std::string& source, const std::vector<std::string>& overrides = {});
  /// Returns a copy of the design with some keys changed.
  /// \param overrides texts as in load()
  /// \throw InputError with the file, line and key, or with the override
  Design with(const std::vector<std::string>& overrides) const;

  std::string title() const;   ///< title of the design; empty if there is none
  std::string source() const;  ///< path of the design file, or the `source` that parse() was called with
  std::string text() const;    ///< text of the design file, without overrides
  /// Returns all overrides. parse(text(), source(), overrides()) gives the same design.
  std::vector<std::string> overrides() const;
  /// Returns the keys of the design as JSON, as in result documents.
  std::string json() const;
  /// Returns the paths of all files that the design refers to, relative to the working directory.
  std::vector<std::filesystem::path> files() const;
  /// Returns a warning for each key that has no effect because another key takes precedence over it.
  Warnings warnings() const;

  struct Content;
  /// Wraps a design that was already read. Used inside the library only.
  /// \throw InputError if `content` is null
  explicit Design(std::shared_ptr<const Content> content);
  const Content& content() const { return *content_; }

 private:
  std::shared_ptr<const Content> content_;
};

}  // namespace retrace
