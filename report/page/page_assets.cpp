#include "report/page/page_assets.h"

#include "core/atomic_file.h"
#include "core/data_directory.h"

namespace retrace::report {

PageAssets shipped_page_assets() {
  const auto folder = data_directory() / "report_page";
  return {read_file(folder / "page.js"), read_file(folder / "page.css"), read_file(folder / "LICENCES.txt")};
}

PageAssets shipped_live_assets() {
  const auto folder = data_directory() / "live_page";
  const auto text = [&](const char* name) { return read_file(folder / name); };
  return {text("page.js"),   text("page.css"),  text("LICENCES.txt") + "\n" + text("ENGINE_LICENCES.txt"),
          text("page.html"), text("engine.js"), text("engine.wasm.gz")};
}

}  // namespace retrace::report
