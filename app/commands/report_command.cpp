#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/output.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/text.h"
#include "report/page/scene_view.h"
#include "report/page/sections.h"

namespace retrace::app {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

struct ReportOptions {
  std::string folder;
  std::string title;  ///< title of the page; if empty, the title of the design is used
  Words read;         ///< files and folders outside the result folder that the command may read
};

std::vector<Argument> arguments(ReportOptions& options) {
  return {{"DIR", "folder that other commands wrote with --out", &options.folder, files("/")},
          {"--title TEXT", "title of the page [title of the design]", &options.title},
          {"--read PATH", "file or folder outside DIR that may be read, such as the mesh of a design; repeatable",
           &options.read, files("")}};
}

constexpr const char* kPageName = "report.html";

/// Returns the output file. If --out is an HTML file, it is this file. If --out is a folder, it is report.html in this
/// folder. Without --out, it is report.html in the result folder.
fs::path page_file(const ReportOptions& options, const CommonOptions& common) {
  if (common.out.empty()) return fs::path(options.folder) / kPageName;
  const std::string ending = ending_of(common.out);
  return ending == ".html" || ending == ".htm" ? fs::path(common.out) : fs::path(common.out) / kPageName;
}

/// Checks that the output file in the result folder is not a symbolic link. With a link in a result folder from an
/// untrusted source, the command could otherwise overwrite any file of the user.
/// \throw OutputError if `file` is a symbolic link
void check_is_no_link(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_symlink(file, ignored))
    throw OutputError(file.string() +
                      ": cannot be written: it is a symbolic link; remove it, or name a file with --out");
}

std::vector<std::string> results_read(const report::ResultFolder& folder, const Words& named) {
  std::vector<std::string> files = named;
  for (const auto& document : folder.documents) files.push_back((fs::path(folder.path) / document.name).string());
  for (const auto& picture : folder.pictures) files.push_back((fs::path(folder.path) / picture.name).string());
  return files;
}

std::string report_json(const report::Page& page, const report::ResultFolder& folder, const fs::path& file,
                        std::size_t bytes, const Warnings& warnings) {
  Json documents = Json::array();
  for (const auto& document : folder.documents) documents.push_back(document.name);
  Json sections = Json::array();
  for (const auto& section : page.sections) sections.push_back(section.title);
  const Json json = {{"file", file.string()},
                     {"title", page.title},
                     {"documents", documents},
                     {"sections", sections},
                     {"light_paths", page.scene ? page.scene->paths.size() : 0},
                     {"bytes", bytes}};
  return result_text("retrace.report/1", json, warnings);
}

ExitCode run(const ReportOptions& options, const CommonOptions& common) {
  const report::ResultFolder folder = report::read_result_folder(options.folder, options.read);
  report::Page page = report::study_page(folder, options.title);
  const Warnings warnings = report::add_scene(page, folder);
  report::add_live(page, folder);
  const std::string html = report::page_html(page, report::assets_for(page));
  const fs::path file = page_file(options, common);
  ResultFiles files(without_folder(common), results_read(folder, options.read));
  files.add_named("report", file, [&] { return html; });
  if (file != fs::path(common.out)) check_is_no_link(file);
  files.prepare();
  if (!common.out.empty() && file != fs::path(common.out)) make_output_folder(common.out);
  return files.write(report_json(page, folder, file, html.size(), warnings),
                     fmt::format("{}: documents: {}, sections: {}, {} KiB\n", printable(page.title),
                                 folder.documents.size(), page.sections.size(), html.size() / 1024),
                     warnings);
}

}  // namespace

Command report_command() {
  return {.name = "report",
          .summary = "one self-contained HTML page of a folder of results",
          .manual =
              "Makes one self-contained HTML page, `report.html` in that folder, of the results that other "
              "commands wrote there. It reads no file outside the folder unless `--read` names it.",
          .reads = {"documents and drawings of other commands"},
          .writes = {"retrace.report/1", "HTML"},
          .refuses_set = "not allowed with report, which reads results and no designs",
          .begin = begins<ReportOptions>(arguments, run)};
}

}  // namespace retrace::app
