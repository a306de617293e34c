#pragma once

// Everything that commands print or write: checks of the output files before the work, the files themselves after it,
// and lines on standard error.

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/command.h"
#include "studies/design/design.h"

namespace retrace::app {

/// Writes to standard output. \throw OutputError if that fails
void print(std::string_view text);

/// Returns a line of output which says that a file was written.
std::string wrote_line(const std::filesystem::path& file);

/// The files that designs come from, with those that they name.
std::vector<std::string> files_read(const std::vector<studies::Design>& designs);

/// The same options of a command whose --out is no folder.
CommonOptions without_folder(CommonOptions options);

/// How work ended.
struct Ending {
  bool complete = true;  ///< else it was interrupted
  std::string interrupted = "what is finished is in the result";
  bool is_yes = true;  ///< the answer to what was asked
};

/// The files of a result, each named once: before the work they are checked, after it they are made and written.
class ResultFiles {
 public:
  using Content = std::function<std::string()>;

  /// \param inputs every file that the command reads
  /// \param document file in the output folder that holds the same as --json; empty: none
  ResultFiles(CommonOptions options, std::vector<std::string> inputs, const std::string& document = {});

  /// A file in the output folder. What makes its content is called by write(); an empty content leaves the file out.
  void add(const std::string& name, Content content);
  /// The drawing of a plot in the output folder, as NAME.svg and NAME.png. \param plot makes the plot
  template <class Plot>
  void add_drawing(const std::string& name, Plot plot);
  /// A file in the output folder that something else writes. \return its path; empty without such a folder
  std::filesystem::path reserve(const std::string& name);
  /// A file that an option names; none if that is empty.
  void add_named(const std::string& option, const std::filesystem::path& file, Content content);

  /// Refuses outputs that would replace a file that is read, by whatever path or link, or each other. \throw InputError
  void check() const;
  /// The same, and refuses outputs that cannot be written; makes the output folder. To be called before anything is
  /// written. \throw InputError, OutputError
  void prepare() const;
  /// Writes the JSON document and the other files to the paths that the options give. Then prints `text` and the names
  /// of the written files to standard output, unless `--quiet` or `--json -` is given; control characters are printed
  /// as escapes. Finally prints the warnings, and a message if the work was interrupted, to standard error.
  /// \return the exit code
  /// \throw OutputError if a file or standard output cannot be written
  ExitCode write(std::string_view json, std::string_view text, const std::vector<std::string>& warnings = {},
                 const Ending& ending = {}) const;

 private:
  void write_outputs(std::string_view json, std::string_view text) const;

  struct File {
    std::string option;
    std::filesystem::path path;
    Content content;  ///< none: written by something else, or the document
  };

  CommonOptions options_;
  std::vector<std::string> inputs_;
  std::filesystem::path document_;  ///< empty: none
  std::vector<File> files_;
};

template <class Plot>
void ResultFiles::add_drawing(const std::string& name, Plot plot) {
  const auto made = std::make_shared<std::optional<decltype(plot())>>();
  const auto once = [ made, plot ]() -> const auto& {
    if (!*made) *made = plot();
    return **made;
  };
  add(name + ".svg", [once] { return render_svg(once()); });
  add(name + ".png", [once] { return render_png(once()); });
}

/// Output of a command whose result is a text, such as a job file or a page. The text is written to the file that --out
/// names. Without --out it is printed unchanged to standard output, even if --quiet is given; with `--json -` it is not
/// printed.
class TextFiles {
 public:
  /// Checks the output files in the same way as ResultFiles::prepare().
  /// \param inputs every file that the command reads
  /// \throw InputError, OutputError
  explicit TextFiles(const CommonOptions& common, std::vector<std::string> inputs = {});

  /// Writes the result in the same way as ResultFiles::write(), and prints the text if --out is not given.
  /// \param summary text for standard output if the result is written to a file
  ExitCode write(std::string_view json, const std::string& text, const std::vector<std::string>& warnings = {},
                 const Ending& ending = {}, std::string_view summary = {});

 private:
  bool has_file_;
  bool prints_;
  std::shared_ptr<std::string> text_ = std::make_shared<std::string>();
  ResultFiles files_;
};

/// Writes a text that is the result itself. \param content of the document of --json, to which the text is added
/// \throw InputError, OutputError
ExitCode write_text(const CommonOptions& common, std::string_view schema, nlohmann::ordered_json content,
                    const std::string& text);

/// One line on standard error, free of control characters. A closed standard error is no failure.
void say(std::string_view text);

/// Warnings on standard error, one line each, unless `--quiet`.
void print_warnings(const CommonOptions& options, const std::vector<std::string>& warnings);

}  // namespace retrace::app
