#include "raytrace/observers/aperture_field.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace retrace::raytrace {
namespace {

using geometry::Vec2, field_lanes::kBlock;

// Resolution at which direction cosines are compared.
constexpr double kSameCosine = 1e-8;

/// Returns a key that is equal for polygons with equal corners and direction, except for rounding. The key begins with
/// the lexicographically smallest corner, because polygons may start at any corner.
std::vector<std::int64_t> wave_key(const FieldPolygon& polygon, double same_mm) {
  std::vector<std::array<std::int64_t, 2>> corners;
  for (const Vec2& p : polygon.transform.polygon())
    corners.push_back({std::llround(p.x() / same_mm), std::llround(p.y() / same_mm)});
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  std::vector<std::int64_t> key = {std::llround(polygon.cosines.x() / kSameCosine),
                                   std::llround(polygon.cosines.y() / kSameCosine)};
  for (const auto& corner : corners) key.insert(key.end(), corner.begin(), corner.end());
  return key;
}

}  // namespace

field_lanes::Use use_of(std::size_t wave, const FieldPolygon& polygon) {
  field_lanes::Use use{wave, {}};
  for (Eigen::Index row = 0; row < 2; ++row)
    for (Eigen::Index column = 0; column < 2; ++column) {
      const std::complex<double> a = polygon.mean_factor * polygon.amplitude(row, column);
      const auto at = static_cast<std::size_t>(4 * row + 2 * column);
      use.amplitude[at] = a.real();
      use.amplitude[at + 1] = a.imag();
    }
  return use;
}

ApertureField::ApertureField(const std::vector<CoherentGroup>& groups, double wavelength_mm,
                             const Eigen::Matrix2cd& coherency, double same_mm, std::size_t replicates)
    : wavelength_mm_(wavelength_mm),
      coherency_{coherency(0, 0).real(), coherency(1, 1).real(), coherency(0, 1).real(), coherency(0, 1).imag()},
      columns_(1 + replicates) {
  std::map<std::vector<std::int64_t>, std::size_t> known;
  for (const CoherentGroup& group : groups) {
    Field& field = fields_.emplace_back();
    field.copies = group.copies;
    if (group.replicate) field.column = 1 + *group.replicate;
    for (const FieldPolygon& polygon : group.polygons) {
      const auto [it, is_new] = known.try_emplace(wave_key(polygon, same_mm), waves_.size());
      if (is_new) waves_.push_back({field_lanes::Outline(polygon.transform), polygon.cosines});
      field.uses.push_back(use_of(it->second, polygon));
    }
  }
}

Eigen::ArrayXXd ApertureField::per_cosines(std::span<const Vec2> cosines, const Cancellation* cancel) const {
  const double wave_number = 2.0 * std::numbers::pi / wavelength_mm_;
  Eigen::ArrayXXd result =
      Eigen::ArrayXXd::Zero(static_cast<Eigen::Index>(cosines.size()), static_cast<Eigen::Index>(columns_));
  std::vector<field_lanes::ComplexBlock> transforms(waves_.size());
  for (std::size_t first = 0; first < cosines.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, cosines.size() - first);
    field_lanes::Block kx, ky;
    for (std::size_t wave = 0; wave < waves_.size(); ++wave) {
      if (is_cancelled(cancel)) return result;
      for (std::size_t k = 0; k < kBlock; ++k) {
        const Vec2 kappa = wave_number * (cosines[first + std::min(k, count - 1)] - waves_[wave].cosines);
        kx[k] = kappa.x();
        ky[k] = kappa.y();
      }
      field_lanes::transform(waves_[wave].outline, kx, ky, transforms[wave]);
    }
    std::vector<field_lanes::Block> sums(columns_);
    for (const Field& field : fields_)
      field_lanes::add_power(field.uses, transforms, coherency_, field.copies, sums[field.column]);
    for (std::size_t column = 0; column < columns_; ++column)
      for (std::size_t k = 0; k < count; ++k)
        result(static_cast<Eigen::Index>(first + k), static_cast<Eigen::Index>(column)) =
            sums[column][k] / (wavelength_mm_ * wavelength_mm_);
  }
  return result;
}

}  // namespace retrace::raytrace
