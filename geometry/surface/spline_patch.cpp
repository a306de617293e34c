#include "geometry/surface/spline_patch.h"

#include <algorithm>
#include <utility>

namespace retrace::geometry {
namespace {

constexpr std::size_t kDegree = 3;
// Number of diagonals of the collocation matrix on each side of the main diagonal.
constexpr std::size_t kBand = 3;

/// Square matrix whose elements are 0 except near the diagonal.
class BandedMatrix {
 public:
  explicit BandedMatrix(std::size_t size) : rows_(size) {}

  /// \pre |row - column| <= kBand
  double& at(std::size_t row, std::size_t column) { return rows_[row].at(column + kBand - row); }

  /// Solves the linear equations by Gaussian elimination. Pivoting is not needed, because collocation matrices of
  /// B-splines are totally positive (de Boor and Pinkus, Numer. Math. 27, 485, 1977).
  std::vector<double> solve(std::vector<double> right_side) {
    const std::size_t size = rows_.size();
    for (std::size_t k = 0; k < size; ++k)
      for (std::size_t row = k + 1; row <= std::min(size - 1, k + kBand); ++row) {
        const double factor = at(row, k) / at(k, k);
        if (factor == 0.0) continue;
        for (std::size_t column = k; column <= std::min(size - 1, k + kBand); ++column)
          at(row, column) -= factor * at(k, column);
        right_side[row] -= factor * right_side[k];
      }
    for (std::size_t k = size; k-- > 0;) {
      for (std::size_t column = k + 1; column <= std::min(size - 1, k + kBand); ++column)
        right_side[k] -= at(k, column) * right_side[column];
      right_side[k] /= at(k, k);
    }
    return right_side;
  }

 private:
  std::vector<std::array<double, 2 * kBand + 1>> rows_;
};

}  // namespace

SplineAxis::SplineAxis(double low, double high, std::size_t count) : low_(low), high_(high), count_(count) {
  knots_.assign(kDegree + 1, low);
  for (std::size_t k = 2; k + 2 < count; ++k) knots_.push_back(site(k));
  knots_.insert(knots_.end(), kDegree + 1, high);
}

double SplineAxis::site(std::size_t k) const {
  return k + 1 == count_ ? high_ : low_ + static_cast<double>(k) * step();
}

SplineAxis::Basis SplineAxis::at(double position) const {
  const auto inner = std::upper_bound(knots_.begin() + kDegree + 1, knots_.end() - kDegree - 1, position);
  const auto span = static_cast<std::size_t>(inner - knots_.begin()) - 1;
  Basis basis;
  basis.first = span - kDegree;
  // Recurrence of Cox and de Boor
  basis.value[0] = 1.0;
  for (std::size_t degree = 1; degree <= kDegree; ++degree) {
    double carried = 0.0;
    for (std::size_t k = 0; k < degree; ++k) {
      const double right = knots_[span + 1 + k] - position;
      const double left = position - knots_[span + 1 + k - degree];
      const double share = basis.value.at(k) / (right + left);
      basis.value.at(k) = carried + right * share;
      carried = left * share;
    }
    basis.value.at(degree) = carried;
  }
  return basis;
}

std::vector<double> SplineAxis::interpolated(std::vector<double> values) const {
  BandedMatrix matrix(count_);
  for (std::size_t row = 0; row < count_; ++row) {
    const Basis basis = at(site(row));
    for (std::size_t k = 0; k <= kDegree; ++k)
      if (basis.value.at(k) != 0.0) matrix.at(row, basis.first + k) = basis.value.at(k);
  }
  return matrix.solve(std::move(values));
}

double spline_value(const SplineAxis& axis, const std::vector<double>& coefficients, double position) {
  const SplineAxis::Basis basis = axis.at(position);
  double value = 0.0;
  for (std::size_t k = 0; k <= kDegree; ++k) value += basis.value.at(k) * coefficients[basis.first + k];
  return value;
}

double SplinePatch::height_mm(const Vec2& point_mm) const {
  const SplineAxis::Basis along_x = x.at(point_mm.x());
  const SplineAxis::Basis along_y = y.at(point_mm.y());
  double height = 0.0;
  for (std::size_t j = 0; j <= kDegree; ++j)
    for (std::size_t i = 0; i <= kDegree; ++i)
      height +=
          along_y.value.at(j) * along_x.value.at(i) * heights_mm[(along_y.first + j) * x.count() + along_x.first + i];
  return height;
}

SplinePatch interpolated_patch(const SplineAxis& x, const SplineAxis& y,
                               const std::function<double(const Vec2&)>& height_mm) {
  SplinePatch patch{x, y, std::vector<double>(x.count() * y.count())};
  for (std::size_t j = 0; j < y.count(); ++j) {
    std::vector<double> row;
    for (std::size_t i = 0; i < x.count(); ++i) row.push_back(height_mm({x.site(i), y.site(j)}));
    row = x.interpolated(std::move(row));
    std::copy(row.begin(), row.end(), patch.heights_mm.begin() + static_cast<std::ptrdiff_t>(j * x.count()));
  }
  for (std::size_t i = 0; i < x.count(); ++i) {
    std::vector<double> column;
    for (std::size_t j = 0; j < y.count(); ++j) column.push_back(patch.heights_mm[j * x.count() + i]);
    column = y.interpolated(std::move(column));
    for (std::size_t j = 0; j < y.count(); ++j) patch.heights_mm[j * x.count() + i] = column[j];
  }
  return patch;
}

}  // namespace retrace::geometry
