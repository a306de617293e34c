#include "report/page/sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "core/number_format.h"
#include "core/version.h"
#include "report/page/design_names.h"
#include "report/page/document_sections.h"
#include "report/page/document_view.h"

namespace retrace::report {
namespace {

using namespace document;

using MakeSection = PageSection (*)(const ResultDocument&, const ResultFolder&);

/// Returns the functions that make sections, in the order of the sections on the page. Optical results come first.
/// Fabrication and verification follow.
const std::vector<std::pair<std::string, MakeSection>>& makers() {
  static const std::vector<std::pair<std::string, MakeSection>> all = {{"inspect", inspect_section},
                                                                       {"rre", rre_section},
                                                                       {"footprint", footprint_section},
                                                                       {"far_field", far_field_section},
                                                                       {"image", image_section},
                                                                       {"photometry", photometry_section},
                                                                       {"roughness", roughness_section},
                                                                       {"sweep", sweep_section},
                                                                       {"optimum", optimum_section},
                                                                       {"fabrication", fabrication_section},
                                                                       {"verification", verification_section},
                                                                       {"forces", forces_section}};
  return all;
}

/// Returns the names (without extension) of the pictures that the page shows for a document of the given kind.
std::vector<std::string> pictures_of(const std::string& kind) {
  if (kind == "photometry") return {"far_field", "r_a"};
  if (kind == "fabrication") return {"roughing", "finishing", "arrangement"};
  if (kind == "metrology") return {"metrology"};
  if (kind == "image") return {"irradiance", "angular", "camera", "false_colour", "road"};
  if (kind == "inspect") return {"plan", "section", "view"};
  return {};
}

std::string caption_of(const std::string& picture) {
  if (picture == "far_field") return "Far field with the test points";
  if (picture == "r_a") return "R_A over the observation angle";
  if (picture == "roughing") return "Tool path through one element: roughing";
  if (picture == "finishing") return "Tool path through one element: finishing";
  if (picture == "arrangement") return "The elements in the order in which they are cut";
  if (picture == "plan") return "Plan: the part seen from the light, lengths in mm";
  if (picture == "section") return "Section across the elements, lengths in mm";
  if (picture == "view") return "The part seen from behind";
  if (picture == "irradiance")
    return "Irradiance divided by that of the beam: light on the detector, and the positions at which it entered";
  if (picture == "angular") return "Fraction of the light per steradian, around the direction back to the source";
  if (picture == "camera") return "Picture of the camera, tones mapped";
  if (picture == "false_colour") return "Luminance in cd/m2, by decades";
  if (picture == "road") return "View of the driver at each distance, tones mapped";
  return picture;
}

std::string folder_of(const std::string& name) {
  const std::size_t slash = name.rfind('/');
  return slash == std::string::npos ? std::string() : name.substr(0, slash + 1);
}

void add_pictures(PageSection& section, const ResultDocument& document, const ResultFolder& folder) {
  for (const std::string& wanted : pictures_of(document.kind))
    for (const ResultPicture& picture : folder.pictures)
      if (picture.name.substr(0, picture.name.rfind('.')) == folder_of(document.name) + wanted)
        section.figures.push_back(
            {caption_of(wanted), "", picture.media_type, picture.bytes, caption_of(wanted) + ", a drawing"});
}

/// Appends the efficiency of one design at normal incidence and its greatest efficiency to `facts`.
/// \param design index of the design
/// \param whose text that is appended to the names of the facts, see Subjects
void add_efficiencies(const Json& points, double design, const std::string& whose, std::vector<PageFact>& facts) {
  const Json* best = nullptr;
  const Json* normal = nullptr;
  for (const Json& p : points) {
    if (number(p, "design") != design) continue;
    if (best == nullptr || number(p, "rre") > number(*best, "rre")) best = &p;
    if (normal == nullptr && number(p, "incidence_deg") == 0.0) normal = &p;
  }
  if (normal != nullptr) facts.push_back({"RRE at normal incidence" + whose, percent(number(*normal, "rre"))});
  if (best != nullptr && best != normal)
    facts.push_back({fmt::format("Maximum RRE, at {} deg{}", six_digits(number(*best, "incidence_deg")), whose),
                     percent(number(*best, "rre"))});
}

/// Determines the texts that are appended to the names of the facts in the summary. If the folder has several designs
/// or several jobs, the name of a fact ends with the name of its design or job, such as "Machining time: job.toml".
class Subjects {
 public:
  explicit Subjects(const ResultFolder& folder) : names_(folder) {
    std::set<std::string> jobs;
    for (const ResultDocument& document : folder.documents) jobs.insert(job_of(document));
    jobs.erase("");
    are_several_ = names_.are_several() || jobs.size() > 1;
  }

