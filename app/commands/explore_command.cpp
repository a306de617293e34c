#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/output.h"
#include "app/shared_arguments.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/schema/writer.h"
#include "design/file_names.h"
#include "design/io/design_format.h"
#include "design/io/design_reader.h"
#include "report/page/live_page.h"

namespace retrace::app {
namespace {

struct ExploreOptions {
  std::optional<std::string> design;
};

std::vector<Argument> arguments(ExploreOptions& options) {
  return {{"DESIGN", "design file [a page that begins with templates]", &options.design, files(".toml")}};
}

constexpr std::string_view kTitle = "retrace: prism arrays and their light";

/// Returns the design that the page shows first. Its text is the content of the design file, byte for byte, unless
/// --set changes it.
report::LiveStart start_of(const design::Design& design) {
  design::require_no_files(design, "which a self-contained page cannot read");
  design::require_supported(
      design, {.what = "retrace explore", .balls = true, .solids = true, .entrances = true, .wet_backs = true});
  const schema::Document& document = *design.document;
  const bool is_changed = !document.origin().overrides.empty();
  const std::string name =
      design.source == "-" ? "design.toml" : std::filesystem::path(design.source).filename().string();
  return {is_changed ? schema::document_text(design::design_format(), document) : document.origin().text, name};
}

ExitCode run(const ExploreOptions& options, const CommonOptions& common) {
  report::LiveStart start;
  std::string title(kTitle);
  std::vector<std::string> inputs;
  if (options.design) {
    const design::Design design = design::read_design(*options.design, common.overrides);
    start = start_of(design);
    if (!design.title.empty()) title = design.title;
    inputs = files_read({design});
  } else if (!common.overrides.empty()) {
    throw InputError({"", 0, "--set"}, "requires a design");
  }
  TextFiles files(common, inputs);
  const std::string html = report::live_html(start, title, report::shipped_live_assets());
  const nlohmann::ordered_json json = {{"file", common.out}, {"title", title}, {"bytes", html.size()}};
  return files.write(result_text("retrace.explore/1", json, {}), html, {}, {},
                     fmt::format("{}: {} KiB\n", printable(title), html.size() / 1024));
}

}  // namespace

Command explore_command() {
  return {.name = "explore",
          .summary = "an interactive page with the exact engine: change a design and see its light paths",
          .manual =
              "Writes one HTML file that needs no other file and no network: a form with the keys of designs, and next "
              "to it views that are updated with each change: the part with light paths, its footprint, RRE over "
              "incidence and azimuth, the ledger, the far field and the test points of standards. Without a design it "
              "begins with templates.",
          .reads = {"retrace.design/1"},
          .writes = {"retrace.explore/1", "HTML"},
          .begin = begins<ExploreOptions>(arguments, run)};
}

}  // namespace retrace::app
