#pragma once

// The live page: one HTML document with the engine in it, in which a design can be changed and its light watched.

#include <string>

#include "report/page/page_assets.h"

namespace retrace::report {

/// What a live page begins with.
struct LiveStart {
  std::string toml;    ///< of the design; empty: templates
  std::string source;  ///< what messages call it
};

/// The elements with the engine and the start that the script asks for, to stand before it.
/// \param is_embedded in a page that has more
std::string live_elements(const LiveStart& start, const PageAssets& assets, bool is_embedded);

/// The whole page, which needs no other file and is not let to ask the network for one.
std::string live_html(const LiveStart& start, const std::string& title, const PageAssets& assets);

}  // namespace retrace::report
