#include "studies/rre/equivalent_directions.h"

#include <algorithm>

namespace retrace::studies {
namespace {

// Maximum difference of two unit vectors that count as one direction.
constexpr double kSameDirection = 1e-12;

}  // namespace

std::vector<Eigen::Matrix2d> reflections_of(const std::array<bool, 2>& mirrors) {
  std::vector<Eigen::Matrix2d> maps;
  for (const double x : {1.0, -1.0})
    for (const double y : {1.0, -1.0})
      if ((x > 0.0 || mirrors[0]) && (y > 0.0 || mirrors[1])) maps.emplace_back(Eigen::Vector2d(x, y).asDiagonal());
  return maps;
}

std::vector<EquivalentDirections> group_equivalent_directions(const std::vector<geometry::Vec3>& to_source,
                                                              const std::vector<Eigen::Matrix2d>& symmetries) {
  std::vector<EquivalentDirections> all;
  for (std::size_t k = 0; k < to_source.size(); ++k) {
    SharedDirection shared{k, Eigen::Matrix2d::Identity()};
    const auto known = std::find_if(all.begin(), all.end(), [&](const EquivalentDirections& group) {
      return std::any_of(symmetries.begin(), symmetries.end(), [&](const Eigen::Matrix2d& map) {
        shared.to_traced = map;
        return (shared.mapped(to_source[k]) - to_source[group.front().index]).norm() < kSameDirection;
      });
    });
    if (known != all.end())
      known->push_back(shared);
    else
      all.push_back({{k, Eigen::Matrix2d::Identity()}});
  }
  return all;
}

}  // namespace retrace::studies
