#include "report/page/result_folder.h"

#include <algorithm>
#include <set>
#include <system_error>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/message_text.h"
#include "core/text.h"
#include "report/page/former_names.h"

namespace retrace::report {
namespace fs = std::filesystem;
namespace {

/// Maximum size of a picture in a page. Larger pictures are omitted.
constexpr std::uintmax_t kLargestPictureBytes = std::uintmax_t{4} << 20;

/// Returns the files in a folder and in its direct subfolders, sorted by name.
/// \throw InputError if the folder cannot be read
std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    std::error_code ignored;
    if (entry.is_regular_file(ignored)) files.push_back(entry.path());
    if (!entry.is_directory(ignored)) continue;
    for (const fs::directory_entry& inner : fs::directory_iterator(entry.path(), ignored))
      if (inner.is_regular_file(ignored)) files.push_back(inner.path());
  }
  if (error) throw InputError({folder.string(), 0, ""}, "cannot be read: " + error.message());
  std::sort(files.begin(), files.end());
  return files;
}

/// Parses a JSON text and adds it to the documents if it is a result of retrace. Former names of keys are replaced by
/// the current names.
/// \param file path of the file in messages
/// \param name name of the document on the page
/// \throw InputError if the text is not valid JSON but contains "retrace.", or if the version of the document is later
/// than the current version
void add_document(ResultFolder& result, const fs::path& file, const std::string& name, const std::string& text) {
  ResultDocument document;
  try {
    document.json = nlohmann::ordered_json::parse(text);
  } catch (const nlohmann::json::exception&) {
    if (text.find("retrace.") == std::string::npos) return;  // a file of another program
    throw InputError({file.string(), 0, ""}, "the file is not valid JSON; run the command that writes this file again");
  }
  document.kind = schema_of(document.json).kind;
  if (document.kind.empty()) return;
  replace_former_names(document.json, file.string());
  document.name = name;
  document.bytes = text.size();
  result.documents.push_back(std::move(document));
}

/// Returns the absolute path with all symbolic links resolved. The file need not exist. Returns an empty path on
/// failure.
fs::path resolved(const fs::path& path) {
  std::error_code error;
  const fs::path found = fs::weakly_canonical(fs::absolute(path, error), error);
  return error ? fs::path() : found;
}

/// Returns the media type of a picture with the given file extension, or an empty text if it is not a picture.
std::string media_type_of(const std::string& ending) {
  return ending == ".svg" ? "image/svg+xml" : ending == ".png" ? "image/png" : "";
}

}  // namespace

void add_result(ResultFolder& result, const std::string& name, const std::string& text) {
  const std::string ending = ending_of(name);
  if (ending == ".json") add_document(result, name, name, text);
  if (const std::string type = media_type_of(ending); !type.empty()) result.pictures.push_back({name, type, text});
}

void allow_reading(ResultFolder& result, const fs::path& path, const std::string& option) {
  std::error_code ignored;
  if (!fs::exists(path, ignored))
    throw InputError({"", 0, option}, in_quotes(path.string()) + ": there is no such file or folder");
  result.readable.push_back(resolved(path));
}

bool may_read(const ResultFolder& result, const fs::path& file) {
  const fs::path found = resolved(file);
  return std::ranges::any_of(result.readable, [&](const fs::path& root) {
    return !root.empty() && std::mismatch(root.begin(), root.end(), found.begin(), found.end()).first == root.end();
  });
}

ResultFolder read_result_folder(const fs::path& folder, const std::vector<std::string>& named) {
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored))
    throw InputError({folder.string(), 0, ""}, fs::exists(folder, ignored)
                                                   ? "must be the name of a folder of results, but is not a folder"
                                                   : "there is no such folder");
  ResultFolder result;
  result.path = folder.string();
  allow_reading(result, folder, "DIR");
  for (const std::string& path : named) allow_reading(result, path, "--read");
  const std::vector<fs::path> files = files_in(folder);
  const std::set<fs::path> known(files.begin(), files.end());
  for (const fs::path& file : files) {
    const std::string ending = ending_of(file);
    const std::string name = printable(file.lexically_relative(folder).generic_string(), 200);
    const std::string type = media_type_of(ending);
    if (ending != ".json" && type.empty()) continue;
    if (!may_read(result, file)) {
      result.warnings.push_back(
          {"result_outside_folder", name + ": this link was left out, because its file is outside the folder of "
                                           "results; allow the file with --read"});
      continue;
    }
    if (ending == ".json") add_document(result, file, name, read_file(file, kMaxDocumentBytes));
    if (type.empty() || (ending == ".png" && known.contains(fs::path(file).replace_extension(".svg")))) continue;
    if (fs::file_size(file, ignored) > kLargestPictureBytes) continue;
    result.pictures.push_back({name, type, read_file(file)});
  }
  if (result.documents.empty())
    throw InputError(
        {folder.string(), 0, ""},
        "contains no results: it must contain JSON files that commands of retrace wrote with --out, such as rre.json");
  return result;
}

}  // namespace retrace::report
