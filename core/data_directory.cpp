#include "core/data_directory.h"

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include "core/error.h"
#include "core/installation.h"

namespace retrace {
namespace fs = std::filesystem;

fs::path data_directory() {
  std::error_code ignored;
  if (const char* chosen = std::getenv("RETRACE_DATA_DIR"); chosen != nullptr && *chosen != '\0') {
    if (!fs::is_directory(chosen, ignored))
      throw InputError(
          std::string("the environment variable RETRACE_DATA_DIR must be the name of an existing folder, got ") +
          chosen);
    return chosen;
  }
  fs::path folder = installation_folder() / "share" / "retrace";
  if (!fs::is_directory(folder, ignored))
    throw InputError("the data folder " + folder.string() +
                     " is missing; set RETRACE_DATA_DIR to retrace's data folder");
  return folder;
}

fs::path schema_file(std::string_view format) {
  fs::path file = installation_folder() / "share" / "retrace_schemas" / (std::string(format) + ".schema.json");
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) throw InputError(file.string() + ": is missing; retrace schema prints it");
  return file;
}

std::vector<fs::path> shipped_files(std::string_view folder) {
  const fs::path place = data_directory() / folder;
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(place, error))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  if (error) throw InputError(place.string() + ": cannot be read");
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace retrace
