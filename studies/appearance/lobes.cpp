#include "studies/appearance/lobes.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/direction.h"
#include "studies/appearance/table_errors.h"

namespace retrace::studies {
namespace {

using Eigen::ArrayXd, Eigen::ArrayXXd, Eigen::Index;
using geometry::Vec2, geometry::Vec3;

constexpr int kIterations = 300;
// Ring of initial lobes. Distance from the centre and spread are in units of the standard deviation of the mean
// pattern, which is the sum of the table's grids over all directions of light. `count` is the number of lobes.
struct Ring {
  double distance, spread;
  int count;
};
constexpr std::array<Ring, 3> kRings = {{{0.0, 0.3, 1}, {0.7, 0.3, 6}, {1.2, 0.4, 12}}};
// Step of the square lattice of narrow lobes that represent dim light, in grid steps of the table.
constexpr double kStepsPerLattice = 2.5;
// Standard deviation of the lobes on the lattice, in steps of the lattice.
constexpr double kLatticeSpread = 0.7;
// Maximum number of lattice lobes in a row. Shaders keep all lobes in registers or in a small memory.
constexpr int kMaxLobesPerRow = 15;
// Minimum variance of a lobe, in squares of the table's grid step. Narrower lobes would fall between grid points.
constexpr double kMinVariance = 0.5;

std::array<double, Lobe::kTerms> terms_of(const Vec2& place) {
  std::array<double, Lobe::kTerms> terms{};
  std::size_t term = 0;
  for (int degree = 0; degree <= 4; ++degree)
    for (int j = 0; j <= degree; ++j) terms[term++] = std::pow(place.x(), degree - j) * std::pow(place.y(), j);
  return terms;
}

double density(const Lobe& lobe, const Vec2& deviation) {
  const Vec2 d = deviation - lobe.centre;
  const double square =
      (lobe.spread.y() * d.x() * d.x() - 2.0 * lobe.covariance * d.x() * d.y() + lobe.spread.x() * d.y() * d.y()) /
      lobe.determinant();
  return lobe.peak() * std::exp(-0.5 * square);
}

class Fit {
 public:
  explicit Fit(const ReflectionTable& table) : table_(table) {
    const auto points = static_cast<Index>(table.columns * table.columns);
    const auto lights = static_cast<Index>(table.directions.size());
    for (ArrayXXd* power : {&power_[0], &power_[1], &power_[2], &luminous_}) *power = ArrayXXd::Zero(points, lights);
    for (Index light = 0; light < lights; ++light) {
      const ReflectionTable::Direction& direction = table.directions[static_cast<std::size_t>(light)];
      const Vec3 to_source = geometry::direction_at(direction.entrance, direction.azimuth);
      for (Index point = 0; point < points; ++point) {
        const Vec2 view = table.central_direction(to_source) + table.deviation(static_cast<std::size_t>(point));
        if (view.squaredNorm() >= 1.0) continue;
        const double share = table.step() * table.step() / (to_source.z() * std::sqrt(1.0 - view.squaredNorm()));
        const Rgb& r_a = direction.r_a[static_cast<std::size_t>(point)];
        for (std::size_t band = 0; band < 3; ++band) power_[band](point, light) = share * r_a[band];
        luminous_(point, light) = share * std::max(luminous(r_a), 0.0);
      }
    }
    begin();
  }

  ReflectionLobes fitted() {
    for (int round = 0; round < kIterations; ++round) improve();
    colour();
    add_lattice();
    fit_powers();
    ReflectionLobes result{{}, std::sin(table_.max_entrance.rad()), table_.mirrors, table_.back};
    Eigen::MatrixXd terms(luminous_.cols(), static_cast<Index>(Lobe::kTerms));
    for (Index light = 0; light < terms.rows(); ++light) {
      const ReflectionTable::Direction& direction = table_.directions[static_cast<std::size_t>(light)];
      const auto row = terms_of(geometry::direction_at(direction.entrance, direction.azimuth).head<2>() / result.scale);
      for (Index term = 0; term < terms.cols(); ++term) terms(light, term) = row[static_cast<std::size_t>(term)];
    }
    const Eigen::MatrixXd coefficients = terms.colPivHouseholderQr().solve(of_light_.matrix());
    for (std::size_t k = 0; k < lobes_.size(); ++k) {
      for (std::size_t term = 0; term < Lobe::kTerms; ++term)
        lobes_[k].power[term] = coefficients(static_cast<Index>(term), static_cast<Index>(k));
    }
    result.lobes = lobes_;
    return result;
  }

