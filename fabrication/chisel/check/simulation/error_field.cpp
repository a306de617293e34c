#include "fabrication/chisel/check/simulation/error_field.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/error.h"
#include "core/length_units.h"
#include "core/threads.h"
#include "fabrication/check/findings.h"
#include "fabrication/chisel/check/cavity.h"
#include "fabrication/chisel/check/program_check.h"
#include "fabrication/chisel/check/simulation/dexel.h"
#include "fabrication/chisel/on_machine.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec2;
using geometry::Vec3;

constexpr std::size_t kMaxLines = 400;
constexpr std::size_t kMinLines = 4;
/// Extent of a hexagonal cube corner's cavity from its apex, divided by the radius of its aperture.
constexpr double kCavityReach = 2.0;

/// Result of the dexel simulation of one element, converted to heights above the facets.
struct ElementField {
  DexelBox box;
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<double> height_nm;

  double at(const Vec2& p) const {
    const auto index = [](double share, std::size_t count) {
      return std::min(static_cast<std::size_t>(std::max(share, 0.0) * static_cast<double>(count)), count - 1);
    };
    const Vec3 size = box.high_mm - box.low_mm;
    const std::size_t column = index((p.x() - box.low_mm.x()) / size.x(), columns);
    const std::size_t row = index((p.y() - box.low_mm.y()) / size.y(), rows);
    return height_nm[row * columns + column];
  }
};

/// Returns half of the extent of the simulated region of an element along x and y. The z component is 0.
Vec3 half_extent_mm(const PrismGroove& groove) {
  const Vec3 across = groove.root_direction.cross(Vec3::UnitZ());
  return (groove.half_width_mm * groove.root_direction).cwiseAbs() + (groove.half_base_mm * across).cwiseAbs();
}
Vec3 half_extent_mm(const CubeCavity& cavity) {
  return {kCavityReach * cavity.radius_mm, kCavityReach * cavity.radius_mm, 0.0};
}

ElementField field_of(const DesignElement& element, const Vec3& half, std::span<const SweptVolume> sweeps,
                      std::span<const RigidMotion> poses, const ToolWedge& wedge, std::size_t lines) {
  ElementField field;
  field.box = {element.root_mm - half + 2.0 * element.root_mm.z() * Vec3::UnitZ(), element.root_mm + half};
  field.box.high_mm.z() = 0.0;
  const DexelField dexels = cut_dexels(sweeps, poses, wedge, field.box, 2, lines);
  field.columns = dexels.columns;
  field.rows = dexels.rows;
  const Vec3 size = field.box.high_mm - field.box.low_mm;
  for (std::size_t row = 0; row < dexels.rows; ++row)
    for (std::size_t column = 0; column < dexels.columns; ++column) {
      const double x =
          field.box.low_mm.x() + (static_cast<double>(column) + 0.5) / static_cast<double>(dexels.columns) * size.x();
      const double y =
          field.box.low_mm.y() + (static_cast<double>(row) + 0.5) / static_cast<double>(dexels.rows) * size.y();
      const Vec3 left(x, y, -dexels.removed_mm[row * dexels.columns + column]);
      // Use the height above the nearest facet. Residual material on another facet belongs to that facet.
      double height_mm = std::numeric_limits<double>::infinity();
      for (const DesignFacet& facet : element.facets) height_mm = std::min(height_mm, facet.height_mm(left));
      // Outside of the cavity, the blank's face must remain. It has no error there.
      if (left.z() == 0.0) height_mm = std::max(height_mm, 0.0);
      field.height_nm.push_back(height_mm * kNmPerMm);
    }
  return field;
}

}  // namespace

ErrorField error_field(const Job& job, const Machine& machine, const std::vector<NcProgram>& programs,
                       std::size_t pixels) {
  if (job.substrate)
    throw InputError(job.where("substrate"),
                     "an error map is available only for flat arrays, not for elements on a substrate");
  check_on_machine(job, machine);
  const VerificationModel workpiece = verification_model_of(job, machine);
  FindingList findings;
  ProgramCheck check(workpiece, findings);
  for (const NcProgram& program : programs) {
    check.begin(program);
    check.end(run_nc(program, check));
  }
  const std::vector<RigidMotion> poses = check.poses();
  ErrorField field;
  field.size_mm = blank_extent_mm(job);
  field.low_mm = -0.5 * field.size_mm;
  const double pitch_mm = field.size_mm.maxCoeff() / static_cast<double>(pixels);
  const auto count = [&](double size_mm) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(size_mm / pitch_mm)));
  };
  field.columns = count(field.size_mm.x());
  field.rows = count(field.size_mm.y());

  std::vector<ElementField> elements(workpiece.cavities.size());
  for_each_in_parallel(elements.size(), [&](std::size_t i) {
    const Vec3 half = std::visit([](const auto& groove) { return half_extent_mm(groove); }, workpiece.cavities[i]);
    const double longest_mm = 2.0 * half.maxCoeff();
    const auto lines = std::clamp(static_cast<std::size_t>(std::ceil(longest_mm / pitch_mm)), kMinLines, kMaxLines);
    elements[i] = field_of(workpiece.design(i), half, check.sweeps()[i], poses, check.wedge(), lines);
  });

  const CavityMap map(workpiece.cavities);
  field.height_nm.assign(field.columns * field.rows, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t row = 0; row < field.rows; ++row)
    for (std::size_t column = 0; column < field.columns; ++column) {
      const Vec2 share((static_cast<double>(column) + 0.5) / static_cast<double>(field.columns),
                       1.0 - (static_cast<double>(row) + 0.5) / static_cast<double>(field.rows));
      const Vec2 p = field.low_mm + share.cwiseProduct(field.size_mm);
      if (const auto element = map.deepest(p.x(), p.y()))
        field.height_nm[row * field.columns + column] = elements[*element].at(p);
    }
  return field;
}

}  // namespace retrace::fabrication
