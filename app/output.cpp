#include "app/output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json_text.h"
#include "core/message_text.h"

namespace retrace::app {
namespace fs = std::filesystem;
namespace {

/// Returns true if both paths lead to the same file, which need not exist. Hard links to the same file count as equal.
bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  error.clear();
  const auto resolved = [&](const fs::path& path) {
    return fs::weakly_canonical(fs::absolute(path, error), error).lexically_normal();
  };
  const fs::path first = resolved(a);
  return !first.empty() && first == resolved(b) && !error;
}

void refuse_input(const std::string& option, const fs::path& output, const std::vector<std::string>& inputs) {
  std::error_code ignored;
  if (!fs::is_regular_file(output, ignored)) return;
  for (const std::string& input : inputs)
    if (input != "-" && is_same_file(output, input))
      throw InputError({"", 0, option},
                       printable(output.string()) + " is an input file and would be overwritten; give another name");
}

/// Refuses an output file of the option `own` that is also an output file of another option.
/// \throw InputError
void refuse_second(const std::string& own, const fs::path& file, const std::string& option, const fs::path& output) {
  if (own != option && !file.empty() && is_same_file(file, output))
    throw InputError({"", 0, own},
                     printable(file.string()) + " is also the output of " + option + "; give another name");
}

/// Checks that the JSON document can be written. A file in the output folder is not checked, because this folder may
/// still have to be created.
/// \throw OutputError
void check_can_write(const std::string& json, const std::string& out) {
  std::error_code error;
  const fs::path folder = fs::absolute(json).parent_path();
  if (fs::is_directory(json, error)) throw OutputError(json + ": cannot be written: it is a folder");
  const auto parent = [](const std::string& path) { return fs::absolute(path).lexically_normal().parent_path(); };
  if (!out.empty() && parent(json) == parent(out + "/")) return;
  if (!fs::is_directory(folder, error)) throw OutputError(json + ": cannot be written: there is no such folder");
  if (::access(folder.c_str(), W_OK) != 0) throw OutputError(json + ": cannot be written: no permission");
}

}  // namespace

std::string wrote_line(const fs::path& file) {
  return fmt::format("wrote {}\n", printable(file.string(), std::string::npos));
}

bool is_shown_whole(std::string_view table, const CommonOptions& common) {
  return common.out.empty() || static_cast<std::size_t>(std::count(table.begin(), table.end(), '\n')) <= kMaxTableLines;
}

std::string without_middle(const std::string& text, const CommonOptions& common, std::string_view file) {
  if (is_shown_whole(text, common)) return text;
  std::vector<std::string_view> lines;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    const std::size_t length = end == std::string_view::npos ? rest.size() : end + 1;
    lines.push_back(rest.substr(0, length));
    rest.remove_prefix(length);
  }
  constexpr std::size_t kHead = kMaxTableLines / 2;
  constexpr std::size_t kTail = kMaxTableLines - kHead - 1;
  std::string cut;
  for (std::size_t k = 0; k < kHead; ++k) cut += lines[k];
  cut += fmt::format("... {} more lines; all values are in {}\n", lines.size() - kHead - kTail,
                     printable((fs::path(common.out) / file).string(), std::string::npos));
  for (std::size_t k = lines.size() - kTail; k < lines.size(); ++k) cut += lines[k];
  return cut;
}

void print(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw OutputError("standard output: cannot be written");
}

std::vector<std::string> files_read(const std::vector<design::Design>& designs) {
  std::vector<std::string> files;
  for (const design::Design& design : designs) {
    files.push_back(design.source);
    for (const fs::path& file : design.files()) files.push_back(file.string());
  }
  return files;
}

CommonOptions without_folder(CommonOptions options) {
  options.out.clear();
  return options;
}

ResultFiles::ResultFiles(CommonOptions options, std::vector<std::string> inputs, const std::string& document)
    : options_(std::move(options)), inputs_(std::move(inputs)) {
  if (!document.empty() && !options_.out.empty()) document_ = fs::path(options_.out) / document;
}