  std::string of(const ResultDocument& document, double design = 0.0) const {
    if (!are_several_) return {};
    const std::string job = job_of(document);
    return ": " + (job.empty() ? names_.of(document, design) : job);
  }

 private:
  /// Returns the file name of the job or part to which a document on machining refers. Returns an empty text for other
  /// documents.
  static std::string job_of(const ResultDocument& document) {
    for (const char* key : {"job", "part"})
      if (const std::string file = text(document.json, key); !file.empty())
        return std::filesystem::path(file).filename().string();
    return {};
  }

  DesignNames names_;
  bool are_several_;
};

void add_summary_facts(const ResultDocument& document, const Subjects& subjects, std::vector<PageFact>& facts) {
  const Json& json = document.json;
  if (document.kind == "rre") {
    std::set<double> designs;
    for (const Json& p : list(json, "points"))
      if (std::isfinite(number(p, "design"))) designs.insert(number(p, "design"));
    for (const double design : designs)
      add_efficiencies(list(json, "points"), design, subjects.of(document, design), facts);
  }
  const std::string whose = subjects.of(document);
  if (document.kind == "inspect") {
    if (const double n = number(json, "elements_full"); std::isfinite(n))
      facts.push_back({"Whole elements" + whose, fmt::format("{:.0f}", n)});
    if (const double limit = number(json, "tir_limit_deg"); std::isfinite(limit))
      facts.push_back({"Total reflection up to" + whose, fixed_visible(limit, 2) + " deg"});
  }
  if (document.kind == "photometry")
    facts.push_back({"Photometry" + whose, text(json, "verdict"), rating_of(text(json, "verdict"))});
  if (document.kind == "fabrication")
    facts.push_back({"Machining time" + whose, measured(number(json, "time_s") / 3600.0, 2, " h")});
  if (document.kind == "verification")
    facts.push_back({"Verification" + whose, text(json, "verdict"), rating_of(text(json, "verdict"))});
}

PageSection summary_section(const ResultFolder& folder) {
  PageSection section = titled("Summary");
  const Subjects subjects(folder);
  for (const auto& [kind, make] : makers())
    for (const ResultDocument& document : folder.documents)
      if (document.kind == kind) add_summary_facts(document, subjects, section.facts);
  std::size_t warnings = 0;
  bool is_complete = true;
  for (const ResultDocument& document : folder.documents) {
    warnings += list(document.json, "warnings").size();
    is_complete = is_complete && (flag(document.json, "complete") || !document.json.contains("complete"));
  }
  section.facts.push_back({"Documents", std::to_string(folder.documents.size())});
  if (warnings > 0) section.facts.push_back({"Warnings", fmt::format("{}, see Provenance", warnings), Rating::open});
  if (!is_complete) section.facts.push_back({"Completeness", "interrupted: some results are missing", Rating::bad});
  return section;
}

PageSection provenance_section(const ResultFolder& folder) {
  PageSection section = titled("Provenance");
  section.paragraphs.push_back(
      fmt::format("This page was made by retrace {} from the documents below. The same design, seed and version give "
                  "the same results.",
                  kVersion));
  PageTable table;
  table.caption = "Documents";
  table.csv_name = "documents.csv";
  table.columns = {"file", "schema", "version", "seed", "engine", "complete", "elapsed (s)", "bytes"};
  PageTable warnings;
  warnings.caption = "Warnings";
  warnings.csv_name = "warnings.csv";
  warnings.columns = {"file", "warning"};
  const DesignNames names(folder);
  std::set<std::string> designs;
  for (const ResultDocument& document : folder.documents) {
    const Json& json = document.json;
    table.rows.push_back({document.name, text(json, "schema"), text(json, "version"), cell_of(member(json, "seed")),
                          text(json, "engine"), cell_of(member(json, "complete")), cell_of(member(json, "elapsed_s")),
                          static_cast<double>(document.bytes)});
    for (const std::string& warning : words(list(json, "warnings"))) warnings.rows.push_back({document.name, warning});
    const auto add_design = [&](const Json& design) {
      const std::string content = design.dump(2);
      if (designs.size() < 8 && designs.insert(content).second)
        section.details.emplace_back("Design: " + names.of(design), content);
    };
    if (member(json, "design").is_object()) add_design(member(json, "design"));
    for (const Json& design : list(json, "designs"))
      if (design.is_object()) add_design(design);
  }
  section.tables.push_back(std::move(table));
  if (!warnings.rows.empty()) section.tables.push_back(std::move(warnings));
  return section;
}

/// Makes the titles of sections unique by adding the names of their files, and sets the ids of the sections.
void name_apart(std::vector<PageSection>& sections, const std::vector<std::string>& files) {
  std::map<std::string, int> titles;
  for (const PageSection& section : sections) ++titles[section.title];
  for (std::size_t k = 0; k < sections.size(); ++k)
    if (titles[sections[k].title] > 1 && !files[k].empty()) sections[k].title += ": " + files[k];
  for (std::size_t k = 0; k < sections.size(); ++k) sections[k].id = fmt::format("s{}", k);
}

}  // namespace

const Json* first_design(const ResultFolder& folder) {
  for (const ResultDocument& document : folder.documents) {
    if (const Json& design = member(document.json, "design"); design.is_object()) return &design;
    const Json& designs = list(document.json, "designs");
    if (!designs.empty() && designs.front().is_object()) return &designs.front();
  }
  return nullptr;
}

std::vector<std::array<double, 2>> extreme_directions_deg(const ResultFolder& folder) {
  for (const ResultDocument& document : folder.documents) {
    if (document.kind != "rre") continue;
    std::vector<std::array<double, 2>> all;
    for (const Json& p : list(document.json, "points"))
      if (std::isfinite(number(p, "incidence_deg")) && std::isfinite(number(p, "azimuth_deg")))
        all.push_back({number(p, "incidence_deg"), number(p, "azimuth_deg")});
    if (all.empty()) continue;
    const auto less = [](const auto& a, const auto& b) { return std::abs(a[0]) < std::abs(b[0]); };
    const auto [low, high] = std::minmax_element(all.begin(), all.end(), less);
    if (std::abs((*high)[0]) - std::abs((*low)[0]) < 1.0) return {*low};
    return {*low, *high};
  }
  return {{0.0, 0.0}};
}

Page study_page(const ResultFolder& folder, const std::string& title) {
  Page page;
  page.title = title;
  const Json* const design = first_design(folder);
  const DesignNames names(folder);
  if (page.title.empty() && names.are_several()) page.title = fmt::format("Study of {} designs", names.count());
  if (page.title.empty()) page.title = design != nullptr ? name_of_design(*design) : "Study";
  page.subtitle = fmt::format("Study of a retroreflector, by retrace {}", kVersion);
  std::vector<std::string> files = {"", ""};
  page.sections.push_back(summary_section(folder));
  if (design != nullptr) {
    PageSection view;
    view.title = "In three dimensions";
    view.has_scene = true;
    if (names.are_several()) view.paragraphs.push_back(names.of(*design) + ".");
    page.sections.push_back(std::move(view));
  } else {
    files.pop_back();
  }
  const auto add = [&](const ResultDocument& document, MakeSection make) {
    PageSection section = make(document, folder);
    if (const Json& own = member(document.json, "design"); names.are_several() && own.is_object())
      section.paragraphs.insert(section.paragraphs.begin(), "Design: " + names.of(own) + ".");
    add_pictures(section, document, folder);
    page.sections.push_back(std::move(section));
    files.push_back(document.name);
  };
  std::set<std::string> kinds;
  for (const auto& [kind, make] : makers()) {
    kinds.insert(kind);
    for (const ResultDocument& document : folder.documents)
      if (document.kind == kind) add(document, make);
  }
  for (const ResultDocument& document : folder.documents)
    if (!kinds.contains(document.kind)) add(document, plain_section);
  page.sections.push_back(provenance_section(folder));
  files.emplace_back();
  name_apart(page.sections, files);
  return page;
}

}  // namespace retrace::report
