#include "raytrace/observers/disc_means.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace retrace::raytrace {
namespace {

using geometry::Vec2;
using Bands = std::array<double, 3>;

// Number of lattice steps per finest detail of the diffracted light, and per radius of the averaging kernel. Two steps
// per detail are sufficient, because the diffracted light is band-limited. The kernel needs more steps, because its
// spectrum decreases only with the third power of the frequency.
constexpr double kStepsToADetail = 2.0;
constexpr double kStepsToTheReach = 12.0;
// Rays are merged if their directions are in the same cell of a grid with this step, as a fraction of the kernel's
// radius.
constexpr double kSpot = 1e-3;
// Number of intervals in the table of the kernel as a function of the chord.
constexpr std::size_t kKernelSteps = 4096;

/// Returns the unit vector with the given x and y components and a positive z component.
/// \pre the squared norm of `cosines` is at most 1
Vec3 upward(const Vec2& cosines) {
  return {cosines.x(), cosines.y(), std::sqrt(1.0 - cosines.squaredNorm())};
}

/// Table of an ApertureKernel. The argument is the chord, the distance between two points of the unit sphere.
class ChordKernel {
 public:
  explicit ChordKernel(const ApertureKernel& kernel) : max_(2.0 * std::sin(0.5 * kernel.reach_rad())) {
    for (std::size_t k = 0; k <= kKernelSteps + 1; ++k)
      values_.push_back(kernel.per_sr(2.0 * std::asin(std::min(1.0, 0.5 * max_ * static_cast<double>(k) / steps()))));
  }
  double most() const { return max_; }
  /// \pre 0 <= chord < most()
  double per_sr(double chord) const {
    const double place = chord / max_ * steps();
    const auto k = static_cast<std::size_t>(place);
    return std::lerp(values_[k], values_[k + 1], place - static_cast<double>(k));
  }

 private:
  static double steps() { return static_cast<double>(kKernelSteps); }

  double max_;
  std::vector<double> values_;
};

/// Lattice in the plane of direction cosines. It stores the power per unit area of this plane, summed over far fields.
class Lattice {
 public:
  /// Creates a lattice that covers a square and a margin on all sides.
  /// \param step distance of lattice points in both direction cosines
  Lattice(const CosineSquare& square, double margin, double step)
      : first_(square.centre - Vec2::Constant(square.half_width + margin)),
        step_(step),
        columns_(static_cast<std::size_t>(std::ceil(2.0 * (square.half_width + margin) / step)) + 1),
        heights_(columns_ * columns_, 0.0),
        sums_(columns_ * columns_, Bands{}) {
    for (std::size_t place = 0; place < heights_.size(); ++place)
      heights_[place] = std::sqrt(std::max(0.0, 1.0 - cosines(place / columns_, place % columns_).squaredNorm()));
  }

  static double points(const CosineSquare& square, double margin, double step) {
    return std::pow(2.0 * (square.half_width + margin) / step + 2.0, 2.0);
  }

  void add(const BandedField& field, const Cancellation* cancel) {
    for (std::size_t row = 0; row < columns_ && !is_cancelled(cancel); ++row) {
      std::vector<Vec3> directions;
      std::vector<std::size_t> places;
      for (std::size_t column = 0; column < columns_; ++column) {
        const std::size_t place = row * columns_ + column;
        if (heights_[place] == 0.0) continue;
        const Vec2 at = cosines(row, column);
        directions.emplace_back(at.x(), at.y(), heights_[place]);
        places.push_back(place);
      }
      const std::vector<double> diffracted = field.field->diffracted_per_sr(directions);
      for (std::size_t k = 0; k < places.size(); ++k) {
        const double per_cosines = diffracted[k] / heights_[places[k]];
        for (std::size_t band = 0; band < 3; ++band) sums_[places[k]][band] += field.weights[band] * per_cosines;
      }
    }
  }

  /// Returns the mean of the stored power around a direction, weighted with the kernel.
  Bands mean(const Vec3& direction, const ChordKernel& kernel) const {
    Bands sum{};
    double weights = 0.0;
    const auto [from_row, to_row] = range(direction.y() - first_.y(), kernel.most());
    const auto [from_column, to_column] = range(direction.x() - first_.x(), kernel.most());
    const double most = kernel.most() * kernel.most();
    for (std::size_t row = from_row; row < to_row; ++row)
      for (std::size_t column = from_column; column < to_column; ++column) {
        const std::size_t place = row * columns_ + column;
        const double z = heights_[place];
        if (z == 0.0) continue;
        const Vec2 at = cosines(row, column);
        const double chord2 = (at - direction.head<2>()).squaredNorm() + (z - direction.z()) * (z - direction.z());
        if (chord2 >= most) continue;
        const double weight = kernel.per_sr(std::sqrt(chord2));
        weights += weight / z;
        for (std::size_t band = 0; band < 3; ++band) sum[band] += weight * sums_[place][band];
      }
    for (double& band : sum) band /= weights;
    return sum;
  }

