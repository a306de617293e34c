#include "design/shells_of_design.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/angle.h"
#include "core/number_format.h"
#include "core/schema/schema.h"
#include "design/light_and_index.h"

namespace retrace::design {
namespace {

using geometry::Vec2, geometry::Vec3, raytrace::Shell, raytrace::ShellSurface;

// Number of intervals, along each axis, of the grid of points at which distances between surfaces are determined.
constexpr int kGridSteps = 64;
// Maximum overlap of two surfaces, in mm, that is attributed to rounding errors.
constexpr double kRoundingMm = 1e-9;

std::string key_of(std::size_t shell, std::string_view name) {
  return schema::path_in(schema::path_of_entry("shell", shell), name);
}

/// Returns the matrix of a rotation about x followed by a rotation about y.
Eigen::Matrix3d rotation(const std::array<double, 2>& angles_deg) {
  const auto about = [](double angle_deg, const Vec3& axis) {
    return Eigen::AngleAxisd(Angle::from_deg(angle_deg).rad(), axis).toRotationMatrix();
  };
  return about(angles_deg[1], Vec3::UnitY()) * about(angles_deg[0], Vec3::UnitX());
}

/// Returns one surface of a shell.
/// \param radius_mm radius of a sphere, > 0 if the surface is convex towards the source; empty: plane
ShellSurface surface_of(const Vec3& vertex_mm, const Vec3& normal, const std::optional<double>& radius_mm) {
  return {vertex_mm, normal, radius_mm ? 1.0 / *radius_mm : 0.0};
}

/// Returns both surfaces of a shell.
/// \param base_mm height of the middle of the next surface towards the part
Shell surfaces_of(const OuterShell& given, double base_mm) {
  const Eigen::Matrix3d tilt = rotation(given.tilt_deg);
  const Vec3 outer_normal = tilt * Vec3::UnitZ();
  // The same normal is used for both surfaces, because plane-parallel shells are identified by exactly equal normals.
  const bool is_wedge = given.wedge_deg != std::array<double, 2>{};
  const Vec3 inner_normal = is_wedge ? Vec3(tilt * rotation(given.wedge_deg) * Vec3::UnitZ()) : outer_normal;
  const Vec3 inner_vertex(0.0, 0.0, base_mm + given.gap_mm);
  Shell shell;
  shell.inner = surface_of(inner_vertex, inner_normal, given.inner_radius_mm);
  shell.outer = surface_of(inner_vertex + given.thickness_mm * outer_normal, outer_normal, given.outer_radius_mm);
  shell.thickness_mm = given.thickness_mm;
  return shell;
}

/// Returns the refractive index of a shell.
double index_of_shell(const Design& design, const materials::MaterialLibrary& library, std::size_t k,
                      double wavelength_nm) {
  const OuterShell& given = design.shells[k];
  if (given.refractive_index) return *given.refractive_index;
  const materials::Material& material = material_of_shell(design, library, k);
  const double temperature_c =
      material.thermo_optic ? design.substance.temperature_c.value_or(material.temperature_c) : material.temperature_c;
  const double index = index_at_wavelength(design, material, library.air(), wavelength_nm, temperature_c);
  if (!(index >= 1.0))
    throw InputError(design.where(key_of(k, "material")),
                     fmt::format("the refractive index of {} must be >= 1, got {}", material.name, index));
  return index;
}

/// Returns plan points relative to the middle of the part: a grid over the outline, and points on the outline's sides.
std::vector<Vec2> points_over(const geometry::Polygon& outline) {
  std::vector<Vec2> points;
  const geometry::Rectangle box = geometry::bounding_box(outline);
  for (int j = 0; j <= kGridSteps; ++j)
    for (int i = 0; i <= kGridSteps; ++i) {
      const Vec2 point = box.lower + box.size().cwiseProduct(Vec2(i, j)) / kGridSteps;
      if (geometry::contains(outline, point)) points.push_back(point - box.centre());
    }
  for (std::size_t k = 0; k < outline.size(); ++k)
    for (int i = 0; i < kGridSteps; ++i)
      points.emplace_back(outline[k] + double(i) / kGridSteps * (outline[(k + 1) % outline.size()] - outline[k]) -
                          box.centre());
  return points;
}

/// Returns points of the entrance surface, relative to the middle of the part.
std::vector<Vec3> points_of_entrance(const geometry::Part& part, const std::optional<geometry::Entrance>& entrance,
                                     const std::vector<Vec2>& plan) {
  std::vector<Vec3> points;
  if (!entrance) {
    for (const Vec2& at : plan) points.emplace_back(at.x(), at.y(), 0.0);
    return points;
  }
  const Vec2 centre = geometry::bounding_box(part.outline).centre();
  double middle_mm = geometry::height_mm(*entrance, centre);
  if (!std::isfinite(middle_mm)) middle_mm = geometry::entrance_range(*entrance, part.outline).highest_mm;
  if (const auto* const mesh = std::get_if<std::shared_ptr<const geometry::SurfacePatch>>(&*entrance)) {
    for (const Vec3& p : (*mesh)->vertices)
      if (geometry::contains(part.outline, p.head<2>(), kRoundingMm))
        points.emplace_back(p.x() - centre.x(), p.y() - centre.y(), p.z() - middle_mm);
    return points;
  }
  for (const Vec2& at : plan)
    points.emplace_back(at.x(), at.y(), geometry::height_mm(*entrance, at + centre) - middle_mm);
  return points;
}

/// Formats the coordinates of a point in the part frame.
/// \param at point relative to the middle of the part
std::string point_text(const Vec2& at, const geometry::Part& part) {
  const Vec2 point =
      at + (part.period_mm ? Vec2(0.5 * *part.period_mm) : geometry::bounding_box(part.outline).centre());
  return fmt::format("x = {}, y = {} mm", fixed(point.x(), 4), fixed(point.y(), 4));
}

/// Checks the distances between one shell and its neighbours at given points, and records the extreme distances.
class ClearanceCheck {
 public:
  ClearanceCheck(const Design& design, const raytrace::Shells& shells, const geometry::Part& part, std::size_t k)
      : design_(design), shells_(shells), part_(part), k_(k) {}

