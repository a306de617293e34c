#include "report/contours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace retrace::report {
namespace {

/// Edge of the grid from a value to its right neighbour (index 2 k) or to its upper neighbour (index 2 k + 1), where k
/// is the index of the value.
using Edge = std::size_t;

class ContourTracer {
 public:
  ContourTracer(const std::vector<double>& values, std::size_t columns, double level)
      : values_(values), columns_(columns), level_(level) {
    for (std::size_t row = 0; (row + 1) * columns < values.size(); ++row)
      for (std::size_t column = 0; column + 1 < columns; ++column) cross(row * columns + column);
  }

  std::vector<std::vector<Point>> lines() {
    std::vector<std::vector<Point>> all;
    // Open lines begin at an edge with a single neighbour. The remaining lines are closed.
    for (const bool is_open : {true, false})
      for (const auto& [edge, next] : neighbours_)
        if (next.size() == 1 || (!is_open && !next.empty())) all.push_back(follow(edge));
    return all;
  }

 private:
  /// Adds the lines within the cell whose lower left value has the index k.
  void cross(std::size_t k) {
    const std::array<std::size_t, 4> corners = {k, k + 1, k + 1 + columns_, k + columns_};
    const std::array<Edge, 4> edges = {2 * k, 2 * (k + 1) + 1, 2 * (k + columns_), 2 * k + 1};
    double sum = 0.0;
    std::vector<Edge> crossed;
    for (std::size_t c = 0; c < 4; ++c) {
      sum += values_[corners[c]];
      if (is_above(corners[c]) != is_above(corners[(c + 1) % 4])) crossed.push_back(edges[c]);
    }
    if (!std::isfinite(sum)) return;
    if (crossed.size() == 2) connect(crossed[0], crossed[1]);
    if (crossed.size() != 4) return;
    // At a saddle, the mean of the corners is the value at the centre. It decides which corners are connected.
    const std::size_t shift = (0.25 * sum >= level_) == is_above(k) ? 1 : 0;
    connect(crossed[(3 + shift) % 4], crossed[(0 + shift) % 4]);
    connect(crossed[(1 + shift) % 4], crossed[(2 + shift) % 4]);
  }

  bool is_above(std::size_t k) const { return values_[k] >= level_; }

  void connect(Edge a, Edge b) {
    neighbours_[a].push_back(b);
    neighbours_[b].push_back(a);
  }

  std::vector<Point> follow(Edge edge) {
    std::vector<Point> line = {point_on(edge)};
    while (!neighbours_[edge].empty()) {
      const Edge next = neighbours_[edge].back();
      neighbours_[edge].pop_back();
      std::vector<Edge>& back = neighbours_[next];
      back.erase(std::find(back.begin(), back.end(), edge));
      line.push_back(point_on(next));
      edge = next;
    }
    return line;
  }

  Point point_on(Edge edge) const {
    const std::size_t k = edge / 2;
    const std::size_t other = edge % 2 == 0 ? k + 1 : k + columns_;
    const double t = (level_ - values_[k]) / (values_[other] - values_[k]);
    const Point at{static_cast<double>(k % columns_), static_cast<double>(k / columns_)};
    return edge % 2 == 0 ? Point{at.x + t, at.y} : Point{at.x, at.y + t};
  }

  const std::vector<double>& values_;
  std::size_t columns_;
  double level_;
  std::map<Edge, std::vector<Edge>> neighbours_;
};

}  // namespace

std::vector<std::vector<Point>> contour_lines(const std::vector<double>& values, std::size_t columns, double level) {
  return ContourTracer(values, columns, level).lines();
}

}  // namespace retrace::report