 private:
  Vec2 cosines(std::size_t row, std::size_t column) const {
    return first_ + step_ * Vec2(static_cast<double>(column), static_cast<double>(row));
  }
  std::pair<std::size_t, std::size_t> range(double place, double reach) const {
    const auto columns = static_cast<double>(columns_);
    return {static_cast<std::size_t>(std::clamp(std::ceil((place - reach) / step_), 0.0, columns)),
            static_cast<std::size_t>(std::clamp(std::floor((place + reach) / step_) + 1.0, 0.0, columns))};
  }

  Vec2 first_;
  double step_;
  std::size_t columns_;
  std::vector<double> heights_;  ///< z components of the directions; 0 for points at or below the horizon
  std::vector<Bands> sums_;
};

/// A ray that replaces all rays with nearly equal directions.
struct Spot {
  Vec3 direction = Vec3::Zero();  ///< mean direction, weighted with the power
  double power = 0.0;
  Bands bands{};
};

std::vector<Spot> spots_of(std::span<const BandedField> fields, double apart) {
  std::map<std::array<std::int64_t, 2>, Spot> spots;
  for (const BandedField& one : fields)
    for (const FarFieldRay& ray : one.field->rays()) {
      Spot& spot = spots[{std::llround(ray.direction.x() / apart), std::llround(ray.direction.y() / apart)}];
      spot.direction += ray.power * ray.direction;
      spot.power += ray.power;
      for (std::size_t band = 0; band < 3; ++band) spot.bands[band] += one.weights[band] * ray.power;
    }
  std::vector<Spot> all;
  for (auto& [place, spot] : spots) {
    if (!(spot.power > 0.0)) continue;
    spot.direction /= spot.power;
    all.push_back(spot);
  }
  return all;
}

}  // namespace

Vec2 CosineSquare::at(std::size_t index) const {
  const double step = 2.0 * half_width / static_cast<double>(columns - 1);
  return centre - Vec2::Constant(half_width) +
         step * Vec2(static_cast<double>(index % columns), static_cast<double>(index / columns));
}

std::vector<Bands> disc_means(std::span<const BandedField> fields, const CosineSquare& square,
                              const ApertureKernel& kernel, const Cancellation* cancel) {
  std::vector<Bands> means(square.columns * square.columns, Bands{});
  const auto add = [](Bands& to, const std::array<double, 3>& weights, double value) {
    for (std::size_t band = 0; band < 3; ++band) to[band] += weights[band] * value;
  };
  double detail = std::numeric_limits<double>::infinity();
  for (const BandedField& one : fields) detail = std::min(detail, one.field->detail_rad());
  const double step = std::min(detail / kStepsToADetail, kernel.reach_rad() / kStepsToTheReach);
  const bool is_diffracted = std::isfinite(detail);
  // If the square is wide and the discs are small, evaluating the light directly at each grid point is faster than
  // using the lattice.
  const bool is_direct = is_diffracted && Lattice::points(square, kernel.reach_rad(), step) >
                                              static_cast<double>(means.size() * kernel.nodes(detail).size());
  if (is_direct) {
    for (std::size_t k = 0; k < means.size() && !is_cancelled(cancel); ++k)
      if (square.at(k).squaredNorm() < 1.0)
        for (const BandedField& one : fields)
          add(means[k], one.weights, one.field->intensity(upward(square.at(k)), kernel).per_sr);
    return means;
  }
  std::optional<Lattice> lattice;
  if (is_diffracted) {
    lattice.emplace(square, kernel.reach_rad(), step);
    for (const BandedField& one : fields) lattice->add(one, cancel);
  }
  const ChordKernel chords(kernel);
  const std::vector<Spot> spots = spots_of(fields, kSpot * kernel.reach_rad());
  for (std::size_t k = 0; k < means.size() && !is_cancelled(cancel); ++k) {
    if (square.at(k).squaredNorm() >= 1.0) continue;
    const Vec3 direction = upward(square.at(k));
    if (lattice) means[k] = lattice->mean(direction, chords);
    for (const BandedField& one : fields) add(means[k], one.weights, one.field->scattered_per_sr(direction, kernel));
    for (const Spot& spot : spots)
      if (const double chord2 = (spot.direction - direction).squaredNorm(); chord2 < chords.most() * chords.most())
        add(means[k], spot.bands, chords.per_sr(std::sqrt(chord2)));
  }
  return means;
}

}  // namespace retrace::raytrace
