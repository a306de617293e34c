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

/// \param title empty: that of the design
/// \param readable files and folders that may be read for the page, such as the mesh of a design; nothing else is read
/// \throw InputError for no documents, one that is no document of retrace, or a missing file of `readable`
RETRACE_API ReportPage report_page(const std::vector<ReportPart>& parts, const std::string& title = {},
                                   const std::vector<std::string>& readable = {});

}  // namespace retrace
