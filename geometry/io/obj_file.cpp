#include "geometry/io/obj_file.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/leading_number.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/text.h"
#include "geometry/io/face_groups.h"
#include "geometry/io/stl_file.h"
#include "geometry/outline/convex_decomposition.h"

namespace retrace::geometry {
namespace {

constexpr double kLargestObjCoordinateMm = 1e6;
// Statements that do not change the shape.
constexpr std::array<std::string_view, 13> kIgnoredStatements = {"vn", "vt",     "vp",     "g", "o",   "s", "usemtl",
                                                                 "mg", "mtllib", "usemap", "l", "lod", "p"};

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& name, double scale) : text_(text), name_(name), scale_(scale) {}

  TriangleMesh read() {
    while (next_line())
      if (!words_.empty()) read_statement();
    if (mesh_.triangles.empty()) throw InputError({name_, 0, ""}, "the mesh must have at least one face, got none");
    return std::move(mesh_);
  }

 private:
  using Ring = std::vector<std::uint32_t>;

  [[noreturn]] void fail(const std::string& text) const { throw InputError({name_, line_, ""}, text); }

  /// Reads the words of the next line into `words_`. A backslash at the end of a line continues it.
  bool next_line() {
    words_.clear();
    if (at_ >= text_.size()) return false;
    for (bool continues = true; continues && at_ < text_.size();) {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      std::string_view line = text_.substr(at_, end - at_);
      at_ = end + 1;
      ++line_;
      line = line.substr(0, line.find('#'));
      const std::size_t last = line.find_last_not_of(" \t\r");
      line = line.substr(0, last == std::string_view::npos ? 0 : last + 1);
      continues = line.ends_with('\\');
      if (continues) line.remove_suffix(1);
      split(line);
    }
    return true;
  }

  void split(std::string_view line) {
    constexpr std::string_view kBlank = " \t\r";
    for (std::size_t from = line.find_first_not_of(kBlank); from != std::string_view::npos;) {
      const std::size_t to = std::min(line.find_first_of(kBlank, from), line.size());
      words_.push_back(line.substr(from, to - from));
      from = line.find_first_not_of(kBlank, to);
    }
  }

  void read_statement() {
    const std::string_view word = words_.front();
    if (word == "v") return add_vertex();
    if (word == "f") return add_face();
    if (std::find(kIgnoredStatements.begin(), kIgnoredStatements.end(), word) != kIgnoredStatements.end()) return;
    fail(fmt::format(
        "not an OBJ file with vertices and plane faces: expected a statement such as \"v\" or \"f\", got {}",
        in_quotes(word)));
  }

  void add_vertex() {
    if (words_.size() < 4) fail(fmt::format("a vertex must have three coordinates, got {}", words_.size() - 1));
    Vec3 p;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const std::string_view word = words_[static_cast<std::size_t>(axis) + 1];
      const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
      const std::optional<LeadingNumber> number = leading_number(digits);
      if (!number || number->length != digits.size()) fail("a coordinate must be a number, got " + in_quotes(word));
      p[axis] = scale_ * number->value + 0.0;  // adding 0 converts -0 to +0
      if (!(std::abs(p[axis]) < kLargestObjCoordinateMm))
        fail(fmt::format("coordinates must be finite and below 1e6 mm, got {}", p[axis]));
    }
    mesh_.vertices.push_back(p);
  }

  /// Returns the vertex of a corner such as "7", "7/1/3" or "-1". Negative numbers count from the last vertex.
  std::uint32_t vertex_of(std::string_view corner) const {
    const std::string_view digits = corner.substr(0, corner.find('/'));
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
    if (number < 0) number += count + 1;
    if (error != std::errc() || end != digits.data() + digits.size() || number < 1 || number > count)
      fail(fmt::format("a corner must be the number of a vertex, 1 to {}, got {}", count, in_quotes(corner)));
    return static_cast<std::uint32_t>(number - 1);
  }

  void add_face() {
    Ring ring;
    for (std::size_t k = 1; k < words_.size(); ++k) {
      const std::uint32_t v = vertex_of(words_[k]);
      if (ring.empty() || mesh_.vertices[v] != mesh_.vertices[ring.back()]) ring.push_back(v);
    }
    while (ring.size() > 1 && mesh_.vertices[ring.front()] == mesh_.vertices[ring.back()]) ring.pop_back();
    if (words_.size() < 4) fail(fmt::format("a face must have at least three corners, got {}", words_.size() - 1));
    if (ring.size() == 3) add_triangle(ring[0], ring[1], ring[2]);
    if (ring.size() > 3) add_polygon(ring);
  }

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (mesh_.triangles.size() >= kMaxStlTriangles)
      throw InputError({name_, 0, ""}, fmt::format("must have at most {} triangles", kMaxStlTriangles));
    mesh_.triangles.push_back({a, b, c});
  }

  /// Adds a polygon, which may be concave. It is divided in the plane of two axes in which its area is largest.
  void add_polygon(const Ring& ring) {
    Vec3 twice_area = Vec3::Zero();
    const Vec3& origin = mesh_.vertices[ring.front()];
    for (std::size_t k = 1; k + 1 < ring.size(); ++k)
      twice_area += (mesh_.vertices[ring[k]] - origin).cross(mesh_.vertices[ring[k + 1]] - origin);
    Eigen::Index normal = 0;
    twice_area.cwiseAbs().maxCoeff(&normal);
    const bool is_clockwise = twice_area[normal] < 0.0;
    std::map<std::pair<double, double>, std::uint32_t> vertex_at;
    std::vector<Vec2> loop;
    for (const std::uint32_t v : ring) {
      const Vec3& p = mesh_.vertices[v];
      loop.emplace_back(p[(normal + 1) % 3], p[(normal + 2) % 3]);
      vertex_at.emplace(std::pair(loop.back().x(), loop.back().y()), v);
    }
    if (vertex_at.size() != ring.size()) fail("the corners of a face must not coincide");
    if (is_clockwise) std::reverse(loop.begin(), loop.end());
    for (const Polygon& piece : convex_decomposition({loop})) {
      const auto corner = [&](std::size_t k) { return vertex_at.at({piece[k].x(), piece[k].y()}); };
      for (std::size_t k = 1; k + 1 < piece.size(); ++k)
        is_clockwise ? add_triangle(corner(0), corner(k + 1), corner(k))
                     : add_triangle(corner(0), corner(k), corner(k + 1));
    }
  }

  std::string_view text_;
  const std::string& name_;
  double scale_;
  std::size_t at_ = 0;
  int line_ = 0;
  std::vector<std::string_view> words_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh parse_obj(std::string_view text, const std::string& name, double scale) {
  return ObjReader(without_byte_order_mark(text), name, scale).read();
}

std::string obj_text(const BoundaryMesh& mesh, std::string_view title) {
  std::string text = fmt::format("# {}\n# lengths in mm\n", title);
  const auto out = std::back_inserter(text);
  for (const Vec3& p : mesh.vertices)
    fmt::format_to(out, "v {} {} {}\n", shortest(p.x()), shortest(p.y()), shortest(p.z()));
  for (const auto& [role, name] : kFaceGroups) {
    bool is_begun = false;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.roles[t] != role) continue;
      if (!is_begun) fmt::format_to(out, "g {}\n", name);
      is_begun = true;
      const auto& [a, b, c] = mesh.triangles[t];
      fmt::format_to(out, "f {} {} {}\n", a + 1, b + 1, c + 1);
    }
  }
  return text;
}

}  // namespace retrace::geometry
