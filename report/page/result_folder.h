#pragma once

// Reads the input of `retrace report`: all result documents and pictures in a folder.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/warning.h"

namespace retrace::report {

/// Result document (JSON) of a retrace command.
struct ResultDocument {
  std::string name;  ///< path of the file relative to the result folder
  std::string kind;  ///< kind in the schema, such as "rre" for "retrace.rre/1"
  std::size_t bytes = 0;
  nlohmann::ordered_json json;
};

/// Picture in a result folder.
struct ResultPicture {
  std::string name;  ///< path of the file relative to the result folder
  std::string media_type;
  std::string bytes;
};

/// Content of a result folder and its subfolders.
struct ResultFolder {
  std::string path;
  std::vector<ResultDocument> documents;  ///< sorted by name
  std::vector<ResultPicture> pictures;    ///< sorted by name; PNG files are omitted if there is an SVG of the same name
  /// Files and folders that may be read for the page: the result folder, and the paths that the user has allowed with
  /// --read. Symbolic links in these paths are resolved.
  std::vector<std::filesystem::path> readable{};
  Warnings warnings{};  ///< one warning for each result that was omitted
};

/// Maximum size of a document in bytes.
inline constexpr std::size_t kMaxDocumentBytes = std::size_t{256} << 20;

/// Adds a document or a picture from memory. Does nothing if the extension of `name` is not .json, .svg or .png.
/// \param name file name, whose extension gives the type
/// \param text content of the file
/// \throw InputError if a document is not valid JSON
void add_result(ResultFolder& result, const std::string& name, const std::string& text);

/// Adds a file or a folder to ResultFolder::readable. For a folder, all files in it may be read.
/// \param option name of the command-line option that gives `path`, for messages
/// \throw InputError if the file or folder does not exist
void allow_reading(ResultFolder& result, const std::filesystem::path& path, const std::string& option);

/// Returns true if a file may be read for the page, see ResultFolder::readable. Symbolic links are resolved first, so
/// that a link in the result folder does not give access to files elsewhere.
bool may_read(const ResultFolder& result, const std::filesystem::path& file);

/// Reads all result documents (JSON with a `schema` of retrace) and pictures in a folder and its direct subfolders.
/// Other files are ignored. Links to files outside `folder` are omitted with a warning, unless `named` allows them.
/// \param named files and folders outside `folder` that may be read as well
/// \throw InputError if `folder` is not a folder, if it contains no result document, or if a result document is not
/// valid JSON
ResultFolder read_result_folder(const std::filesystem::path& folder, const std::vector<std::string>& named = {});

}  // namespace retrace::report
