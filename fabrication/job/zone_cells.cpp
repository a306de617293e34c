#include "fabrication/job/zone_cells.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>

#include "core/angle.h"
#include "core/number_format.h"
#include "geometry/elements/element_cells.h"
#include "geometry/polygon.h"

namespace retrace::fabrication {
namespace {

using geometry::Polygon;
using geometry::Vec2;
using geometry::Vec3;

/// Returns the rank of each value, from 0 for the smallest value. Consecutive values have the same rank if they differ
/// by at most `same`.
std::vector<std::int32_t> ranks_of(const std::vector<double>& values, double same) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<std::int32_t> ranks(values.size(), 0);
  std::int32_t rank = 0;
  for (std::size_t k = 1; k < order.size(); ++k) {
    rank += values[order[k]] - values[order[k - 1]] > same ? 1 : 0;
    ranks[order[k]] = rank;
  }
  return ranks;
}

Eigen::Matrix3d turn_of(const CutZone& zone) {
  return Eigen::AngleAxisd(Angle::from_deg(zone.rotation_deg).rad(), Vec3::UnitZ()).toRotationMatrix();
}

/// Returns the outline of an element of the zone, relative to its apex, in the part frame.
Polygon outline_of(const Job& job, std::size_t zone) {
  const Eigen::Matrix2d turn = turn_of(job.zones[zone]).topLeftCorner<2, 2>();
  Polygon outline = geometry::element_cell(blank_element(job, zone)).outline;
  for (Vec2& p : outline) p = turn * p / blank_scale(job.workpiece);
  return outline;
}

std::string place_text(const Vec2& apex) {
  return fmt::format("the element at x = {}, y = {} mm", shortest(apex.x()), shortest(apex.y()));
}

/// Spatial index of the elements of a zone. The apexes are stored in squares that are as wide as an element.
class PlacedZone {
 public:
  explicit PlacedZone(Polygon round_apex)
      : round_apex_(std::move(round_apex)), radius_mm_(round_apex_.front().norm()), width_mm_(2.0 * radius_mm_) {}

  double radius_mm() const { return radius_mm_; }
  Polygon outline_at(const Vec2& apex) const { return geometry::moved(round_apex_, apex); }
  void add(const Vec2& apex) { squares_[square_of(apex)].push_back(apex); }
  /// Returns the apex of an element that overlaps an outline, or null.
  /// \param radius_mm radius of the circle about `apex` that contains the outline
  /// \param near_mm tolerance for an overlap
  const Vec2* overlapped_by(const Polygon& outline, const Vec2& apex, double radius_mm, double near_mm) const {
    const double reach_mm = radius_mm + radius_mm_;
    const auto [left, low] = square_of(apex - Vec2(reach_mm, reach_mm));
    const auto [right, high] = square_of(apex + Vec2(reach_mm, reach_mm));
    for (auto square = squares_.lower_bound({left, low}); square != squares_.end() && square->first.first <= right;) {
      const auto [column, row] = square->first;
      if (row < low || row > high) {
        square = squares_.lower_bound({row < low ? column : column + 1, low});
        continue;
      }
      for (const Vec2& other : square->second) {
        if ((other - apex).norm() >= reach_mm) continue;
        const Polygon both = geometry::clip(outline, outline_at(other), near_mm);
        if (!both.empty() && geometry::area(both) > near_mm * std::min(radius_mm, radius_mm_)) return &other;
      }
      ++square;
    }
    return nullptr;
  }

 private:
  using Square = std::pair<std::int64_t, std::int64_t>;
  Square square_of(const Vec2& p) const {
    return {static_cast<std::int64_t>(std::floor(p.x() / width_mm_)),
            static_cast<std::int64_t>(std::floor(p.y() / width_mm_))};
  }

  Polygon round_apex_;
  double radius_mm_;
  double width_mm_;
  std::map<Square, std::vector<Vec2>> squares_;
};

}  // namespace

std::vector<CutElement> elements_of_zones(const Job& job) {
  const double scale = blank_scale(job.workpiece);
  const Vec2 middle_mm = 0.5 * Vec2(job.array.x_length_mm, job.array.y_length_mm);
  std::vector<CutElement> elements;
  for (std::size_t z = 0; z < job.zones.size(); ++z) {
    const CutZone& zone = job.zones[z];
    const Eigen::Matrix3d turn = turn_of(zone);
    std::vector<double> along_x;
    std::vector<double> along_y;
    for (const Vec2& apex : zone.apexes_mm) {
      CutElement& element = elements.emplace_back();
      const Vec2 from_middle = apex - middle_mm;
      element.centre_mm = scale * Vec2(from_middle.y(), -from_middle.x());
      element.workpiece_from_element = turn;
      element.zone = z;
      element.orientation = static_cast<std::int32_t>(z);
      const Vec2 back = turn.topLeftCorner<2, 2>().transpose() * from_middle;
      along_x.push_back(back.x());
      along_y.push_back(back.y());
    }
    constexpr double kSameShare = 1e-3;
    const double same_mm = kSameShare * outline_of(job, z).front().norm();
    const std::vector<std::int32_t> columns = ranks_of(along_x, same_mm);
    const std::vector<std::int32_t> rows = ranks_of(along_y, same_mm);
    const std::size_t first = elements.size() - zone.apexes_mm.size();
    for (std::size_t k = 0; k < zone.apexes_mm.size(); ++k) {
      elements[first + k].column = columns[k];
      elements[first + k].row = rows[k];
    }
  }
  return elements;
}

std::optional<ZoneError> first_zone_error(const Job& job) {
  const geometry::Rectangle part{Vec2::Zero(), {job.array.x_length_mm, job.array.y_length_mm}};
  // Tolerance for rounded positions in files, relative to the radius of an element.
  constexpr double kSameShare = 2e-5;
  std::vector<PlacedZone> placed;
  for (std::size_t z = 0; z < job.zones.size(); ++z) {
    placed.emplace_back(outline_of(job, z));
    const double radius_mm = placed.back().radius_mm();
    for (const Vec2& apex : job.zones[z].apexes_mm) {
      const Polygon outline = placed.back().outline_at(apex);
      if (!geometry::contains(part, outline, kSameShare * radius_mm))
        return ZoneError{
            z, place_text(apex) + " extends beyond the array, whose size is given by x_length_mm and y_length_mm"};
      for (std::size_t other = 0; other <= z; ++other) {
        const double near_mm = kSameShare * std::min(radius_mm, placed[other].radius_mm());
        if (const Vec2* const met = placed[other].overlapped_by(outline, apex, radius_mm, near_mm))
          return ZoneError{z, fmt::format("{} overlaps the element at x = {}, y = {} mm of zone {}", place_text(apex),
                                          shortest(met->x()), shortest(met->y()), other + 1)};
      }
      placed.back().add(apex);
    }
  }
  return std::nullopt;
}

}  // namespace retrace::fabrication
