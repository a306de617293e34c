#include "fabrication/turning/plan/turning_program.h"

#include <algorithm>
#include <cmath>

namespace retrace::fabrication::turning {
namespace {

Words words_of(const PathPoint& p) {
  return {nanometres(p.x_mm), nanometres(p.y_mm), nanometres(p.z_mm), std::nullopt, rotary_units(p.c_deg)};
}

/// All points but the first, where the tool is. Y and C have words where they change.
Path path_of(const Pass& pass, Words at, double blend_mm) {
  Path path;
  path.blend_mm = blend_mm;
  path.moves.reserve(pass.size() - 1);
  for (std::size_t k = 1; k < pass.size(); ++k) {
    const Words to = words_of(pass[k]);
    Move& move = path.moves.emplace_back(Move{Motion::plough, to, 0.0, pass[k].seconds});
    for (const Axis axis : {kY, kC})
      if (to[axis] == at[axis]) move.to[axis].reset();
    at = to;
  }
  return path;
}

}  // namespace

Program turning_program(const std::vector<Pass>& passes, const PathOptions& options, const std::string& name,
                        const std::vector<std::string>& header) {
  Program program;
  program.name = name;
  program.header = header;
  double highest = -1e300;
  for (const Pass& pass : passes)
    for (const PathPoint& p : pass) highest = std::max(highest, p.z_mm);
  Move raise;
  raise.to[kZ] = nanometres(highest + options.clear_mm);
  for (const Pass& pass : passes) {
    const Words at = words_of(pass.front());
    Move over{Motion::rapid, at, 0.0, 0.0};
    Move down{Motion::translate, {}, options.approach_mm_per_min, 0.0};
    std::swap(over.to[kZ], down.to[kZ]);
    program.items.insert(program.items.end(), {raise, over, down, path_of(pass, at, options.blend_mm)});
  }
  program.items.emplace_back(raise);
  return program;
}

}  // namespace retrace::fabrication::turning
