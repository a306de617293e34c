#include "geometry/io/step_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/module.h"
#include "core/number_format.h"

// OpenCASCADE is used in a module that is loaded when the first STEP file is written. If the program were linked to its
// libraries, every run would need more time and memory.

namespace retrace::geometry {
namespace {

using WriteStep = void (*)(const ExactSolid& solid, const std::string& name, std::string& text);

void require_long_edges(const FacetedSolid& solid) {
  double least = INFINITY;
  for (const SolidFace& face : solid.faces)
    for (const auto& loop : face.loops)
      for (std::size_t i = 0; i < loop.size(); ++i)
        least = std::min(least, (solid.vertices[loop[i]] - solid.vertices[loop[(i + 1) % loop.size()]]).norm());
  if (least < kMinStepEdgeMm)
    throw InputError(
        fmt::format("a STEP file allows edges of at least {} mm, but the shortest edge of this solid is {} mm",
                    shortest(kMinStepEdgeMm), shortest(least)));
}

constexpr Module kStepModule{.name = "retrace_step",
                             .function = "retrace_write_step",
                             .missing_message = "STEP files cannot be written, but STL and OBJ files can",
                             .library = "OpenCASCADE",
                             .package = "libocct-data-exchange-7.6"};

// Mean size and time of a face and of an edge, measured with arrays of prisms and cube corners of 700 to 1800 elements.
constexpr double kBytesOfFace = 750.0, kBytesOfEdge = 470.0, kBytesOfPole = 100.0;
constexpr double kSecondsOfEdge = 1e-4;

}  // namespace

StepCost predicted_step_cost(const ExactSolid& solid) {
  std::size_t corners = 0;
  for (const SolidFace& face : solid.faces.faces)
    for (const auto& loop : face.loops) corners += loop.size();
  const double edges = 0.5 * static_cast<double>(corners);
  double bytes = kBytesOfFace * static_cast<double>(solid.faces.faces.size()) + kBytesOfEdge * edges;
  if (solid.entrance)
    if (const auto* const patch = std::get_if<SplinePatch>(&solid.entrance->surface))
      bytes += kBytesOfPole * static_cast<double>(patch->heights_mm.size());
  return {1e-6 * bytes, kSecondsOfEdge * edges};
}

std::string step_text(const ExactSolid& solid, const std::string& name) {
  require_long_edges(solid.faces);
  static const auto write = reinterpret_cast<WriteStep>(module_function(kStepModule));
  std::string text;
  write(solid, name, text);
  return text;
}

}  // namespace retrace::geometry
