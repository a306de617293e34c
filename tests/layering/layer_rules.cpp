#include "tests/layering/layer_rules.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace retrace::layering {
namespace fs = std::filesystem;
namespace {

using Names = std::set<std::string>;

/// Layers: the folders that each folder may include, in addition to itself.
const std::map<std::string, Names>& folders() {
  static const std::map<std::string, Names> order = {
      {"core", {}},
      {"requests", {"core"}},
      {"geometry", {"core"}},
      {"materials", {"core"}},
      {"surface_models", {"core", "geometry", "materials"}},
      {"raytrace", {"core", "geometry", "materials", "surface_models"}},
      {"fabrication", {"core", "geometry"}},
      {"studies", {"core", "requests", "geometry", "materials", "surface_models", "raytrace", "fabrication"}},
      {"report", {"core", "geometry", "studies"}},
      {"library", {"core", "requests", "geometry", "materials", "raytrace", "fabrication", "studies", "report"}},
      {"live", {"core", "requests", "geometry", "materials", "surface_models", "raytrace", "studies"}},
      {"python", {"library", "core", "requests"}},
      {"app",
       {"core", "requests", "geometry", "materials", "surface_models", "raytrace", "fabrication", "studies",
        "report"}}};
  return order;
}

/// Subfolders ("rooms") of studies/, and the subfolders that each of them may include. A subfolder is listed after
/// those that it may include.
const std::map<std::string, Names>& study_rooms() {
  static const std::map<std::string, Names> rooms = {
      {"design", {}},
      {"rre", {"design"}},
      {"roughness", {"design", "rre"}},
      {"photometry", {"design", "rre"}},
      {"image", {"design", "rre", "photometry"}},
      {"appearance", {"design", "rre", "photometry"}},
      {"rays", {"design"}},
      {"inspect", {"design"}},
      {"scene", {"design"}},
      {"solids", {"design"}},
      {"drawing", {"design"}},
      {"metrology", {}},
      {"fabrication", {"design"}},
      {"calibration", {"design", "fabrication"}},
      {"forces", {}},
      {"turning", {}},
      {"planing", {}},
      {"closed_loop", {"design"}},
      {"setup", {"design", "rre", "photometry", "fabrication", "closed_loop"}},
      {"store", {}},
      {"quantity", {"design", "rre", "inspect", "photometry", "fabrication", "closed_loop"}},
      {"sweep", {"design", "store", "quantity"}},
      {"optimise", {"design", "store", "quantity", "sweep"}},
      {"compose", {"design", "store", "quantity", "sweep", "optimise"}},
      {"tolerance", {"design", "store", "quantity", "sweep"}},
      {"validation", {"roughness", "quantity"}}};
  return rooms;
}

/// Subfolders ("rooms") of fabrication/, and the subfolders that each of them may include: machine and programs first,
/// then one subfolder for each process.
const std::map<std::string, Names>& fabrication_rooms() {
  static const std::map<std::string, Names> rooms = {{"job", {}},
                                                     {"machine", {}},
                                                     {"program", {"machine"}},
                                                     {"post", {"machine", "program"}},
                                                     {"read", {"machine"}},
                                                     {"check", {"machine", "read"}},
                                                     {"forces", {"job"}},
                                                     {"chisel", {"job", "machine", "program", "read", "check"}},
                                                     {"planing", {"machine", "program", "read", "check"}},
                                                     {"turning", {"machine", "program", "read", "check"}}};
  return rooms;
}

/// Sides of fabrication/: code that plans and writes programs, and code that reads and verifies them. Neither side may
/// include the other, directly or indirectly, because both could then make the same mistakes.
enum class Side { neither, plans, judges };

Side side_of(const std::string& path) {
  const auto lies_in = [&](const char* folder) { return path.find(folder) != std::string::npos; };
  if (!path.starts_with("fabrication/")) return Side::neither;
  if (lies_in("/plan/") || lies_in("/program/") || lies_in("/post/")) return Side::plans;
  return lies_in("/check/") || lies_in("/read/") ? Side::judges : Side::neither;
}

/// Subfolders of studies/ that may include fabrication/, directly or indirectly. A design does not depend on tools.
const Names& rooms_that_see_fabrication() {
  static const Names rooms = {"calibration", "closed_loop", "compose", "fabrication", "forces",  "optimise",  "planing",
                              "quantity",    "setup",       "sweep",   "tolerance",   "turning", "validation"};
  return rooms;
}

/// Returns the subfolder rules of a folder, or null if it has none.
const std::map<std::string, Names>* rooms_of(const std::string& folder) {
  if (folder == "studies") return &study_rooms();
  return folder == "fabrication" ? &fabrication_rooms() : nullptr;
}

/// Returns true for folders that may include everything or contain no code of the program.
bool is_outside_the_layers(const std::string& folder) {
  static const Names outside = {"benchmarks", "build",   "cmake", "data", "docs",
                                "examples",   "install", "tests", "tools"};
  return outside.contains(folder) || folder.starts_with(".");
}

/// Folder and subfolder (room) of a file. The room is empty if the file is not in one.
struct Place {
  std::string folder;
  std::string room;

