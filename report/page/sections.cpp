#include "report/page/sections.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

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
  if (kind == "inspect") return {"plan", "section", "view", "pin_axes"};
  return {};
}

std::string caption_of(const std::string& picture) {
  if (picture == "far_field") return "Far field with the test points";
  if (picture == "r_a") return "R_A over the observation angle";
  if (picture == "roughing") return "Tool path through one element: roughing";
  if (picture == "finishing") return "Tool path through one element: finishing";
  if (picture == "arrangement") return "The elements in the order in which they are cut";
  if (picture == "plan") return "Plan: the part seen from the light, lengths in mm";
  if (picture == "pin_axes") return "Angles between the axes of the elements and the normal of the entrance surface";
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
/// \param subject name of the design on the cards, see Subjects
void add_efficiencies(const Json& points, double design, const std::string& subject, std::vector<PageFact>& facts) {
  const Json* best = nullptr;
  const Json* normal = nullptr;
  for (const Json& p : points) {
    if (number(p, "design") != design) continue;
    if (best == nullptr || number(p, "rre") > number(*best, "rre")) best = &p;
    if (normal == nullptr && number(p, "incidence_deg") == 0.0) normal = &p;
  }
  if (normal != nullptr)
    facts.push_back({"RRE at normal incidence", percent(number(*normal, "rre")), Rating::none, subject});
  if (best != nullptr && best != normal)
    facts.push_back({fmt::format("Maximum RRE, at {} deg", six_digits(number(*best, "incidence_deg"))),
                     percent(number(*best, "rre")), Rating::none, subject});
}

/// Names of the designs or jobs that documents describe. They are empty unless the folder has several designs or
/// several jobs.
class Subjects {
 public:
  explicit Subjects(const ResultFolder& folder) : folder_(folder), names_(folder) {
    std::set<std::string> jobs;
    for (const ResultDocument& document : folder.documents) jobs.insert(job_of(document));
    jobs.erase("");
    are_several_ = names_.are_several() || jobs.size() > 1;
  }

  std::string of(const ResultDocument& document, double design = 0.0) const {
    if (!are_several_) return {};
    const std::string job = job_of(document);
    return job.empty() ? names_.of(document, design) : job;
  }

  /// Returns the names of all designs of a document, or the name of its job. Documents on footprints and far fields
  /// have the designs of the efficiency document in the same folder.
  std::vector<std::string> all_of(const ResultDocument& document) const {
    if (!are_several_) return {};
    if (!job_of(document).empty()) return {job_of(document)};
    const bool has_designs = document.json.contains("design") || document.json.contains("designs") ||
                             document.kind == "footprint" || document.kind == "far_field";
    std::vector<std::string> all;
    for (std::size_t number = 0; has_designs && number < kMaxNames; ++number) {
      const Json* const design = design_of(folder_, document, static_cast<double>(number));
      if (design == nullptr) break;
      if (const std::string name = names_.of(*design); all.empty() || all.back() != name) all.push_back(name);
    }
    return all;
  }

 private:
  static constexpr std::size_t kMaxNames = 100;  ///< maximum number of designs of a document that are named

  /// Returns the file name of the job or part to which a document on machining refers. Returns an empty text for other
  /// documents.
  static std::string job_of(const ResultDocument& document) {
    for (const char* key : {"job", "part"})
      if (const std::string file = text(document.json, key); !file.empty())
        return std::filesystem::path(file).filename().string();
    return {};
  }

  const ResultFolder& folder_;
  DesignNames names_;
  bool are_several_;
};

/// Sets the name of the design or job of a section, and of its cards, tables and pictures. If the section has several
/// designs, its rows, curves and drawings have names already.
void set_subjects(PageSection& section, const std::vector<std::string>& subjects) {
  constexpr std::size_t max_names = 3;
  section.subject = subjects.size() > max_names ? fmt::format("{} designs", subjects.size())
                                                : fmt::format("{}", fmt::join(subjects, "; "));
  if (subjects.size() != 1) return;
  for (PageFact& fact : section.facts) fact.subject = section.subject;
  for (PageTable& table : section.tables) table.caption += ": " + section.subject;
  for (PageFigure& figure : section.figures)
    if (figure.svg.empty()) figure.caption += ": " + section.subject;
}

void add_summary_facts(const ResultDocument& document, const Subjects& subjects, std::vector<PageFact>& facts) {
  const Json& json = document.json;
  if (document.kind == "rre") {
    std::set<double> designs;
    for (const Json& p : list(json, "points"))
      if (std::isfinite(number(p, "design"))) designs.insert(number(p, "design"));
    for (const double design : designs)
      add_efficiencies(list(json, "points"), design, subjects.of(document, design), facts);
  }
  const std::string subject = subjects.of(document);
  const auto add = [&](const char* name, const std::string& value, Rating rating = Rating::none) {
    facts.push_back({name, value, rating, subject});
  };
  if (document.kind == "inspect") {
    if (const double n = number(json, "elements_full"); std::isfinite(n))
      add("Whole elements", fmt::format("{:.0f}", n));
    if (const double limit = number(json, "tir_limit_deg"); std::isfinite(limit))
      add("Total reflection up to", fixed_visible(limit, 2) + " deg");
  }
  if (document.kind == "photometry") add("Photometry", text(json, "verdict"), rating_of(text(json, "verdict")));
  if (document.kind == "fabrication") add("Machining time", measured(number(json, "time_s") / 3600.0, 2, " h"));
  if (document.kind == "verification") add("Verification", text(json, "verdict"), rating_of(text(json, "verdict")));
}

PageSection summary_section(const ResultFolder& folder) {
  PageSection section = titled("Summary");
  const Subjects subjects(folder);
  for (const auto& [kind, make] : makers())
    for (const ResultDocument& document : folder.documents)
      if (document.kind == kind) add_summary_facts(document, subjects, section.facts);
  const auto is_not_bad = [](const PageFact& fact) { return fact.rating != Rating::bad; };
  std::ranges::stable_sort(section.facts, {}, is_not_bad);  // failures come first
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

/// Makes the titles of sections unique and sets the ids of the sections. Sections with the same title get the names of
/// their designs or jobs if these differ, otherwise the names of their files.
void name_apart(std::vector<PageSection>& sections, const std::vector<std::string>& files) {
  std::map<std::string, std::multiset<std::string>> subjects;  // by title
  for (const PageSection& section : sections) subjects[section.title].insert(section.subject);
  for (std::size_t k = 0; k < sections.size(); ++k) {
    const std::multiset<std::string>& same_title = subjects[sections[k].title];
    const std::set<std::string> different(same_title.begin(), same_title.end());
    if (same_title.size() < 2 || files[k].empty()) continue;
    const bool is_named = different.size() == same_title.size() && !different.contains("");
    sections[k].title += ": " + (is_named ? sections[k].subject : files[k]);
    if (is_named) sections[k].subject.clear();  // the title contains it
  }
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
  const Subjects subjects(folder);
  std::vector<std::string> files = {"", ""};
  page.sections.push_back(summary_section(folder));
  if (design != nullptr) {
    PageSection view;
    view.title = "In three dimensions";
    view.has_scene = true;
    if (names.are_several()) view.subject = names.of(*design);
    page.sections.push_back(std::move(view));
  } else {
    files.pop_back();
  }
  const auto add = [&](const ResultDocument& document, MakeSection make) {
    PageSection section = make(document, folder);
    add_pictures(section, document, folder);
    set_subjects(section, subjects.all_of(document));
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
