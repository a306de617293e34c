#include "studies/ranging/cube_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "raytrace/observers/field_lanes.h"
#include "raytrace/observers/small_angle.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3, raytrace::JonesMatrix, raytrace::Stokes;
namespace field_lanes = raytrace::field_lanes;

constexpr double kMm2PerM2 = 1e6;
// deflection_rad() ignores beams with less power than this fraction of the diffracted power.
constexpr double kNoticeablePower = 1e-2;

}  // namespace

Stokes returned_stokes(const JonesMatrix& jones, const Stokes& incident) {
  const Eigen::Matrix2cd c = jones * raytrace::coherency_of_source(incident) * jones.adjoint();
  return {c(0, 0).real() + c(1, 1).real(), c(0, 0).real() - c(1, 1).real(), 2.0 * c(0, 1).real(), 2.0 * c(0, 1).imag()};
}

Stokes returned_stokes(const DirectionField& field, const Stokes& incident) {
  Stokes sum;
  for (const JonesMatrix& jones : field) sum += returned_stokes(jones, incident);
  return sum;
}

CubeField::CubeField(const raytrace::FarField& field, double wavelength_nm, double beam_mm2)
    : wavelength_mm_(1e-6 * wavelength_nm),
      beam_mm2_(beam_mm2),
      detail_rad_(field.detail_rad()),
      diffracted_power_(field.diffracted_power()) {
  const double scale = std::sqrt(4.0 * std::numbers::pi * beam_mm2_ / kMm2PerM2) / wavelength_mm_;
  for (const raytrace::CoherentGroup& group : field.groups()) {
    std::vector<Wave>& waves = groups_.emplace_back();
    for (const raytrace::FieldPolygon& polygon : group.polygons)
      waves.push_back({field_lanes::Outline(polygon.transform), polygon.cosines,
                       scale * polygon.mean_factor * std::sqrt(group.copies) * polygon.amplitude,
                       group.copies * polygon.power});
  }
  for (const raytrace::FarFieldRay& ray : field.rays()) undiffracted_power_ += ray.power;
}

double CubeField::deflection_rad(const Vec3& to_source) const {
  double largest = 0.0;
  for (const std::vector<Wave>& waves : groups_)
    for (const Wave& wave : waves) {
      if (wave.power < kNoticeablePower * diffracted_power_) continue;
      const Vec3 direction(wave.cosines.x(), wave.cosines.y(),
                           std::sqrt(std::max(0.0, 1.0 - wave.cosines.squaredNorm())));
      largest = std::max(largest, raytrace::small_angle_between(direction, to_source));
    }
  return largest;
}

std::vector<DirectionField> CubeField::at(std::span<const Vec3> directions) const {
  const double wave_number = 2.0 * std::numbers::pi / wavelength_mm_;
  std::vector<DirectionField> fields(directions.size(), DirectionField(groups_.size(), JonesMatrix::Zero()));
  for (std::size_t first = 0; first < directions.size(); first += field_lanes::kBlock) {
    const std::size_t count = std::min(field_lanes::kBlock, directions.size() - first);
    for (std::size_t group = 0; group < groups_.size(); ++group)
      for (const Wave& wave : groups_[group]) {
        field_lanes::Block kx, ky;
        for (std::size_t k = 0; k < field_lanes::kBlock; ++k) {
          const Vec2 kappa = wave_number * (directions[first + std::min(k, count - 1)].head<2>() - wave.cosines);
          kx[k] = kappa.x();
          ky[k] = kappa.y();
        }
        field_lanes::ComplexBlock transform;
        field_lanes::transform(wave.outline, kx, ky, transform);
        for (std::size_t k = 0; k < count; ++k) {
          const double obliquity = std::sqrt(std::max(0.0, directions[first + k].z()));
          fields[first + k][group] +=
              obliquity * std::complex<double>(transform.re[k], transform.im[k]) * wave.amplitude;
        }
      }
  }
  return fields;
}

}  // namespace retrace::studies
