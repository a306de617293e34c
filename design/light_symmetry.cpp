#include "design/light_symmetry.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "design/engine_facts.h"
#include "raytrace/faces/part_symmetry.h"

namespace retrace::design {
namespace {

/// Returns true if the facets or the entrance face may have properties that are not symmetric although the part is.
bool has_oriented_faces(const Design& design, const OpticalModel& model) {
  const raytrace::EngineFacts facts = engine_facts(design, &model.optics);
  const bool are_tilted = std::ranges::any_of(
      design.shells, [](const OuterShell& shell) { return shell.tilt_deg != std::array<double, 2>{}; });
  return are_tilted || facts.has_balls || facts.has_curved_entrance || facts.has_deflecting_shells ||
         facts.has_unequal_backs || facts.has_form || design.surface.entrance.scratch_azimuth_deg ||
         std::holds_alternative<HeightMapTexture>(design.surface.texture);
}

}  // namespace

std::vector<Eigen::Matrix2d> light_symmetries(const Design& design, const OpticalModel& model) {
  const raytrace::Stokes& light = design.light.polarisation;
  if (has_oriented_faces(design, model) || light.u != 0.0 || light.v != 0.0) return {Eigen::Matrix2d::Identity()};
  std::vector<Eigen::Matrix2d> maps = raytrace::symmetries_of(model.part);
  constexpr double kSameNumber = 1e-9;
  const auto is_diagonal = [](const Eigen::Matrix2d& map) {
    return std::abs(map(0, 1)) < kSameNumber && std::abs(map(1, 0)) < kSameNumber;
  };
  if (light.q != 0.0) std::erase_if(maps, [&](const Eigen::Matrix2d& map) { return !is_diagonal(map); });
  return maps;
}

}  // namespace retrace::design
