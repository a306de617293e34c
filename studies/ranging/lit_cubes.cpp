#include "studies/ranging/lit_cubes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

#include "core/threads.h"
#include "raytrace/light/light_setup.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3, raytrace::Stokes;

// Cubes whose cosine of the angle of incidence is smaller than this value count as not illuminated.
constexpr double kMinCosine = 1e-4;
// Before directions are compared, their components are rounded to multiples of this step.
constexpr double kDirectionStep = 1e-9;
// Number of directions that one parallel task evaluates.
constexpr std::size_t kDirectionsPerTask = 64;
// If a source is closer to the x axis than this value, its reference axis is +y instead of +x. The value is the sine of
// the angle.
constexpr double kAlongX = 1e-6;

using LightKey = std::array<std::int64_t, 4>;

LightKey key_of(std::size_t variant, const Vec3& to_source) {
  return {static_cast<std::int64_t>(variant), std::llround(to_source.x() / kDirectionStep),
          std::llround(to_source.y() / kDirectionStep), std::llround(to_source.z() / kDirectionStep)};
}

}  // namespace

raytrace::ReturnFrame return_frame_of(const Vec3& to_source) {
  raytrace::ReturnFrame frame;
  frame.to_source = to_source;
  const bool is_along_x = to_source.tail<2>().norm() < kAlongX;
  frame.right = is_along_x ? Vec3(to_source.cross(Vec3::UnitY()).cross(to_source).normalized())
                           : raytrace::source_axis(to_source);
  frame.up = to_source.cross(frame.right);
  return frame;
}

LitCubes::LitCubes(const CubeSet& set, const Vec3& to_source, std::size_t wavelength, const Cancellation* cancel)
    : frame_(return_frame_of(to_source)) {
  std::map<LightKey, std::size_t> known;
  // In an array, equivalent directions of light are traced only one time. A single cube is traced in the given
  // direction.
  const bool may_share = set.cubes.size() > 1;
  for (std::size_t number = 0; number < set.cubes.size(); ++number) {
    const ArrayCube& cube = set.cubes[number];
    const std::size_t variant = set.variant_of_cube[number];
    const CubeCorner& corner = set.variants[variant];
    const Eigen::Matrix3d cube_from_array = array_from_cube(cube).transpose();
    const Vec3 own = cube_from_array * to_source;
    if (own.z() < kMinCosine) continue;
    const EquivalentLight light = may_share ? corner.representative(own) : EquivalentLight{own};
    const auto [it, is_new] = known.try_emplace(key_of(variant, light.to_source), fields_.size());
    if (is_new) fields_.push_back({variant, light.to_source, {}});
    Lit lit;
    lit.cube = number;
    lit.field = it->second;
    lit.traced_from_array = light.map * cube_from_array;
    const Vec3 right = raytrace::source_axis(light.to_source);
    const Vec3 up = light.to_source.cross(right);
    const Vec3 array_right = lit.traced_from_array * frame_.right;
    const Vec3 array_up = lit.traced_from_array * frame_.up;
    lit.axes << right.dot(array_right), right.dot(array_up), up.dot(array_right), up.dot(array_up);
    const CubeIndex& index = corner.indices()[wavelength];
    lit.range_mm = range_correction_mm(corner.depth_mm(), index.index, index.group_index, own.head<2>().norm()) -
                   to_source.dot(cube.position_mm);
    lit_.push_back(lit);
  }
  for_each_in_parallel(fields_.size(), [&](std::size_t k) {
    fields_[k].field = set.variants[fields_[k].variant].field(fields_[k].to_source, wavelength, cancel);
  });
  std::erase_if(lit_, [&](const Lit& lit) { return fields_[lit.field].field.empty(); });
  find_equal_cubes();
}

