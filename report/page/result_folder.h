#pragma once

// Collects what the page of `retrace report` is made from: all result documents and pictures in a folder.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace retrace::report {

/// A document that a command of retrace wrote.
struct ResultDocument {
  std::string name;  ///< file, relative to the folder that is reported
  std::string kind;  ///< of its schema: "rre" of "retrace.rre/1"
  std::size_t bytes = 0;
  nlohmann::ordered_json json;
};

/// A picture beside the documents.
struct ResultPicture {
  std::string name;  ///< file, relative to the folder that is reported
  std::string media_type;
  std::string bytes;
};

/// What is in a folder of results and the folders in it.
struct ResultFolder {
  std::string path;
  std::vector<ResultDocument> documents;  ///< by name
  std::vector<ResultPicture> pictures;    ///< by name; drawings (SVG), and PNG where there is no drawing of that name
  /// Paths, without symbolic links, of all files and folders that may be read for the page. They are the result folder
  /// and the files and folders that the user has allowed.
  std::vector<std::filesystem::path> readable{};
  std::vector<std::string> warnings{};  ///< one for each result that was omitted
};

/// Longest document that is read.
inline constexpr std::size_t kLongestDocumentBytes = std::size_t{256} << 20;

/// Adds a document or a picture that is in memory, by the ending of the name of the file that it might be in. What is
/// neither is passed over. \throw InputError for JSON that cannot be read
void add_result(ResultFolder& result, const std::string& name, const std::string& text);

/// Allows the page to read a file or all files in a folder.
/// \param option name of the command-line option, for messages
/// \throw InputError if the file or folder does not exist
void allow_reading(ResultFolder& result, const std::filesystem::path& path, const std::string& option);

/// Returns true if the page may read a file. Symbolic links are resolved first, so that a link in the result folder
/// cannot give access to other files.
bool may_read(const ResultFolder& result, const std::filesystem::path& file);

/// Reads all result documents (JSON with a `schema` of retrace) in a folder and its subfolders. Other files are
/// ignored. Links to files that may not be read are omitted with a warning.
/// \param named files and folders outside `folder` that may also be read
/// \throw InputError if `folder` is not a folder, if it contains no result, or if a result is not valid JSON
ResultFolder read_result_folder(const std::filesystem::path& folder, const std::vector<std::string>& named = {});

}  // namespace retrace::report
