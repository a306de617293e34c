#pragma once

// Makes one HTML page of several results.

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

}  // namespace retrace
