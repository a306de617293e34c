#pragma once

// One page of several results.

#include <string>
#include <vector>

#include "core/error.h"

namespace retrace {

/// What a page is made from: a document, or the drawing of one.
struct ReportPart {
  std::string file;  ///< name of a file that it might be in, by whose ending it is told: .json, .svg or .png
  std::string text;
};

struct ReportPage {
  std::string html;  ///< a file that needs no other and no network
  std::vector<std::string> warnings;
};

/// Returns an HTML page of results.
/// \param title title of the page; if it is empty, the title of the design is used
/// \param readable files and folders that may be read for the page, such as the mesh of a design; nothing else is read
/// \throw InputError if there are no documents, if one is not a document of retrace, or if a file of `readable` is
/// missing
RETRACE_API ReportPage report_page(const std::vector<ReportPart>& parts, const std::string& title = {},
                                   const std::vector<std::string>& readable = {});

}  // namespace retrace
