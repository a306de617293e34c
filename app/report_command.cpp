#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/output.h"
#include "core/atomic_file.h"
#include "core/json_text.h"
#include "core/version.h"
#include "report/page/scene_view.h"
#include "report/page/sections.h"
#include "studies/scene/scene.h"

namespace retrace::app {
namespace fs = std::filesystem;
namespace {

constexpr const char* kPageName = "report.html";

/// report.html in the folder of results or in the folder of --out; or the file of --out.
fs::path page_file(const CommandLine& line) {
  if (line.common.out.empty()) return fs::path(line.report.folder) / kPageName;
  const fs::path out = line.common.out;
  return out.extension() == ".html" || out.extension() == ".htm" ? out : out / kPageName;
}

std::vector<std::string> files_read(const report::ResultFolder& folder) {
  std::vector<std::string> files;
  for (const auto& document : folder.documents) files.push_back((fs::path(folder.path) / document.name).string());
  for (const auto& picture : folder.pictures) files.push_back((fs::path(folder.path) / picture.name).string());
  return files;
}

/// A page without its view in three dimensions is better than none.
void add_scene(report::Page& page, const report::ResultFolder& folder, std::vector<std::string>& warnings) {
  const auto* const design = report::first_design(folder);
  if (design == nullptr) return;
  for (report::PageSection& section : page.sections) {
    if (!section.has_scene) continue;
    try {
      std::vector<studies::SceneLight> lights;
      for (const auto& [incidence_deg, azimuth_deg] : report::extreme_directions_deg(folder))
        lights.push_back({incidence_deg, azimuth_deg});
      const studies::DesignScene scene = studies::make_scene(studies::design_of_json(*design), lights);
      page.scene = report::scene_view(scene);
      std::string text =
          "The most frequent ways of light that falls on an element in the middle, each drawn along its strongest "
          "branch.";
      if (!scene.remarks.empty()) text += fmt::format(" For the eye, {}.", fmt::join(scene.remarks, ", "));
      section.paragraphs.push_back(text);
    } catch (const Error& error) {
      section.paragraphs.push_back(std::string("The design cannot be shown here: ") + error.what());
      warnings.push_back(std::string("no view in three dimensions: ") + error.what());
    }
  }
}

std::string report_json(const report::Page& page, const report::ResultFolder& folder, const fs::path& file,
                        std::size_t bytes, const std::vector<std::string>& warnings) {
  using Json = nlohmann::ordered_json;
  Json documents = Json::array();
  for (const auto& document : folder.documents) documents.push_back(document.name);
  Json sections = Json::array();
  for (const auto& section : page.sections) sections.push_back(section.title);
  return to_text({{"schema", "retrace.report/1"},
                  {"file", file.string()},
                  {"title", page.title},
                  {"documents", documents},
                  {"sections", sections},
                  {"light_paths", page.scene ? page.scene->paths.size() : 0},
                  {"bytes", bytes},
                  {"version", kVersion},
                  {"warnings", warnings},
                  {"complete", true}});
}

}  // namespace

ExitCode run_report_command(const CommandLine& line) {
  if (!line.common.overrides.empty()) throw InputError({"", 0, "--set"}, "report reads results, not designs");
  const report::ResultFolder folder = report::read_result_folder(line.report.folder);
  report::Page page = report::study_page(folder, line.report.title);
  std::vector<std::string> warnings;
  add_scene(page, folder, warnings);
  const std::string html = report::page_html(page, report::shipped_page_assets());
  const fs::path file = page_file(line);
  CommonOptions outputs = line.common;
  outputs.out.clear();
  prepare_outputs(outputs, {files_read(folder), "", {}});
  if (!outputs.json.empty() && fs::absolute(outputs.json).lexically_normal() == fs::absolute(file).lexically_normal())
    throw InputError({"", 0, "--json"}, outputs.json + " is the page itself; give another name");
  if (!line.common.out.empty() && file != fs::path(line.common.out)) make_output_folder(line.common.out);
  write_file_atomically(file, html);
  write_outputs(outputs, report_json(page, folder, file, html.size(), warnings), {},
                fmt::format("{}: {} documents, {} sections, {} KiB\nwrote {}\n", page.title, folder.documents.size(),
                            page.sections.size(), html.size() / 1024, file.string()));
  print_warnings(line.common, warnings);
  return ExitCode::done;
}

}  // namespace retrace::app