  bool operator==(const Place&) const = default;
};

Place place_of(const std::string& path) {
  const std::size_t first = path.find('/');
  if (first == std::string::npos) return {};
  const std::size_t second = path.find('/', first + 1);
  return {path.substr(0, first), second == std::string::npos ? "" : path.substr(first + 1, second - first - 1)};
}

bool is_header(const std::string& path) {
  return path.ends_with(".h");
}
bool is_step_module(const std::string& path) {
  return path == "geometry/io/step_module.cpp";
}
bool in_io_room(const std::string& path) {
  return path.find("/io/") != std::string::npos;
}

/// An external library that only a few files may include.
struct Library {
  std::string_view name;
  std::string_view include_prefix;
  std::string_view where;
  std::function<bool(const std::string& path)> may_include;
};

const std::vector<Library>& libraries() {
  static const std::vector<Library> all = {
      {"CGAL", "CGAL/", "geometry/check/ or an io/ room",
       [](const std::string& path) { return path.starts_with("geometry/check/") || in_io_room(path); }},
      {"Embree", "embree", "a .cpp file of raytrace/",
       [](const std::string& path) { return path.starts_with("raytrace/") && !is_header(path); }},
      {"pybind11", "pybind11/", "python/", [](const std::string& path) { return path.starts_with("python/"); }},
      {"fast_float", "fast_float/", "core/leading_number.cpp",
       [](const std::string& path) { return path == "core/leading_number.cpp"; }},
      {"toml++", "toml++/", "core/io/", [](const std::string& path) { return path.starts_with("core/io/"); }},
      {"yaml-cpp", "yaml-cpp/", "materials/io/index_record.cpp",
       [](const std::string& path) { return path == "materials/io/index_record.cpp"; }},
      {"SQLite", "SQLiteCpp/", "a .cpp file of studies/store/",
       [](const std::string& path) { return path.starts_with("studies/store/") && !is_header(path); }},
      {"SQLite", "sqlite3", "a .cpp file of studies/store/",
       [](const std::string& path) { return path.starts_with("studies/store/") && !is_header(path); }},
      {"MPI", "mpi.h", "studies/sweep/mpi_module.cpp",
       [](const std::string& path) { return path == "studies/sweep/mpi_module.cpp"; }},
      {"NLopt", "nlopt", "a .cpp file of studies/optimise/",
       [](const std::string& path) { return path.starts_with("studies/optimise/") && !is_header(path); }},
      {"GLPK", "glpk", "studies/compose/linear_programme.cpp",
       [](const std::string& path) { return path == "studies/compose/linear_programme.cpp"; }},
      {"OpenCASCADE", "STEPControl_", "geometry/io/step_module.cpp", is_step_module},
      {"OpenCASCADE", "TopoDS", "geometry/io/step_module.cpp", is_step_module},
      {"OpenCASCADE", "BRep", "geometry/io/step_module.cpp", is_step_module},
      {"OpenCASCADE", "Geom_", "geometry/io/step_module.cpp", is_step_module},
      {"OpenCASCADE", "gp_", "geometry/io/step_module.cpp", is_step_module},
      {"muParser", "muParser", "core/math/formula.cpp",
       [](const std::string& path) { return path == "core/math/formula.cpp"; }},
      {"OpenImageIO", "OpenImageIO/", "an io/ room", in_io_room},
      {"CLI11", "CLI/", "app/", [](const std::string& path) { return path.starts_with("app/"); }},
      {"FFTW", "fftw3", "a .cpp file of surface_models/",
       [](const std::string& path) { return path.starts_with("surface_models/") && !is_header(path); }},
      {"cairo", "cairo", "a .cpp file of report/",
       [](const std::string& path) { return path.starts_with("report/") && !is_header(path); }}};
  return all;
}

const Library* library_of(const std::string& included) {
  for (const Library& library : libraries())
    if (included.starts_with(library.include_prefix)) return &library;
  return nullptr;
}

struct Include {
  int line = 0;
  bool is_quoted = false;
  std::string target;
};

/// Returns the path of an included file relative to the root of the tree. Installed headers of the library include each
/// other in the way in which users include them.
std::string from_root(const std::string& target, const std::string& path) {
  if ((path.starts_with("library/") || path.starts_with("python/")) && target.starts_with("retrace/"))
    return "library/" + target;
  if (path.starts_with("core/") && (target == "api.h" || target == "field.h")) return "core/" + target;
  return target;
}

std::vector<Include> includes_of(const fs::path& file, const std::string& path) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  static const std::regex directive(R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re");
  std::vector<Include> includes;
  std::string text;
  for (int line = 1; std::getline(stream, text); ++line) {
    std::smatch match;
    if (std::regex_search(text, match, directive))
      includes.push_back({line, match[1] == "\"", from_root(match[2], path)});
  }
  return includes;
}

class Checker {
 public:
  explicit Checker(const fs::path& root) {
    if (!fs::is_directory(root / "core")) throw std::runtime_error("no source tree: " + (root / "core").string());
    for (const fs::directory_entry& top : fs::directory_iterator(root)) {
      const std::string folder = top.path().filename().string();
      if (!top.is_directory() || is_outside_the_layers(folder)) continue;
      for (const fs::directory_entry& entry : fs::recursive_directory_iterator(top.path())) {
        const std::string extension = entry.path().extension().string();
        if (!entry.is_regular_file() || (extension != ".h" && extension != ".cpp")) continue;
        const std::string path = fs::relative(entry.path(), root).generic_string();
        files_[path] = includes_of(entry.path(), path);
      }
    }
    if (files_.empty()) throw std::runtime_error("no source files below " + root.string());
  }

