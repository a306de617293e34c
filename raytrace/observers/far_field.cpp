#include "raytrace/observers/far_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "raytrace/light/light_setup.h"
#include "raytrace/observers/distant_directions.h"
#include "raytrace/observers/lattice_field.h"
#include "raytrace/observers/small_angle.h"
#include "raytrace/sampling/replicate_means.h"

namespace retrace::raytrace {
namespace {

using geometry::Vec2, std::numbers::pi;

// Number of lattice points per finest detail of the diffracted power density. It is sufficient, because this density is
// band-limited.
constexpr double kPointsToADetail = 1.5;
// Number of lattice points per radius of a cone. A cone needs more points than a detail, because the lattice
// approximates the edge of the cone in steps.
constexpr double kPointsToARadius = 48.0;
// Maximum distance from the axis of the cone at which facet forms are taken into account, divided by the largest
// deflection that the forms cause. At larger distances, the density is low, and forms change it only by a small
// fraction.
constexpr double kFarInBends = 4.0;
// Number of diffraction orders of an array that are computed individually. The power of orders at larger angles is
// computed as an integral.
constexpr double kSingleOrders = 50'000.0;
// Minimum radius of the circle of individual orders, as a multiple of the distance to the farthest point of a cone.
constexpr double kBeyondCone = 1.1;

/// Returns the derivatives of the direction cosines x and y with respect to the angles to the right and upwards.
Eigen::Matrix2d axes_of(const ReturnFrame& frame) {
  Eigen::Matrix2d axes;
  axes << frame.right.head<2>(), frame.up.head<2>();
  return axes;
}

ReturnFrame frame_about(const Vec3& direction) {
  ReturnFrame frame;
  frame.to_source = direction;
  frame.right = source_axis(direction);
  frame.up = direction.cross(frame.right);
  return frame;
}

/// Returns true if the direction with the given direction cosines exists and is inside a cone about the direction to
/// the source.
bool is_in_cone(const Vec2& cosines, const ReturnFrame& frame, double half_angle_rad) {
  const double height2 = 1.0 - cosines.squaredNorm();
  return height2 > 0.0 &&
         small_angle_between({cosines.x(), cosines.y(), std::sqrt(height2)}, frame.to_source) <= half_angle_rad;
}

/// Returns the mean and the standard error over the replicates.
/// \param sums the sum over beams that were traced exactly, followed by each replicate divided by the number of
///        replicates
FarFieldIntensity mean_of_replicates(const Eigen::ArrayXd& sums) {
  const Eigen::Index count = sums.size() - 1;
  if (count == 0) return {sums[0], 0.0};
  const auto replicates = static_cast<double>(count);
  const Eigen::ArrayXd own = replicates * sums.tail(count);
  const double variance = (own - own.mean()).square().sum() / (replicates - 1.0);
  return {sums[0] + own.mean(), student_factor(static_cast<std::size_t>(count)) * std::sqrt(variance / replicates)};
}

}  // namespace

double CoherentGroup::power() const {
  double sum = 0.0;
  for (const FieldPolygon& p : polygons) sum += p.power;
  return copies * sum;
}

double CoherentGroup::specular_power() const {
  double sum = 0.0;
  for (const FieldPolygon& p : polygons) sum += p.mean_factor * p.mean_factor * p.power;
  return copies * sum;
}

bool CoherentGroup::has_form() const {
  for (const FieldPolygon& p : polygons)
    for (const FieldHit& hit : p.hits)
      if (hit.path_per_height != 0.0) return true;
  return false;
}

double FarField::diffracted_power() const {
  double sum = 0.0;
  for (const CoherentGroup& group : groups_) sum += group.specular_power();
  return sum;
}

double FarField::detail_rad() const {
  double finest = std::numeric_limits<double>::infinity();
  for (const CoherentGroup& group : groups_) finest = std::min(finest, wavelength_mm_ / group.extent_mm);
  return finest;
}

/// Returns the power per unit area of direction cosines. It is also defined beyond the horizon, where the theory
/// predicts some light for cells that are not much larger than the wavelength.
Eigen::ArrayXXd FarField::by_replicate(const std::vector<Vec2>& cosines, const ApertureField& field) const {
  Eigen::ArrayXXd power = field.per_cosines(cosines, cancel_);
  if (lattice_ != nullptr)
    for (std::size_t k = 0; k < cosines.size(); ++k)
      power(static_cast<Eigen::Index>(k), 0) *= 1.0 - lattice_->coherent_fraction(cosines[k]);
  const std::vector<double> fringes = scattered_.fringes_per_cosines(cosines, cancel_);
  for (std::size_t k = 0; k < cosines.size(); ++k) power(static_cast<Eigen::Index>(k), 0) += fringes[k];
  return power;
}

std::vector<double> FarField::per_cosines(const std::vector<Vec2>& cosines, const ApertureField& field) const {
  const Eigen::ArrayXd sums = by_replicate(cosines, field).rowwise().sum();
  return {sums.begin(), sums.end()};
}

double FarField::diffracted_per_sr(const Vec3& direction) const {
  return diffracted_per_sr(std::vector{direction}).front();
}

std::vector<double> FarField::diffracted_per_sr(const std::vector<Vec3>& directions) const {
  std::vector<Vec2> cosines;
  for (const Vec3& direction : directions) cosines.push_back(direction.head<2>());
  std::vector<double> power = per_cosines(cosines, field_);
  for (std::size_t k = 0; k < power.size(); ++k) power[k] *= std::max(0.0, directions[k].z());
  return power;
}

double FarField::scattered_per_sr(const Vec3& direction) const {
  return direction.z() > 0.0 ? direction.z() * scattered_.lobes_per_cosines(direction.head<2>()) : 0.0;
}

double FarField::scattered_per_sr(const Vec3& direction, const ApertureKernel& kernel) const {
  return lobes_by_replicate(direction, kernel).sum();
}

Eigen::ArrayXd FarField::lobes_by_replicate(const Vec3& direction, const ApertureKernel& kernel) const {
  return direction.z() * scattered_.lobes_by_replicate(direction.head<2>(), axes_of(frame_about(direction)), kernel);
}

double FarField::scattered_within(const ReturnFrame& frame, double half_angle_rad) const {
  return scattered_.lobes_within(std::cos(half_angle_rad) * frame.to_source.head<2>(),
                                 std::sin(half_angle_rad) * axes_of(frame));
}

FarFieldIntensity FarField::intensity(const Vec3& direction, const ApertureKernel& kernel) const {
  Eigen::ArrayXd sums = Eigen::ArrayXd::Zero(1 + replicates_);
  for (const FarFieldRay& ray : rays_)
    sums[ray.replicate ? 1 + *ray.replicate : 0] +=
        ray.power * kernel.per_sr(small_angle_between(ray.direction, direction));
  sums += lobes_by_replicate(direction, kernel);
  if (groups_.empty()) return mean_of_replicates(sums);
  const ReturnFrame frame = frame_about(direction);
  const std::vector<ApertureKernel::Node> nodes = kernel.nodes(detail_rad());
  std::vector<Vec3> directions;
  std::vector<Vec2> cosines;
  for (const ApertureKernel::Node& node : nodes) {
    directions.push_back(frame.direction(node.offset_rad));
    cosines.push_back(directions.back().head<2>());
  }
  const Eigen::ArrayXXd per_cosines = by_replicate(cosines, field_);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    sums += nodes[k].weight *
            (per_cosines.row(static_cast<Eigen::Index>(k)).transpose() * std::max(0.0, directions[k].z()));
  if (lattice_ != nullptr) sums[0] += lattice_->per_sr(direction.head<2>(), axes_of(frame), kernel, cancel_);
  return mean_of_replicates(sums);
}

std::vector<double> FarField::binned(const ReturnFrame& frame, const DirectionGrid& grid) const {
  std::vector<double> sums(grid.size() + 1, 0.0);
  for (const FarFieldRay& ray : rays_)
    sums[grid.bin_of(frame.angles_rad(ray.direction)).value_or(grid.size())] += ray.power;
  sums.back() += unplaced_power_;
  if (groups_.empty() && scattered_.power() == 0.0) return sums;
  double inside = 0.0;
  std::vector<Vec3> directions;
  for (std::size_t bin = 0; bin < grid.size(); ++bin) directions.push_back(frame.direction(grid.centre_rad(bin)));
  const std::vector<double> diffracted = diffracted_per_sr(directions);
  for (std::size_t bin = 0; bin < grid.size(); ++bin) {
    const double power = (diffracted[bin] + scattered_per_sr(directions[bin])) * grid.solid_angle_sr(bin);
    sums[bin] += power;
    inside += power;
  }
  if (lattice_ != nullptr) inside += add_orders(frame, grid, sums);
  sums.back() += std::max(0.0, diffracted_power() + scattered_.power() - inside);
  return sums;
}

/// Adds the power of the diffraction orders to the bins of their directions, and returns the sum of the added powers.
double FarField::add_orders(const ReturnFrame& frame, const DirectionGrid& grid, std::vector<double>& bins) const {
  // Distance to the corners of a square grid.
  const double radius =
      std::min(1.0, kBeyondCone * std::numbers::sqrt2 * std::sin(std::min(grid.half_width_rad(), 1.0)));
  double sum = 0.0;
  for (const LatticeField::Order& order :
       lattice_->orders_near(frame.to_source.head<2>(), radius, LatticeField::Light::band, cancel_)) {
    const double height2 = 1.0 - order.cosines.squaredNorm();
    if (!(height2 > 0.0)) continue;
    const auto bin = grid.bin_of(frame.angles_rad({order.cosines.x(), order.cosines.y(), std::sqrt(height2)}));
    if (!bin) continue;
    bins[*bin] += order.power;
    sum += order.power;
  }
  return sum;
}

FarField::Split FarField::split(const ReturnFrame& frame, double half_angle_rad) const {
  Split split;
  for (const FarFieldRay& ray : rays_)
    (small_angle_between(ray.direction, frame.to_source) <= half_angle_rad ? split.inside : split.outside) += ray.power;
  const double scattered = scattered_within(frame, half_angle_rad);
  split.inside += scattered;
  split.outside += scattered_.power() - scattered + unplaced_power_;
  if (groups_.empty()) return split;
  const double step = std::min(detail_rad() / kPointsToADetail, half_angle_rad / kPointsToARadius);
  const auto reach = static_cast<std::int64_t>(std::ceil(half_angle_rad / step));
  for (std::int64_t j = -reach; j <= reach; ++j) {
    std::vector<Vec3> row;
    std::vector<double> shares;
    for (std::int64_t i = -reach; i <= reach; ++i) {
      const Vec2 at = step * Vec2(static_cast<double>(i), static_cast<double>(j));
      const double angle = at.norm();
      if (angle > half_angle_rad) continue;
      row.push_back(frame.direction(at));
      shares.push_back(step * step * (angle > 0.0 ? std::sin(angle) / angle : 1.0));
    }
    const std::vector<double> per_sr = diffracted_per_sr(row);
    for (std::size_t k = 0; k < row.size(); ++k) split.inside += shares[k] * per_sr[k];
  }
  split.outside += tail(frame, half_angle_rad);
  if (lattice_ != nullptr) {
    const Split orders = split_orders(frame, half_angle_rad);
    split.inside += orders.inside;
    split.outside += orders.outside;
  }
  return split;
}

/// Returns the power of the diffraction orders inside and outside of a cone.
FarField::Split FarField::split_orders(const ReturnFrame& frame, double half_angle_rad) const {
  const Vec2 centre = frame.to_source.head<2>();
  const double radius = std::max(lattice_->radius_of_orders(kSingleOrders), kBeyondCone * std::sin(half_angle_rad));
  Split split;
  for (const LatticeField::Order& order :
       lattice_->orders_near(centre, radius, LatticeField::Light::single_wavelength, cancel_))
    (is_in_cone(order.cosines, frame, half_angle_rad) ? split.inside : split.outside) += order.power;
  split.outside += lattice_->power_beyond(centre, radius, cancel_);
  return split;
}

/// Returns the diffracted power outside of a cone, integrated over the plane of direction cosines.
double FarField::tail(const ReturnFrame& frame, double half_angle_rad) const {
  // The outline of the cone in this plane is further from the axis than `nearest`.
  const double nearest = 0.9 * frame.to_source.z() * std::sin(half_angle_rad);
  const bool is_far = !plane_groups_.empty() && nearest > kFarInBends * max_deflection_;
  const DistantDirections distant(frame.to_source.head<2>(), nearest);
  std::vector<Vec2> outside;
  std::vector<double> areas;
  for (std::size_t k = 0; k < distant.cosines.size(); ++k) {
    if (is_in_cone(distant.cosines[k], frame, half_angle_rad)) continue;
    outside.push_back(distant.cosines[k]);
    areas.push_back(distant.areas[k]);
  }
  const std::vector<double> density = per_cosines(outside, is_far ? plane_field_ : field_);
  double sum = 0.0;
  for (std::size_t k = 0; k < density.size(); ++k) sum += areas[k] * density[k];
  return distant.factor * sum;
}

}  // namespace retrace::raytrace
