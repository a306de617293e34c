#include "app/output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/message_text.h"

namespace retrace::app {
namespace fs = std::filesystem;
namespace {

/// Whether both name one file, which need not exist yet. Hard links to one are the same.
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
      throw InputError({"", 0, option}, output.string() + " is a file that is read; it would be overwritten");
}

void refuse_overlaps(const CommonOptions& options, const FileNames& names) {
  const bool has_json = !options.json.empty() && options.json != "-";
  if (has_json) refuse_input("--json", options.json, names.inputs);
  if (options.out.empty()) return;
  for (const std::string& name : names.others) {
    const fs::path output = fs::path(options.out) / name;
    refuse_input("--out", output, names.inputs);
    if (has_json && is_same_file(options.json, output))
      throw InputError({"", 0, "--json"}, options.json + " is a file that --out writes; give another name");
  }
  if (!names.document.empty()) refuse_input("--out", fs::path(options.out) / names.document, names.inputs);
}

}  // namespace

void print(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw OutputError("standard output: cannot be written");
}

std::vector<std::string> files_read(const std::vector<studies::Design>& designs) {
  std::vector<std::string> files;
  for (const studies::Design& design : designs) {
    files.push_back(design.source);
    for (const fs::path& file : design.files()) files.push_back(file.string());
  }
  return files;
}

void check_output_file(const CommonOptions& options, const std::string& option, const fs::path& file,
                       const std::vector<std::string>& inputs) {
  refuse_input(option, file, inputs);
  if (!options.json.empty() && options.json != "-" && is_same_file(options.json, file))
    throw InputError({"", 0, "--json"}, options.json + " is the file that " + option + " writes; give another name");
}

void prepare_outputs(const CommonOptions& options, const FileNames& names) {
  refuse_overlaps(options, names);
  if (!options.json.empty() && options.json != "-") {
    const fs::path folder = fs::absolute(options.json).parent_path();
    if (fs::is_directory(options.json)) throw OutputError(options.json + ": cannot be written: it is a folder");
    const auto parent = [](const std::string& path) { return fs::absolute(path).lexically_normal().parent_path(); };
    const bool to_be_made = !options.out.empty() && parent(options.json) == parent(options.out + "/");
    if (!fs::is_directory(folder) && !to_be_made)
      throw OutputError(options.json + ": cannot be written: there is no such folder");
    if (!to_be_made && ::access(folder.c_str(), W_OK) != 0)
      throw OutputError(options.json + ": cannot be written: no permission");
  }
  if (!options.out.empty()) make_output_folder(options.out);
}

void write_outputs(const CommonOptions& options, std::string_view json, const std::vector<OutputFile>& files,
                   std::string_view text) {
  std::string remarks;
  if (!options.out.empty())
    for (const OutputFile& file : files) {
      const fs::path path = fs::path(options.out) / file.name;
      write_file_atomically(path, file.content);
      remarks += fmt::format("wrote {}\n", path.string());
    }
  if (options.json == "-") {
    print(json);
    return;
  }
  if (!options.json.empty()) write_file_atomically(options.json, json);
  if (!options.quiet) print(std::string(text) + remarks);
}

void say(std::string_view text) {
  std::string line(text);
  // An error is one line, whatever a file is called.
  std::replace(line.begin(), line.end(), '\n', ' ');
  line = printable(line, std::string::npos) + "\n";
  std::fwrite(line.data(), 1, line.size(), stderr);
}

void print_warnings(const CommonOptions& options, const std::vector<std::string>& warnings) {
  if (options.quiet) return;
  for (const std::string& warning : warnings) say("warning: " + warning);
}

}  // namespace retrace::app
