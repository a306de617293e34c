#include "fabrication/turning/plan/turning_program.h"

#include <algorithm>
#include <utility>

namespace retrace::fabrication::turning {
namespace {

AxisWords words_of(const PathPoint& p) {
  return {nanometres(p.x_mm), nanometres(p.y_mm), nanometres(p.z_mm), std::nullopt, rotary_units(p.c_deg)};
}

/// Returns the moves to all points except the first one, where the tool already is. Y and C have positions only if they
/// change.
Path path_of(const Pass& pass, AxisWords at, double blend_mm) {
  Path path;
  path.blend_mm = blend_mm;
  path.moves.reserve(pass.size() - 1);
  for (std::size_t k = 1; k < pass.size(); ++k) {
    const AxisWords to = words_of(pass[k]);
    Move& move = path.moves.emplace_back(Move{Motion::plough, to, 0.0, pass[k].seconds});
    for (const Axis axis : {kY, kC})
      if (to[axis] == at[axis]) move.to[axis].reset();
    at = to;
  }
  return path;
}

/// Returns the cubic moves to all points except the first one. All axes have positions, except Y if it does not move.
Path path_of(const CubicPath& cubics, bool has_y) {
  Path path;
  for (auto point = cubics.points.begin() + 1; point != cubics.points.end(); ++point) {
    Move& move = path.moves.emplace_back(Move{Motion::plough, words_of(point->point), 0.0, point->point.seconds});
    if (!has_y) move.to[kY].reset();
    path.end_velocities.push_back(point->velocities);
  }
  return path;
}

/// Builds programs of cuts. Before each cut, the tool moves above its start at the clearance height, and then down.
class ProgramMaker {
 public:
  ProgramMaker(const PathOptions& options, double highest_mm) : options_(options) {
    raise_.to[kZ] = nanometres(highest_mm + options.clearance_mm);
  }

  void add(const PathPoint& start, Path path) {
    Move over{Motion::rapid, words_of(start), 0.0, 0.0};
    Move down{Motion::translate, {}, options_.approach_mm_per_min, 0.0};
    std::swap(over.to[kZ], down.to[kZ]);
    items_.insert(items_.end(), {raise_, over, down, std::move(path)});
  }

  Program take(const std::string& name, const std::vector<std::string>& header) {
    Program program;
    program.name = name;
    program.header = header;
    program.items = std::move(items_);
    program.items.emplace_back(raise_);
    return program;
  }

 private:
  const PathOptions& options_;
  Move raise_;
  std::vector<Item> items_;
};

}  // namespace

Program turning_program(const std::vector<Pass>& passes, const PathOptions& options, const std::string& name,
                        const std::vector<std::string>& header) {
  double highest_mm = -1e300;
  for (const Pass& pass : passes)
    for (const PathPoint& p : pass) highest_mm = std::max(highest_mm, p.z_mm);
  ProgramMaker maker(options, highest_mm);
  for (const Pass& pass : passes) maker.add(pass.front(), path_of(pass, words_of(pass.front()), options.blend_mm));
  return maker.take(name, header);
}

Program turning_program(const CubicPath& cubics, const PathOptions& options, const std::string& name,
                        const std::vector<std::string>& header) {
  double highest_mm = -1e300;
  bool has_y = false;
  for (const CubicPoint& point : cubics.points) {
    highest_mm = std::max(highest_mm, point.highest_mm);
    has_y = has_y || point.point.y_mm != 0.0;
  }
  ProgramMaker maker(options, highest_mm);
  maker.add(cubics.points.front().point, path_of(cubics, has_y));
  return maker.take(name, header);
}

}  // namespace retrace::fabrication::turning
