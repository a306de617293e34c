#include "geometry/io/obj_file.h"

#include <fmt/format.h>

#include <iterator>

#include "core/number_format.h"
#include "geometry/io/face_groups.h"

namespace retrace::geometry {
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
