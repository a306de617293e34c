#pragma once

// Makes the live page: one HTML document that contains the engine. The reader can change a design on this page and see
// the change of its light.

#include <string>

#include "report/page/page_assets.h"

namespace retrace::report {

/// Initial state of a live page.
struct LiveStart {
  std::string toml;    ///< text of the design; if empty, the page offers templates
  std::string source;  ///< name of the design in messages
};

/// Returns the HTML elements with the engine and the initial state. They must precede the script, which reads them.
/// \param is_embedded true if the elements are part of a page with other content
std::string live_elements(const LiveStart& start, const PageAssets& assets, bool is_embedded);

/// Returns the whole page. It needs no other file, and its policy forbids requests to a network.
std::string live_html(const LiveStart& start, const std::string& title, const PageAssets& assets);

}  // namespace retrace::report