  std::vector<Violation> run() {
    for (const auto& [path, includes] : files_) {
      if (!folders().contains(place_of(path).folder)) {
        report(path, 1, "folder " + place_of(path).folder + "/ has no place in the order of layers");
        continue;
      }
      for (const Include& include : includes) check(path, include);
    }
    return std::move(violations_);
  }

 private:
  void report(const std::string& path, int line, std::string text) {
    violations_.push_back({path, line, std::move(text)});
  }

  void check(const std::string& path, const Include& include) {
    if (const Library* const library = library_of(include.target)) {
      if (!library->may_include(path))
        report(path, include.line,
               std::string(library->name) + " may be included only in " + std::string(library->where));
      return;
    }
    const Place target = place_of(include.target);
    if (!folders().contains(target.folder)) {
      if (include.is_quoted)
        report(path, include.line, "\"" + include.target + "\" is no path from the root of the source tree");
      return;
    }
    check_order(path, include, target);
    check_side(path, include);
    check_fabrication(path, include);
    // Types of an external library must not reach other files indirectly, through a header.
    if (!(place_of(path) == target))
      for (const Library* library : leaked_by(include.target))
        if (!library->may_include(path))
          report(path, include.line, include.target + " brings " + std::string(library->name) + " out of its room");
  }

  void check_order(const std::string& path, const Include& include, const Place& target) {
    const Place from = place_of(path);
    if (target.folder != from.folder && !folders().at(from.folder).contains(target.folder)) {
      report(path, include.line, from.folder + "/ may not include " + include.target);
      return;
    }
    const auto* const rooms = rooms_of(from.folder);
    if (rooms == nullptr || target.folder != from.folder || from.room == target.room) return;
    const auto room = rooms->find(from.room);
    if (room == rooms->end()) {
      report(path, include.line, "room " + from.folder + "/" + from.room + "/ has no place in the order of rooms");
    } else if (!room->second.contains(target.room)) {
      report(path, include.line, from.folder + "/" + from.room + "/ may not include " + include.target);
    }
  }

