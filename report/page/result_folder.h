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
};

/// Longest document that is read.
inline constexpr std::size_t kLongestDocumentBytes = std::size_t{256} << 20;

/// Adds a document or a picture that is in memory, by the ending of the name of the file that it might be in. What is
/// neither is passed over. \throw InputError for JSON that cannot be read
void add_result(ResultFolder& result, const std::string& name, const std::string& text);

/// Reads all documents of retrace (JSON with a `schema` of its own) in a folder and in the folders in it; other files
/// are passed over. \throw InputError if it is no folder, if there is no result in it, or if one is no JSON
ResultFolder read_result_folder(const std::filesystem::path& folder);

}  // namespace retrace::report
