#pragma once

// What pages are made of beside their contents: scripts, styles, and the engine of live ones.

#include <string>

namespace retrace::report {

struct PageAssets {
  std::string script;  ///< empty: a page without charts and views, to be printed
  std::string style;
  std::string licences;
  // Of live pages; empty of others.
  std::string markup = {};  ///< of the body
  std::string engine_script = {};
  std::string engine_wasm = {};  ///< packed by gzip
};

/// Those that retrace ships, of pages of results ... \throw InputError where they are missing
PageAssets shipped_page_assets();
/// ... and of live pages, whose script does what pages of results need as well.
PageAssets shipped_live_assets();

}  // namespace retrace::report