void ResultFiles::add(const std::string& name, Content content) {
  if (!options_.out.empty()) add_named("--out", fs::path(options_.out) / name, std::move(content));
}

fs::path ResultFiles::reserve(const std::string& name) {
  add(name, {});
  return options_.out.empty() ? fs::path() : files_.back().path;
}

void ResultFiles::add_named(const std::string& option, const fs::path& file, Content content) {
  if (!file.empty()) files_.push_back({option, file, std::move(content)});
}

void ResultFiles::check() const {
  const std::string json = options_.json == "-" ? "" : options_.json;
  if (!json.empty()) refuse_input("--json", json, inputs_);
  for (const File& file : files_) {
    refuse_input(file.option, file.path, inputs_);
    refuse_second("--json", json, file.option, file.path);
    if (file.option == "--out") continue;
    if (!document_.empty()) refuse_second(file.option, file.path, "--out", document_);
    for (const File& other : files_) refuse_second(file.option, file.path, other.option, other.path);
  }
  if (!document_.empty()) refuse_input("--out", document_, inputs_);
}

void ResultFiles::prepare() const {
  check();
  if (!options_.json.empty() && options_.json != "-") check_can_write(options_.json, options_.out);
  if (!options_.out.empty()) make_output_folder(options_.out);
}

ExitCode ResultFiles::write(std::string_view json, std::string_view text, const Warnings& warnings,
                            const Ending& ending) const {
  write_outputs(json, text);
  print_warnings(options_, warnings);
  if (!ending.complete) {
    print_to_stderr("retrace: interrupted; " + ending.interrupted);
    return ExitCode::interrupted;
  }
  return ending.is_yes ? ExitCode::done : ExitCode::answer_is_no;
}

void ResultFiles::write_outputs(std::string_view json, std::string_view text) const {
  std::vector<std::pair<fs::path, std::string>> contents;
  if (!document_.empty()) contents.emplace_back(document_, json);
  for (const File& file : files_)
    if (file.content) contents.emplace_back(file.path, file.content());
  std::string remarks;
  for (const auto& [path, content] : contents) {
    if (content.empty()) continue;
    write_file_atomically(path, content);
    remarks += wrote_line(path);
  }
  if (options_.json == "-") {
    print(json);
    return;
  }
  if (!options_.json.empty()) write_file_atomically(options_.json, json);
  if (!options_.quiet) print(printable_lines(text) + remarks);
}

TextFiles::TextFiles(const CommonOptions& common, std::vector<std::string> inputs)
    : has_file_(!common.out.empty()),
      prints_(!has_file_ && common.json != "-"),
      files_(without_folder(common), std::move(inputs)) {
  files_.add_named("--out", common.out, [text = text_] { return *text; });
  files_.prepare();
}

ExitCode TextFiles::write(std::string_view json, const std::string& text, const Warnings& warnings,
                          const Ending& ending, std::string_view summary) {
  *text_ = text;
  const ExitCode code = files_.write(json, has_file_ ? summary : "", warnings, ending);
  if (prints_) print(text);
  return code;
}

ExitCode write_text(const CommonOptions& common, std::string_view schema, nlohmann::ordered_json content,
                    const std::string& text) {
  TextFiles files(common);
  content["text"] = text;
  return files.write(result_text(schema, std::move(content), {}), text);
}

void print_to_stderr(std::string_view text) {
  std::string line(text);
  // File names may contain line feeds. A message must be one line.
  std::replace(line.begin(), line.end(), '\n', ' ');
  line = printable(line, std::string::npos) + "\n";
  std::fwrite(line.data(), 1, line.size(), stderr);
}

void print_warnings(const CommonOptions& options, const Warnings& warnings) {
  if (options.quiet) return;
  for (const Warning& warning : warnings) print_to_stderr("warning: " + warning.text);
}

}  // namespace retrace::app