  /// Records the thickness of the shell at a point of the plan and, if there is a next shell, the gap to it.
  void add_thickness(const Vec2& at) {
    const double inner_mm = height_of(shells_[k_].inner, at, k_, "inner_radius_mm");
    const double thickness_mm = height_of(shells_[k_].outer, at, k_, "outer_radius_mm") - inner_mm;
    if (!(thickness_mm > 0.0))
      throw InputError(
          design_.where(key_of(k_, "thickness_mm")),
          fmt::format(
              "must be so large that the surfaces of the shell do not cross over the part, but they cross at {}, "
              "got {}",
              point_text(at, part_), shortest(design_.shells[k_].thickness_mm)));
    clearance_.min_thickness_mm = std::min(clearance_.min_thickness_mm, thickness_mm);
    clearance_.max_thickness_mm = std::max(clearance_.max_thickness_mm, thickness_mm);
    if (k_ + 1 < shells_.size()) add_gap(at, height_of(shells_[k_ + 1].outer, at, k_ + 1, "outer_radius_mm"));
  }

  /// Records the gap between the shell and a point of the next surface towards the part.
  void add_gap(const Vec2& at, double next_mm) {
    const double gap_mm = height_of(shells_[k_].inner, at, k_, "inner_radius_mm") - next_mm;
    if (gap_mm < -kRoundingMm)
      throw InputError(
          design_.where(key_of(k_, "gap_mm")),
          fmt::format("must be so large that the shell does not extend into {}, but they meet at {}, got {}",
                      k_ + 1 < shells_.size() ? "the next shell" : "the part", point_text(at, part_),
                      shortest(design_.shells[k_].gap_mm)));
    clearance_.min_gap_mm = std::min(clearance_.min_gap_mm, gap_mm);
  }

  const ShellClearance& result() const { return clearance_; }

 private:
  double height_of(const ShellSurface& surface, const Vec2& at, std::size_t shell, std::string_view radius_key) const {
    const double height_mm = raytrace::height_mm(surface, at);
    if (std::isfinite(height_mm)) return height_mm;
    throw InputError(design_.where(key_of(shell, radius_key)),
                     fmt::format("must be so large that the surface extends over the whole part, but it does not "
                                 "extend to {}, got {}",
                                 point_text(at, part_), shortest(1.0 / surface.curvature_per_mm)));
  }

  const Design& design_;
  const raytrace::Shells& shells_;
  const geometry::Part& part_;
  std::size_t k_;
  ShellClearance clearance_{std::numeric_limits<double>::infinity(), 0.0, std::numeric_limits<double>::infinity()};
};

}  // namespace

const materials::Material& material_of_shell(const Design& design, const materials::MaterialLibrary& library,
                                             std::size_t index) {
  return library.find(design.shells[index].material, design.where(key_of(index, "material")));
}

raytrace::Shells shells_at(const Design& design, const materials::MaterialLibrary& library, double wavelength_nm) {
  raytrace::Shells shells(design.shells.size());
  double base_mm = 0.0;
  for (std::size_t k = shells.size(); k-- > 0;) {
    const OuterShell& given = design.shells[k];
    Shell& shell = shells[k] = surfaces_of(given, base_mm);
    shell.index = index_of_shell(design, library, k, wavelength_nm);
    shell.absorption_per_mm = absorption_at(design, given.absorption_per_mm, key_of(k, "absorption_per_mm"),
                                            material_of_shell(design, library, k), wavelength_nm);
    const double top_mm = raytrace::height_mm(shell.outer, Vec2::Zero());
    base_mm = std::isfinite(top_mm) ? top_mm : shell.outer.vertex_mm.z();
  }
  return shells;
}

std::vector<ShellClearance> clearances_of_shells(const Design& design, const raytrace::Shells& shells,
                                                 const geometry::Part& part,
                                                 const std::optional<geometry::Entrance>& entrance) {
  if (!part.entrance_pieces.empty() && design.has_deflecting_shells())
    throw InputError(design.where_shell_deflects(),
                     "must be plane-parallel for an [outline] with notches or holes: remove radii and wedge_deg");
  const std::vector<Vec2> plan = part.period_mm ? std::vector<Vec2>{Vec2::Zero()} : points_over(part.outline);
  std::vector<ShellClearance> clearances;
  for (std::size_t k = 0; k < shells.size(); ++k) {
    ClearanceCheck check(design, shells, part, k);
    for (const Vec2& at : plan) check.add_thickness(at);
    if (k + 1 == shells.size())
      for (const Vec3& p : points_of_entrance(part, entrance, plan)) check.add_gap(p.head<2>(), p.z());
    clearances.push_back(check.result());
  }
  return clearances;
}

}  // namespace retrace::design
