#include "geometry/surface/periodic_spline.h"

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <algorithm>
#include <stdexcept>

namespace retrace::geometry {
namespace {

using jets::constant_like;
using jets::line_series;
using jets::Series;

constexpr double kPeriod = 2.0 * std::numbers::pi;

/// Knots, continued periodically in both directions.
struct Knots {
  const std::vector<double>& base;

  double operator[](long i) const {
    const long n = static_cast<long>(base.size());
    const long turn = i >= 0 ? i / n : -((-i + n - 1) / n);
    return base[static_cast<std::size_t>(i - turn * n)] + static_cast<double>(turn) * kPeriod;
  }
};

/// Returns the degree + 1 B-splines that are not 0 between the knots m and m + 1, evaluated at x. The first has the
/// index m - degree (Cox-de Boor recurrence, de Boor ch. X eq. 4).
template <class T>
std::vector<T> basis_at(const Knots& knots, long m, int degree, const T& x) {
  std::vector<T> b(static_cast<std::size_t>(degree) + 1, constant_like(x, 0.0));
  b[0] = constant_like(x, 1.0);
  for (int p = 1; p <= degree; ++p) {
    T saved = constant_like(x, 0.0);
    for (int r = 0; r < p; ++r) {
      const double right = knots[m + r + 1];
      const double left = knots[m + 1 - p + r];
      const T share = b[static_cast<std::size_t>(r)] / (right - left);
      b[static_cast<std::size_t>(r)] = saved + (right - x) * share;
      saved = (x - left) * share;
    }
    b[static_cast<std::size_t>(p)] = saved;
  }
  return b;
}

std::size_t wrapped(long i, std::size_t n) {
  const long size = static_cast<long>(n);
  return static_cast<std::size_t>(((i % size) + size) % size);
}

std::vector<double> knots_of(const std::vector<double>& sites, int degree) {
  if (degree % 2 != 0) return sites;
  std::vector<double> knots;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const double next = i + 1 < sites.size() ? sites[i + 1] : sites.front() + kPeriod;
    knots.push_back(0.5 * (sites[i] + next));
  }
  return knots;
}

void check_sites(const std::vector<double>& sites, std::size_t values, int degree) {
  if (degree < 2 || degree > kMaxSplineDegree) throw std::invalid_argument("degree of a periodic spline");
  if (sites.size() != values || sites.size() < static_cast<std::size_t>(degree) + 2)
    throw std::invalid_argument("a periodic spline requires more sites than its degree + 1");
  for (std::size_t i = 0; i + 1 < sites.size(); ++i)
    if (!(sites[i] < sites[i + 1])) throw std::invalid_argument("sites of a periodic spline must rise");
  if (!(sites.back() - sites.front() < kPeriod))
    throw std::invalid_argument("sites of a periodic spline must lie within one period");
}

/// Returns the weights of the B-splines for interpolation.
Eigen::VectorXd weights(const std::vector<double>& sites, const std::vector<double>& values, const Knots& knots,
                        int degree) {
  const std::size_t n = sites.size();
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right(static_cast<Eigen::Index>(n));
  for (std::size_t j = 0; j < n; ++j) {
    // For even degrees, site j is between the knots j - 1 and j.
    const long m = static_cast<long>(j) - (degree % 2 == 0 ? 1 : 0);
    const std::vector<double> b = basis_at(knots, m, degree, sites[j]);
    for (int k = 0; k <= degree; ++k)
      entries.emplace_back(static_cast<int>(j), static_cast<int>(wrapped(m - degree + k, n)),
                           b[static_cast<std::size_t>(k)]);
    right[static_cast<Eigen::Index>(j)] = values[j];
  }
  Eigen::SparseMatrix<double> matrix(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(matrix);
  if (solver.info() != Eigen::Success) throw std::invalid_argument("no periodic spline through these sites");
  Eigen::VectorXd w = solver.solve(right);
  w += solver.solve(Eigen::VectorXd(right - matrix * w));
  if (!w.allFinite()) throw std::invalid_argument("no periodic spline through these sites");
  return w;
}

}  // namespace

PeriodicSpline::PeriodicSpline(const std::vector<double>& sites_rad, const std::vector<double>& values, int degree)
    : degree_(degree) {
  check_sites(sites_rad, values.size(), degree);
  knots_ = knots_of(sites_rad, degree);
  const std::size_t n = knots_.size();
  const Knots knots{knots_};
  const Eigen::VectorXd w = weights(sites_rad, values, knots, degree);
  coefficients_.assign(n * stride(), 0.0);
  for (std::size_t m = 0; m < n; ++m) {
    const Series<double> x = line_series(knots_[m], 1.0, degree);
    const std::vector<Series<double>> b = basis_at(knots, static_cast<long>(m), degree, x);
    for (int k = 0; k <= degree; ++k)
      for (int i = 0; i <= degree; ++i)
        coefficients_[m * stride() + static_cast<std::size_t>(i)] +=
            w[static_cast<Eigen::Index>(wrapped(static_cast<long>(m) - degree + k, n))] *
            b[static_cast<std::size_t>(k)][i];
  }
  index_pieces();
}

PeriodicSpline PeriodicSpline::constant(double value, int degree) {
  std::vector<double> sites;
  const int count = degree + 2;
  for (int i = 0; i < count; ++i) sites.push_back(kPeriod * i / count);
  return {sites, std::vector<double>(sites.size(), value), degree};
}

PeriodicSpline PeriodicSpline::mapped(double factor, double offset) const {
  PeriodicSpline result = *this;
  for (double& c : result.coefficients_) c *= factor;
  for (std::size_t i = 0; i < result.coefficients_.size(); i += stride()) result.coefficients_[i] += offset;
  return result;
}

void PeriodicSpline::index_pieces() {
  buckets_.assign(2 * knots_.size(), 0);
  for (std::size_t b = 0; b < buckets_.size(); ++b) {
    const double start = knots_.front() + kPeriod * static_cast<double>(b) / static_cast<double>(buckets_.size());
    const auto above = std::upper_bound(knots_.begin(), knots_.end(), start);
    buckets_[b] = above == knots_.begin() ? 0 : static_cast<std::size_t>(above - knots_.begin()) - 1;
  }
}

std::size_t PeriodicSpline::piece_at(double angle_rad) const {
  const double share = (angle_rad - knots_.front()) / kPeriod;
  const auto bucket = static_cast<std::size_t>(std::max(0.0, share * static_cast<double>(buckets_.size())));
  std::size_t piece = buckets_[std::min(bucket, buckets_.size() - 1)];
  while (piece + 1 < knots_.size() && knots_[piece + 1] <= angle_rad) ++piece;
  return piece;
}

}  // namespace retrace::geometry
