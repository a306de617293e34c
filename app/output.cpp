#include "app/output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "core/atomic_file.h"
#include "core/error.h"

namespace retrace::app {
namespace fs = std::filesystem;

void print(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw OutputError("standard output: cannot be written");
}

void prepare_outputs(const CommonOptions& options) {
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

void print_warnings(const CommonOptions& options, const std::vector<std::string>& warnings) {
  if (options.quiet) return;
  for (const std::string& warning : warnings) fmt::print(stderr, "warning: {}\n", warning);
}

}  // namespace retrace::app