  void check_side(const std::string& path, const Include& include) {
    const Side side = side_of(path);
    if (side == Side::neither) return;
    for (const std::string& header : reached_from(include.target))
      if (const Side other = side_of(header); other != Side::neither && other != side)
        report(path, include.line,
               std::string(side == Side::plans ? "what plans" : "what judges") + " may not see " + header);
  }

  void check_fabrication(const std::string& path, const Include& include) {
    const Place from = place_of(path);
    if (from.folder != "studies" || rooms_that_see_fabrication().contains(from.room)) return;
    for (const std::string& header : reached_from(include.target))
      if (header.starts_with("fabrication/"))
        report(path, include.line, "studies/" + from.room + "/ may not see " + header);
  }

  /// Returns the files that are included directly or indirectly by `path`, and `path` itself.
  std::set<std::string> reached_from(const std::string& path) const {
    std::set<std::string> seen;
    std::vector<std::string> open = {path};
    while (!open.empty()) {
      const std::string next = open.back();
      open.pop_back();
      if (!seen.insert(next).second) continue;
      if (const auto file = files_.find(next); file != files_.end())
        for (const Include& include : file->second) open.push_back(include.target);
    }
    return seen;
  }

  /// Returns the restricted libraries that `path` includes, directly or through other headers.
  std::set<const Library*> leaked_by(const std::string& path) {
    std::set<const Library*> leaked;
    for (const std::string& header : reached_from(path))
      if (const auto file = files_.find(header); file != files_.end())
        for (const Include& include : file->second)
          if (const Library* const library = library_of(include.target)) leaked.insert(library);
    return leaked;
  }

  std::map<std::string, std::vector<Include>> files_;
  std::vector<Violation> violations_;
};

}  // namespace

std::string to_string(const Violation& violation) {
  return violation.file + ":" + std::to_string(violation.line) + ": " + violation.text;
}

std::vector<Violation> check_tree(const fs::path& root) {
  return Checker(root).run();
}

std::string layer_picture() {
  // A folder is one floor above the highest folder that it may include.
  const std::function<int(const std::string&)> floor_of = [&](const std::string& folder) {
    int floor = 0;
    for (const std::string& below : folders().at(folder)) floor = std::max(floor, floor_of(below) + 1);
    return floor;
  };
  std::vector<std::pair<int, std::string>> order;
  for (const auto& [folder, below] : folders()) order.emplace_back(-floor_of(folder), folder);
  std::sort(order.begin(), order.end());
  std::string picture;
  for (const auto& [floor, folder] : order) {
    std::string names;
    for (const std::string& below : folders().at(folder)) names += (names.empty() ? "" : ", ") + below;
    picture += std::to_string(-floor) + "  " + folder + std::string(16 - folder.size(), ' ') +
               (names.empty() ? "-" : names) + "\n";
  }
  return picture;
}

}  // namespace retrace::layering
