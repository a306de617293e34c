#pragma once

// Parts of a page that do not depend on its content: scripts, styles, and the engine of live pages.

#include <string>

namespace retrace::report {

struct PageAssets {
  std::string script;  ///< script; empty for a page that is printed, which has no charts and views
  std::string style;
  std::string licences;
  // The following members are for live pages. They are empty for other pages.
  std::string markup = {};  ///< markup of the body
  std::string engine_script = {};
  std::string engine_wasm = {};  ///< engine, compressed with gzip
};

/// Returns the shipped assets for pages of results.
/// \throw InputError if a file is missing
PageAssets shipped_page_assets();
/// Returns the shipped assets for live pages. Their script also contains the functions for pages of results.
/// \throw InputError if a file is missing
PageAssets shipped_live_assets();

}  // namespace retrace::report