 private:
  /// Creates the initial lobes in rings about the centre. Their size is proportional to the spread of the mean pattern.
  void begin() {
    const ArrayXd mean = luminous_.rowwise().sum();
    Vec2 squares = Vec2::Zero();
    for (Index point = 0; point < mean.size(); ++point)
      squares += mean[point] * table_.deviation(static_cast<std::size_t>(point)).cwiseAbs2();
    const double unit = std::sqrt(squares.sum() / std::max(mean.sum(), 1e-300));
    for (const Ring& ring : kRings)
      for (int k = 0; k < ring.count; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / ring.count;
        Lobe lobe;
        lobe.centre = ring.distance * unit * Vec2(std::cos(angle), std::sin(angle));
        lobe.spread = Vec2::Constant(std::max(std::pow(ring.spread * unit, 2.0), min_variance()));
        lobes_.push_back(lobe);
      }
    of_light_ = ArrayXXd::Ones(luminous_.cols(), static_cast<Index>(lobes_.size()));
  }

  double min_variance() const { return kMinVariance * table_.step() * table_.step(); }

  /// Returns the densities of the lobes at the grid points, with one row for each grid point and one column for each
  /// lobe.
  ArrayXXd lobe_densities() const {
    ArrayXXd densities(luminous_.rows(), static_cast<Index>(lobes_.size()));
    for (Index k = 0; k < densities.cols(); ++k)
      for (Index point = 0; point < densities.rows(); ++point)
        densities(point, k) =
            density(lobes_[static_cast<std::size_t>(k)], table_.deviation(static_cast<std::size_t>(point)));
    return densities;
  }

  /// Adds a square lattice of lobes that covers all deviations from the central direction of view. The lobes have the
  /// colour of the central lobe.
  void add_lattice() {
    const double steps = static_cast<double>(table_.columns - 1) / kStepsPerLattice;
    const int row = std::clamp(static_cast<int>(std::ceil(steps)) + 1, 2, kMaxLobesPerRow);
    const double step = 2.0 * table_.half_width / (row - 1);
    for (int j = 0; j < row; ++j)
      for (int i = 0; i < row; ++i) {
        Lobe lobe = lobes_.front();
        lobe.centre = step * Vec2(i, j) - Vec2::Constant(table_.half_width);
        lobe.spread = Vec2::Constant(std::pow(kLatticeSpread * step, 2.0));
        lobe.covariance = 0.0;
        lobes_.push_back(lobe);
      }
    of_light_ = ArrayXXd::Zero(luminous_.cols(), static_cast<Index>(lobes_.size()));
  }

  /// Computes the powers of the lobes for each direction of light by a least-squares fit. The errors are relative, as
  /// in AppearanceError.
  void fit_powers() {
    const Eigen::MatrixXd densities = table_.step() * table_.step() * lobe_densities().matrix();
    for (Index light = 0; light < luminous_.cols(); ++light) {
      const Eigen::VectorXd power = luminous_.col(light).matrix();
      const double floor = kErrorFloor * std::max(power.maxCoeff(), 1e-300);
      const Eigen::VectorXd weights = power.cwiseMax(floor).cwiseInverse();
      const Eigen::MatrixXd weighted = weights.asDiagonal() * densities;
      of_light_.row(light) = weighted.colPivHouseholderQr().solve(weights.cwiseProduct(power)).transpose().array();
    }
  }

  /// Returns the sum of the lobes at the grid points, with one row for each grid point and one column for each
  /// direction of light.
  ArrayXXd model_of(const ArrayXXd& densities) const {
    return (densities.matrix() * of_light_.matrix().transpose()).array().max(1e-300);
  }

