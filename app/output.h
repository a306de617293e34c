#pragma once

// Output of commands: checks of the output files before the computation, writing of these files after it, and lines on
// standard error.

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/command.h"
#include "core/warning.h"
#include "design/design.h"

namespace retrace::app {

/// Writes a text to standard output.
/// \throw OutputError if the text cannot be written
void print(std::string_view text);

/// Returns the line "wrote FILE", which is printed after a file was written.
std::string wrote_line(const std::filesystem::path& file);

/// Maximum number of lines on the terminal of a table that is also in the output folder. Together with the names of the
/// files, these are at most 30 lines.
inline constexpr std::size_t kMaxTableLines = 22;

/// Returns true if the terminal shows all lines of a table: if it has at most kMaxTableLines lines, or if the command
/// has no output folder.
bool is_shown_whole(std::string_view table, const CommonOptions& common);

/// Returns a text without its middle lines unless is_shown_whole() is true. A line gives the number of lines that are
/// left out.
/// \param file name of the file in the output folder that contains all values
std::string without_middle(const std::string& text, const CommonOptions& common, std::string_view file);

/// Returns the files of the designs and all files that the designs refer to.
std::vector<std::string> files_read(const std::vector<design::Design>& designs);

/// Returns the options without --out, for commands in which --out is a file instead of a folder.
CommonOptions without_folder(CommonOptions options);

/// State of a command when it ends. It determines the exit code and the last message.
struct Ending {
  bool complete = true;  ///< false if the command was interrupted
  /// Text after "interrupted; " in the message about an interrupt.
  std::string interrupted = "the result contains what was finished";
  bool is_yes = true;  ///< false if the result is negative, such as a missed limit: exit code 1
};

/// Output files of a command. They are registered and checked before the computation, and written after it.
class ResultFiles {
 public:
  using Content = std::function<std::string()>;

  /// \param inputs every file that the command reads
  /// \param document name of the JSON document in the output folder, which has the same content as the file of --json.
  /// If empty, no such document is written.
  ResultFiles(CommonOptions options, std::vector<std::string> inputs, const std::string& document = {});

  /// Adds a file in the output folder.
  /// \param content function that returns the content of the file; write() calls it. A file with an empty content is
  /// not written.
  void add(const std::string& name, Content content);
  /// Adds a drawing in the output folder, as NAME.svg and NAME.png.
  /// \param plot function that returns the plot
  /// \param is_available function that returns false if there is nothing to draw, so that no file is written; empty:
  /// the drawing is always available
  template <class Plot>
  void add_drawing(const std::string& name, Plot plot, std::function<bool()> is_available = {});
  /// Adds a file in the output folder that this class checks but does not write. The caller writes it.
  /// \return path of the file; empty if there is no output folder
  std::filesystem::path reserve(const std::string& name);
  /// Adds an output file whose name is given by an option. Does nothing if `file` is empty.
  void add_named(const std::string& option, const std::filesystem::path& file, Content content);

  /// Checks that no output file is also an input file or another output file. Files are compared after links are
  /// resolved.
  /// \throw InputError
  void check() const;
  /// Calls check(), checks that the output files can be written, and creates the output folder. Call it before anything
  /// is written.
  /// \throw InputError, OutputError
  void prepare() const;
  /// Writes the JSON document and the other files. Then prints `text` and the names of the written files to standard
  /// output, unless `--quiet` or `--json -` is given. Control characters are printed as escapes. Finally prints the
  /// warnings to standard error, and a message if the command was interrupted.
  /// \return the exit code
  /// \throw OutputError if a file or standard output cannot be written
  ExitCode write(std::string_view json, std::string_view text, const Warnings& warnings = {},
                 const Ending& ending = {}) const;

 private:
  void write_outputs(std::string_view json, std::string_view text) const;

  struct File {
    std::string option;
    std::filesystem::path path;
    Content content;  ///< function that returns the content; empty if the caller writes the file
  };

  CommonOptions options_;
  std::vector<std::string> inputs_;
  std::filesystem::path document_;  ///< JSON document in the output folder; empty if there is no such document
  std::vector<File> files_;
};

template <class Plot>
void ResultFiles::add_drawing(const std::string& name, Plot plot, std::function<bool()> is_available) {
  const auto made = std::make_shared<std::optional<decltype(plot())>>();
  const auto once = [ made, plot ]() -> const auto& {
    if (!*made) *made = plot();
    return **made;
  };
  const auto drawn_if_available = [is_available = std::move(is_available)](auto draw) -> Content {
    return [is_available, draw] { return is_available && !is_available() ? std::string() : draw(); };
  };
  add(name + ".svg", drawn_if_available([once] { return render_svg(once()); }));
  add(name + ".png", drawn_if_available([once] { return render_png(once()); }));
}

/// Output of a command whose result is a text, such as a job file or a page. The text is written to the file of --out.
/// Without --out, the text is printed unchanged to standard output, even if --quiet is given. With `--json -`, the text
/// is not printed.
class TextFiles {
 public:
  /// Checks the output files in the same way as ResultFiles::prepare().
  /// \param inputs every file that the command reads
  /// \throw InputError, OutputError
  explicit TextFiles(const CommonOptions& common, std::vector<std::string> inputs = {});

  /// Writes the result in the same way as ResultFiles::write(), and prints the text if --out is not given.
  /// \param summary text for standard output if the result is written to a file
  ExitCode write(std::string_view json, const std::string& text, const Warnings& warnings = {},
                 const Ending& ending = {}, std::string_view summary = {});

 private:
  bool has_file_;
  bool prints_;
  std::shared_ptr<std::string> text_ = std::make_shared<std::string>();
  ResultFiles files_;
};

/// Writes a result that is a text.
/// \param content other keys of the JSON document; the key `text` is added
/// \throw InputError, OutputError
ExitCode write_text(const CommonOptions& common, std::string_view schema, nlohmann::ordered_json content,
                    const std::string& text);

/// Writes one line to standard error. Control characters are printed as escapes. Write errors are ignored.
void print_to_stderr(std::string_view text);

/// Writes warnings to standard error, one line each. Does nothing if --quiet is given.
void print_warnings(const CommonOptions& options, const Warnings& warnings);

}  // namespace retrace::app
