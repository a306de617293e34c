#pragma once

// Creates one HTML page from several results, and converts results of former versions to the current version.

#include <string>
#include <vector>

#include "core/error.h"
#include "core/warning.h"

namespace retrace {

/// Input of a page: a result document or a drawing.
struct ReportPart {
  std::string file;  ///< file name, whose extension gives the type of the content: .json, .svg or .png
  std::string text;  ///< content of the file
};

struct ReportPage {
  std::string html;  ///< self-contained HTML file, which needs no other file and no network
  Warnings warnings;
};

/// Returns an HTML page of results.
/// \param parts result documents and drawings
/// \param title title of the page; if empty, the title of the design is used
/// \param readable files and folders that the function may read, such as the mesh of a design. It reads no other files.
/// \throw InputError if `parts` contains no result document, if a document is not valid JSON, or if a file or folder of
/// `readable` does not exist
RETRACE_API ReportPage report_page(const std::vector<ReportPart>& parts, const std::string& title = {},
                                   const std::vector<std::string>& readable = {});

/// Key of result documents that has been renamed, see former_names().
struct FormerName {
  std::string kind;  ///< kind of the document, such as "inspect"; empty for keys of designs in all documents
  /// Path of the key in documents of former versions. "[]" is appended to the name of a list. If the value was renamed
  /// and not the key, "=" and the former value are appended.
  std::string former;
  std::string current;  ///< path in documents of the current version, in the same form as `former`
};

/// Returns all renamed keys and values of result documents.
RETRACE_API std::vector<FormerName> former_names();

/// Converts a result document to the current version: former names and `schema` are replaced by the current ones. A
/// document of the current version is returned unchanged.
/// \param text the document as JSON; any other text is returned unchanged
/// \throw InputError if the version of the document is later than the current version
RETRACE_API std::string current_document(const std::string& text);

}  // namespace retrace
