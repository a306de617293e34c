#include "tests/layering/layer_rules.h"

#include <algorithm>
#include <cctype>
#include <compare>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace retrace::layering {
namespace fs = std::filesystem;
namespace {

/// Returns the folders or rooms of a table with the names that each of them may include.
Order order_of(const nlohmann::ordered_json& table) {
  Order order;
  for (const auto& [name, lower] : table.items()) {
    for (const std::string& other : lower.get<Names>())
      if (!order.contains(other)) throw std::runtime_error(name + " is not listed after " + other);
    order[name] = lower.get<Names>();
  }
  return order;
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

  auto operator<=>(const Place&) const = default;
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
bool uses_step_library(const std::string& path) {
  return path == "geometry/io/step_module.cpp" || path.starts_with("geometry/io/step_program/");
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
      {"SQLite", "SQLiteCpp/", "a .cpp file of compute/store/",
       [](const std::string& path) { return path.starts_with("compute/store/") && !is_header(path); }},
      {"SQLite", "sqlite3", "a .cpp file of compute/store/",
       [](const std::string& path) { return path.starts_with("compute/store/") && !is_header(path); }},
      {"MPI", "mpi.h", "compute/ranks/mpi_module.cpp",
       [](const std::string& path) { return path == "compute/ranks/mpi_module.cpp"; }},
      {"NLopt", "nlopt", "a .cpp file of studies/optimise/",
       [](const std::string& path) { return path.starts_with("studies/optimise/") && !is_header(path); }},
      {"GLPK", "glpk", "compute/linear/linear_programme.cpp",
       [](const std::string& path) { return path == "compute/linear/linear_programme.cpp"; }},
      {"OpenCASCADE", "STEPControl_", "geometry/io/step_module.cpp or geometry/io/step_program/", uses_step_library},
      {"OpenCASCADE", "TopoDS", "geometry/io/step_module.cpp or geometry/io/step_program/", uses_step_library},
      {"OpenCASCADE", "BRep", "geometry/io/step_module.cpp or geometry/io/step_program/", uses_step_library},
      {"OpenCASCADE", "Geom_", "geometry/io/step_module.cpp or geometry/io/step_program/", uses_step_library},
      {"OpenCASCADE", "gp_", "geometry/io/step_module.cpp or geometry/io/step_program/", uses_step_library},
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

/// A header that a file includes, or a header that declares a type that the file uses.
struct Reference {
  int line = 0;
  bool is_quoted = false;
  std::string header;
  std::string type;  ///< name of the type; empty for an include

  std::string text() const { return (type.empty() ? "include " : "use " + type + " of ") + header; }
};

/// A source file: its includes, and the names in its code.
struct Source {
  std::vector<Reference> includes;
  std::map<std::string, int> names;       ///< names that begin with an upper-case letter, with their first lines
  std::map<std::string, int> namespaces;  ///< names before `::` and after `using namespace`, with their first lines
  Names types;                            ///< types of a header that are declared outside of classes and functions
  Names other_types;                      ///< the remaining types, and parameters of templates
};

/// Returns the path of an included file relative to the root of the tree. Installed headers of the library name each
/// other by their paths after installation.
std::string from_root(const std::string& header, const std::string& path) {
  if ((path.starts_with("library/") || path.starts_with("python/")) && header.starts_with("retrace/"))
    return "library/" + header;
  if (path.starts_with("core/") && (header == "api.h" || header == "field.h")) return "core/" + header;
  return header;
}

std::vector<Reference> includes_of(const std::string& text, const std::string& path) {
  static const std::regex directive(R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re");
  std::vector<Reference> includes;
  std::istringstream stream(text);
  std::string row;
  for (int line = 1; std::getline(stream, row); ++line) {
    std::smatch match;
    if (std::regex_search(row, match, directive))
      includes.push_back({line, match[1] == "\"", from_root(match[2], path), {}});
  }
  return includes;
}

bool is_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Replaces comments and literals by spaces. Ends of lines are kept.
std::string code_of(std::string text) {
  const auto blank = [&](std::size_t from, std::size_t until) {
    until = std::min(until, text.size());
    for (std::size_t k = from; k < until; ++k)
      if (text[k] != '\n') text[k] = ' ';
    return until;
  };
  const auto after = [&](std::string_view mark, std::size_t from) {
    const std::size_t found = text.find(mark, from);
    return found == std::string::npos ? text.size() : found + mark.size();
  };
  for (std::size_t k = 0; k < text.size();) {
    if (text.compare(k, 2, "//") == 0) {
      k = blank(k, text.find('\n', k));
    } else if (text.compare(k, 2, "/*") == 0) {
      k = blank(k, after("*/", k + 2));
    } else if (text.compare(k, 2, "R\"") == 0) {
      const std::string mark = ")" + text.substr(k + 2, text.find('(', k) - k - 2) + "\"";
      k = blank(k, after(mark, k));
    } else if (text[k] == '"' || (text[k] == '\'' && (k == 0 || !is_of_name(text[k - 1])))) {
      std::size_t end = k + 1;
      while (end < text.size() && text[end] != text[k]) end += text[end] == '\\' ? 2U : 1U;
      k = blank(k, end + 1);
    } else {
      ++k;
    }
  }
  return text;
}

/// Collects the names in the code of a source file.
class NameReader {
 public:
  NameReader(const std::string& code, bool is_header, Source& source)
      : code_(code), is_header_(is_header), source_(source) {}

  void read() {
    int line = 1;
    for (std::size_t k = 0; k < code_.size();) {
      if (code_[k] == '\n') ++line;
      if (!is_of_name(code_[k])) {
        ++k;
        continue;
      }
      const std::size_t begin = k;
      while (k < code_.size() && is_of_name(code_[k])) ++k;
      take(code_.substr(begin, k - begin), line, begin == 0 || code_[begin - 1] == '\n', k);
    }
  }

 private:
  /// Processes one word.
  /// \param end position after the word
  void take(const std::string& word, int line, bool starts_line, std::size_t end) {
    static const Names keys = {"class", "struct", "union", "enum", "typename", "concept", "using"};
    const std::size_t next = std::min(code_.find_first_not_of(" \n", end), code_.size());
    const bool is_qualifier = code_.compare(next, 2, "::") == 0;
    if (is_qualifier || (last_ == "namespace" && last_but_one_ == "using")) source_.namespaces.emplace(word, line);
    if (std::isupper(static_cast<unsigned char>(word[0])) != 0) source_.names.emplace(word, line);
    if (keys.contains(word)) {
      // Both words of `enum class` are keywords. Only the position of `enum` in its line counts.
      if (last_ != "enum") key_starts_line_ = starts_line;
      key_ = last_ == "friend" || last_ == "using" ? "" : word;
    } else if (!key_.empty() && !is_qualifier && !word.starts_with("RETRACE_")) {
      declare(word, next);
      key_.clear();
    }
    last_but_one_ = std::exchange(last_, word);
  }

  /// Processes the name after a keyword such as `class`.
  /// \param next position of the first character after the name
  void declare(const std::string& name, std::size_t next) {
    const bool is_final = code_.compare(next, 6, "final ") == 0;
    if (next >= code_.size() || (is_of_name(code_[next]) && !is_final)) return;  // a use, as in `struct tm time`
    if (key_ == "using" && code_[next] != '=') return;
    const bool is_forward =
        key_ != "using" && code_[std::min(code_.find_first_of("{;>", next), code_.size() - 1)] == ';';
    if (is_forward && key_starts_line_) return;
    (key_starts_line_ && is_header_ ? source_.types : source_.other_types).insert(name);
  }

  const std::string& code_;
  bool is_header_;
  Source& source_;
  std::string last_, last_but_one_;
  std::string key_;  ///< keyword of a declaration whose name has not been read yet; empty if there is none
  bool key_starts_line_ = false;
};

Source read_source(const fs::path& file, const std::string& path) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  Source source;
  source.includes = includes_of(text, path);
  NameReader(code_of(text), is_header(path), source).read();
  return source;
}

class Checker {
 public:
  Checker(const fs::path& root, const Rules& rules) : rules_(rules) {
    if (!fs::is_directory(root / "core")) throw std::runtime_error("no source tree: " + (root / "core").string());
    for (const fs::directory_entry& top : fs::directory_iterator(root)) {
      const std::string folder = top.path().filename().string();
      if (!top.is_directory() || is_outside_the_layers(folder)) continue;
      for (const fs::directory_entry& entry : fs::recursive_directory_iterator(top.path())) {
        const std::string extension = entry.path().extension().string();
        if (!entry.is_regular_file() || (extension != ".h" && extension != ".cpp")) continue;
        const std::string path = fs::relative(entry.path(), root).generic_string();
        files_[path] = read_source(entry.path(), path);
      }
    }
    if (files_.empty()) throw std::runtime_error("no source files below " + root.string());
    find_headers_of_types();
  }

  std::vector<Violation> run() {
    for (const auto& [path, source] : files_) {
      if (!rules_.folders.contains(place_of(path).folder)) {
        report(path, 1, "folder " + place_of(path).folder + "/ has no place in the order of layers");
        continue;
      }
      for (const Reference& include : source.includes) check_include(path, include);
      check_names(path, source);
    }
    return std::move(violations_);
  }

 private:
  /// Finds the headers of all types whose name is declared in a single folder or room, and on one side of fabrication/.
  void find_headers_of_types() {
    std::map<std::string, std::set<std::pair<Place, Side>>> places;
    for (const auto& [path, source] : files_) {
      for (const std::string& type : source.types) header_of_type_[type] = path;
      for (const Names* types : {&source.types, &source.other_types})
        for (const std::string& type : *types) places[type].emplace(place_of(path), side_of(path));
    }
    std::erase_if(header_of_type_, [&](const auto& entry) { return places[entry.first].size() > 1; });
  }

  void report(const std::string& path, int line, std::string text) {
    violations_.push_back({path, line, std::move(text)});
  }

  void check_include(const std::string& path, const Reference& include) {
    if (const Library* const library = library_of(include.header)) {
      if (!library->may_include(path))
        report(path, include.line,
               std::string(library->name) + " may be included only in " + std::string(library->where));
      return;
    }
    const Place target = place_of(include.header);
    if (!rules_.folders.contains(target.folder)) {
      if (include.is_quoted)
        report(path, include.line, "\"" + include.header + "\" is no path from the root of the source tree");
      return;
    }
    check_order(path, include);
    for (const std::string& header : reached_from(include.header)) check_sight(path, include.line, header);
    // Types of an external library must not reach other files indirectly, through a header.
    if (!(place_of(path) == target))
      for (const Library* library : leaked_by(include.header))
        if (!library->may_include(path))
          report(path, include.line, include.header + " brings " + std::string(library->name) + " out of its room");
  }

  /// Checks the types and namespaces that a file uses. A type counts even if its header is included only indirectly or
  /// not at all.
  void check_names(const std::string& path, const Source& source) {
    const Place from = place_of(path);
    for (const auto& [name, line] : source.names) {
      const auto found = header_of_type_.find(name);
      if (found == header_of_type_.end()) continue;
      const std::string& header = found->second;
      const bool is_included = std::any_of(source.includes.begin(), source.includes.end(),
                                           [&](const Reference& include) { return include.header == header; });
      if (is_included) continue;
      check_order(path, {line, true, header, name});
      check_sight(path, line, header);
    }
    for (const auto& [name, line] : source.namespaces)
      if (rules_.folders.contains(name) && name != from.folder && !rules_.folders.at(from.folder).contains(name))
        report(path, line, from.folder + "/ may not use namespace " + name);
  }

  void check_order(const std::string& path, const Reference& reference) {
    const Place from = place_of(path);
    const Place target = place_of(reference.header);
    if (target.folder != from.folder) {
      if (!rules_.folders.at(from.folder).contains(target.folder))
        report(path, reference.line, from.folder + "/ may not " + reference.text());
      return;
    }
    const auto rooms = rules_.rooms.find(from.folder);
    if (rooms == rules_.rooms.end() || target.room.empty() || target.room == from.room) return;
    const std::string name = from.folder + "/" + (from.room.empty() ? "" : from.room + "/");
    const auto room = rooms->second.find(from.room);
    if (room == rooms->second.end() && !from.room.empty()) {
      report(path, reference.line, "room " + name + " has no place in the order of rooms");
    } else if (from.room.empty() || !room->second.contains(target.room)) {
      report(path, reference.line, name + " may not " + reference.text());
    }
  }

  /// Checks rules that apply to headers even if they are included indirectly.
  void check_sight(const std::string& path, int line, const std::string& header) {
    const Side side = side_of(path);
    const Side other = side_of(header);
    if (side != Side::neither && other != Side::neither && other != side)
      report(path, line, std::string(side == Side::plans ? "what plans" : "what judges") + " may not see " + header);
    const Place from = place_of(path);
    if (from.folder == "studies" && header.starts_with("fabrication/") &&
        !rules_.studies_that_see_fabrication.contains(from.room))
      report(path, line, "studies/" + from.room + "/ may not see " + header);
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
        for (const Reference& include : file->second.includes) open.push_back(include.header);
    }
    return seen;
  }

  /// Returns the restricted libraries that `path` includes, directly or through other headers.
  std::set<const Library*> leaked_by(const std::string& path) {
    std::set<const Library*> leaked;
    for (const std::string& header : reached_from(path))
      if (const Library* const library = library_of(header)) leaked.insert(library);
    return leaked;
  }

  const Rules& rules_;
  std::map<std::string, Source> files_;
  std::map<std::string, std::string> header_of_type_;
  std::vector<Violation> violations_;
};

}  // namespace

std::string to_string(const Violation& violation) {
  return violation.file + ":" + std::to_string(violation.line) + ": " + violation.text;
}

Rules read_rules(const fs::path& file) {
  std::ifstream stream(file);
  const auto document = nlohmann::ordered_json::parse(stream);
  Rules rules{order_of(document.at("folders")), {}, document.at("studies_that_see_fabrication").get<Names>()};
  for (const auto& [folder, rooms] : document.at("rooms").items()) rules.rooms[folder] = order_of(rooms);
  return rules;
}

std::vector<Violation> check_tree(const fs::path& root, const Rules& rules) {
  return Checker(root, rules).run();
}

}  // namespace retrace::layering