void LitCubes::find_equal_cubes() {
  std::map<std::array<std::int64_t, 10>, std::size_t> known;
  for (std::size_t k = 0; k < lit_.size(); ++k) {
    std::array<std::int64_t, 10> key{static_cast<std::int64_t>(lit_[k].field)};
    for (Eigen::Index entry = 0; entry < 9; ++entry)
      key[static_cast<std::size_t>(entry) + 1] = std::llround(lit_[k].traced_from_array.data()[entry] / kDirectionStep);
    const auto [it, is_new] = known.try_emplace(key, equal_cubes_.size());
    if (is_new)
      equal_cubes_.push_back({k});
    else
      equal_cubes_[it->second].count += 1.0;
  }
}

double LitCubes::detail_rad() const {
  double finest = std::numeric_limits<double>::infinity();
  for (const Traced& traced : fields_)
    if (!traced.field.empty()) finest = std::min(finest, traced.field.detail_rad());
  return finest;
}

double LitCubes::deflection_rad() const {
  double largest = 0.0;
  for (const Traced& traced : fields_) largest = std::max(largest, traced.field.deflection_rad(traced.to_source));
  return largest;
}

std::vector<double> LitCubes::cosines() const {
  std::vector<double> all;
  for (const Lit& lit : lit_) all.push_back(fields_[lit.field].to_source.z());
  return all;
}

double LitCubes::mean_of(double (CubeField::*fraction)() const) const {
  double sum = 0.0;
  double beams_mm2 = 0.0;
  for (const Lit& lit : lit_) {
    const CubeField& field = fields_[lit.field].field;
    sum += field.beam_mm2() * (field.*fraction)();
    beams_mm2 += field.beam_mm2();
  }
  return lit_.empty() ? 0.0 : sum / beams_mm2;
}

double LitCubes::diffracted_power() const {
  return mean_of(&CubeField::diffracted_power);
}

double LitCubes::undiffracted_power() const {
  return mean_of(&CubeField::undiffracted_power);
}

/// Returns the fields of one cube in several directions. The fields refer to the axes of the source in the frame of the
/// array.
/// \param directions unit vectors in the frame of the array
std::vector<DirectionField> LitCubes::fields_of(const Lit& lit, std::span<const Vec3> directions) const {
  std::vector<Vec3> own;
  for (const Vec3& direction : directions) own.push_back(lit.traced_from_array * direction);
  std::vector<DirectionField> fields = fields_[lit.field].field.at(own);
  for (DirectionField& field : fields)
    for (raytrace::JonesMatrix& jones : field) jones = lit.axes.transpose() * jones * lit.axes;
  return fields;
}

std::vector<Stokes> LitCubes::stokes(std::span<const Vec2> angles_rad, const Stokes& sent,
                                     const Cancellation* cancel) const {
  std::vector<Stokes> sums(angles_rad.size());
  const std::size_t tasks = (angles_rad.size() + kDirectionsPerTask - 1) / kDirectionsPerTask;
  for_each_in_parallel(tasks, [&](std::size_t task) {
    const std::size_t first = task * kDirectionsPerTask;
    const std::size_t count = std::min(kDirectionsPerTask, angles_rad.size() - first);
    std::vector<Vec3> directions;
    for (const Vec2& angles : angles_rad.subspan(first, count)) directions.push_back(frame_.direction(angles));
    for (const EqualCubes& cubes : equal_cubes_) {
      if (is_cancelled(cancel)) return;
      const std::vector<DirectionField> fields = fields_of(lit_[cubes.lit], directions);
      for (std::size_t k = 0; k < count; ++k) sums[first + k] += cubes.count * returned_stokes(fields[k], sent);
    }
  });
  return sums;
}

std::vector<CubeEcho> LitCubes::echoes(const Vec2& angles_rad, const Stokes& sent) const {
  const std::array<Vec3, 1> direction = {frame_.direction(angles_rad)};
  std::vector<CubeEcho> echoes;
  for (const Lit& lit : lit_) {
    DirectionField field = fields_of(lit, direction).front();
    const double cross_section = returned_stokes(field, sent).i;
    echoes.push_back({lit.cube, lit.range_mm, cross_section, std::move(field)});
  }
  return echoes;
}

}  // namespace retrace::studies