  /// Runs one step of expectation maximization. The power at each grid point is divided among the lobes in proportion
  /// to their densities. The shape of each lobe is then computed from its part of the power.
  void improve() {
    const ArrayXXd densities = lobe_densities();
    const ArrayXXd ratio = luminous_ / model_of(densities);
    const ArrayXXd got = densities * (ratio.matrix() * of_light_.matrix()).array();
    for (std::size_t k = 0; k < lobes_.size(); ++k) reshape(lobes_[k], got.col(static_cast<Index>(k)));
    of_light_ *= (ratio.matrix().transpose() * densities.matrix()).array();
  }

  /// Sets the colour of each lobe to the colour of its part of the power. The power at each grid point is divided among
  /// the lobes in the same way as in improve().
  void colour() {
    const ArrayXXd densities = lobe_densities();
    const ArrayXXd model = model_of(densities);
    for (std::size_t band = 0; band < 3; ++band) {
      const ArrayXXd got = densities * ((power_[band] / model).matrix() * of_light_.matrix()).array();
      for (std::size_t k = 0; k < lobes_.size(); ++k) lobes_[k].colour[band] = got.col(static_cast<Index>(k)).sum();
    }
    for (Lobe& lobe : lobes_) {
      const double sum = luminous(lobe.colour);
      for (double& band : lobe.colour) band = sum > 0.0 ? band / sum : 1.0;
    }
  }

  /// Sets centre and covariance of a lobe to the mean and covariance of its part of the power.
  /// \param got part of the power at each grid point
  void reshape(Lobe& lobe, const ArrayXd& got) const {
    const double sum = got.sum();
    if (!(sum > 0.0)) return;
    Vec2 mean = Vec2::Zero();
    for (Index point = 0; point < got.size(); ++point)
      mean += got[point] / sum * table_.deviation(static_cast<std::size_t>(point));
    Vec2 squares = Vec2::Zero();
    double mixed = 0.0;
    for (Index point = 0; point < got.size(); ++point) {
      const Vec2 d = table_.deviation(static_cast<std::size_t>(point)) - mean;
      squares += got[point] / sum * d.cwiseAbs2();
      mixed += got[point] / sum * d.x() * d.y();
    }
    lobe.centre = mean;
    lobe.spread = squares.cwiseMax(min_variance());
    const double most = 0.99 * std::sqrt(lobe.spread.x() * lobe.spread.y());
    lobe.covariance = std::clamp(mixed, -most, most);
  }

  const ReflectionTable& table_;
  std::array<ArrayXXd, 3> power_;  ///< indexed by grid point and direction of light
  ArrayXXd luminous_;
  std::vector<Lobe> lobes_;
  ArrayXXd of_light_;  ///< powers of the lobes: one row per direction of light, one column per lobe
};

}  // namespace

double Lobe::peak() const {
  return 1.0 / (2.0 * std::numbers::pi * std::sqrt(determinant()));
}

Rgb ReflectionLobes::r_a(const Vec3& to_source, const Vec3& to_observer) const {
  Vec2 light = to_source.head<2>();
  Vec2 deviation = to_observer.head<2>() - back.cwiseProduct(light);
  for (const Eigen::Index axis : {0, 1})
    if (mirrors[static_cast<std::size_t>(axis)] && light[axis] < 0.0) {
      light[axis] = -light[axis];
      deviation[axis] = -deviation[axis];
    }
  Rgb sum{};
  if (light.norm() > scale * (1.0 + 1e-9)) return sum;
  const auto terms = terms_of(light / scale);
  for (const Lobe& lobe : lobes) {
    double power = 0.0;
    for (std::size_t term = 0; term < terms.size(); ++term) power += lobe.power[term] * terms[term];
    const double r_a = to_source.z() * to_observer.z() * power * density(lobe, deviation);
    for (std::size_t band = 0; band < sum.size(); ++band) sum[band] += r_a * lobe.colour[band];
  }
  for (double& band : sum) band = std::max(band, 0.0);
  return sum;
}

ReflectionLobes fitted_lobes(const ReflectionTable& table) {
  return Fit(table).fitted();
}

}  // namespace retrace::studies
