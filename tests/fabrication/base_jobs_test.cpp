#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "fabrication/job/base_cells.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/plan/plan.h"
#include "fabrication/post/post.h"
#include "fabrication/verify/verify.h"
#include "geometry/base_part.h"
#include "geometry/lattice.h"
#include "geometry/part.h"
#include "tests/fabrication/base_jobs.h"

// Jobs of elements on inclined, curved and freeform bases: where they stand, against the part that light is traced in;
// their programs, read back and cut again; and faults that are planted in them.

namespace retrace::fabrication::test {
namespace {

using geometry::Arrangement;
using geometry::Vec2;
using geometry::Vec3;

Machine machine(const std::string& name) {
  return parse_machine(read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml"), name);
}
Machine machine_of(const Job& job) {
  return machine(job.strategy == Strategy::dmc ? "ideal-dmc" : "ideal");
}

std::string text_of(const Job& job, std::string_view dialect = "rs274ngc") {
  return nc_text(make_plan(job, machine_of(job)).programs.front(), dialect);
}

Verification verified(const Job& job, const std::string& text, NcDialect dialect = NcDialect::rs274ngc) {
  return verify_programs(job, machine_of(job), {parse_nc(text, "p", dialect)}, {}, {});
}

std::string listed(const Verification& v) {
  std::string text;
  for (const Finding& f : v.findings)
    text += fmt::format("{}:{} {} [{}] {} ({} > {}) x{}\n", f.program, f.line, f.kind, f.element, f.message, f.value,
                        f.limit, f.count);
  return text.substr(0, 2000);
}

std::string kinds_of(const Verification& v) {
  std::set<std::string> kinds;
  for (const Finding& finding : v.findings) kinds.insert(finding.kind);
  return fmt::format("{}", fmt::join(kinds, " "));
}

struct Named {
  std::string what;
  Job job;
};

/// Bases of every kind that prisms can be cut into, and cube corners.
std::vector<Named> jobs() {
  const Standing normal = Standing::normal;
  const Standing parallel = Standing::parallel;
  std::vector<Named> all = {
      {"prisms along an incline", prisms_on(plane_base(12.0, 0.0, normal))},
      {"prisms along an incline the other way", prisms_on(plane_base(7.0, 180.0, normal))},
      {"prisms along a bulging cylinder", prisms_on(cylinder_base(6.0, false, normal))},
      {"prisms along a hollow cylinder", prisms_on(cylinder_base(-6.0, false, normal))},
      {"prisms along a formula across the roofs", prisms_on(formula_base("0.05*x^2 - 0.01*x^3", normal))},
      {"prisms in parallel on an incline", prisms_on(plane_base(8.0, 30.0, parallel))},
      {"prisms in parallel on a cylinder along the roofs", prisms_on(cylinder_base(9.0, true, parallel))},
      {"bricks in parallel on a sphere", prisms_on(sphere_base(12.0, parallel), 3, Arrangement::offset)},
      {"checker in parallel in a bowl", prisms_on(sphere_base(-12.0, parallel), 3, Arrangement::checker)},
      {"prisms in parallel on a formula", prisms_on(formula_base("0.03*sin(3*x)*cos(2*y)", parallel))},
  };
  for (const bool is_hexagonal : {false, true}) {
    const std::string kind = is_hexagonal ? "hexagons " : "triangles ";
    all.push_back({kind + "along an incline", cubes_on(plane_base(6.0, 40.0, normal), is_hexagonal)});
    all.push_back({kind + "along a cylinder", cubes_on(cylinder_base(3.0, false, normal), is_hexagonal)});
    all.push_back({kind + "in parallel on a cylinder", cubes_on(cylinder_base(-3.0, true, parallel), is_hexagonal)});
    all.push_back({kind + "along a sphere", cubes_on(sphere_base(-4.0, normal), is_hexagonal)});
    all.push_back({kind + "in parallel on a formula", cubes_on(formula_base("0.1*x + 0.1*x*y", parallel), is_hexagonal)});
  }
  return all;
}

TEST(OnBase, Explore) {
  for (const Named& named : jobs()) {
    try {
      const Plan plan = make_plan(named.job, machine_of(named.job));
      const std::string text = nc_text(plan.programs.front(), "rs274ngc");
      const Verification v = verified(named.job, text);
      fmt::print("{}: {} elements, stock {} um, {} poses, facets {} nm {} arcmin root {} walls {} volume {} findings {} text {}\n{}",
                 named.what, v.elements_cut, 1e3 * plan.stock_mm, plan.poses.size(), v.facet_distance_nm_max, v.facet_angle_arcmin_max,
                 v.root_residual_nm_max, v.wall_overcut_nm_max, v.removed_volume_mm3, v.findings.size(), text.size(), listed(v));
    } catch (const InputError& e) {
      fmt::print("{}: {}\n", named.what, e.what()); (void)kinds_of; (void)text_of;
    }
  }
}

}  // namespace
}  // namespace retrace::fabrication::test
