#include "retrace/report.h"

#include "report/page/former_names.h"
#include "report/page/page.h"
#include "report/page/result_folder.h"
#include "report/page/scene_view.h"
#include "report/page/sections.h"

namespace retrace {

ReportPage report_page(const std::vector<ReportPart>& parts, const std::string& title,
                       const std::vector<std::string>& readable) {
  report::ResultFolder folder;
  for (const std::string& path : readable) report::allow_reading(folder, path, "read");
  for (const ReportPart& part : parts) report::add_result(folder, part.file, part.text);
  if (folder.documents.empty()) throw InputError({"", 0, "results"}, "must contain a document of retrace");
  report::Page page = report::study_page(folder, title);
  ReportPage made;
  made.warnings = report::add_scene(page, folder);
  report::add_live(page, folder);
  made.html = report::page_html(page, report::assets_for(page));
  return made;
}

std::vector<FormerName> former_names() {
  std::vector<FormerName> names;
  for (const report::FormerName& name : report::former_names()) names.push_back({name.kind, name.former, name.current});
  return names;
}

std::string current_document(const std::string& text) {
  return report::current_document(text);
}

}  // namespace retrace
