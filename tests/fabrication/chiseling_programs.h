#pragma once

// Helper functions for tests of micro chiseling: they read machine files, plan programs and verify programs.

#include <string>
#include <string_view>

#include "core/atomic_file.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/chiseling_jobs.h"
#include "tests/fabrication/controls.h"

namespace retrace::fabrication::test::chiseling {

inline Machine machine(const std::string& name = "ideal-dmc") {
  return parse_machine(read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml"), name);
}

/// Returns the machine `ideal-dmc` with position and angle errors. The directions of the rotary axes are wrong by some
/// arc minutes. Their positions are wrong by tenths of a millimetre along X and Y, and by several millimetres along Z.
inline Machine crooked_machine() {
  Machine m = machine();
  m.name = "crooked";
  m.a.direction.value = geometry::Vec3(0.0013, 1.0, -0.0021).normalized();
  m.a.point_mm.value = {0.2, -0.1, 90.0};
  m.c.direction.value = geometry::Vec3(-0.0008, 0.0011, 1.0).normalized();
  m.c.point_mm.value = {0.3, 0.15, -2.0};
  return m;
}

inline std::string text_of(const Job& job, const Machine& m, std::string_view dialect = "rs274ngc") {
  return nc_text(make_plan(job, for_dialect(m, dialect)).programs.front(), dialect);
}

inline Verification verified(const Job& job, const Machine& m, const std::string& text,
                             NcDialect dialect = NcDialect::rs274ngc) {
  return verify_programs(job, m, {parse_nc(text, "p.ngc", dialect, control_texts())}, {},
                         {machine("ideal"), machine("paper"), machine("thesis"), machine()});
}

}  // namespace retrace::fabrication::test::chiseling
