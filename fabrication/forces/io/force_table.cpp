#include "fabrication/forces/io/force_table.h"

#include <array>

#include "core/atomic_file.h"
#include "core/csv.h"
#include "core/data_directory.h"

namespace retrace::fabrication {
namespace {

constexpr std::array<std::string_view, 10> kColumns = {"experiment", "strategy", "configuration", "doc_um", "width_mm",
                                                       "event",      "time_s",   "fx_n",          "fy_n",   "fz_n"};
constexpr NumberRange kAboveZero{.low = 0.0, .low_included = false};

MeasuredForce force_of(const CsvReader& row) {
  MeasuredForce force;
  force.experiment = static_cast<int>(row.number(0, kAboveZero));
  force.strategy = row[1];
  force.configuration = row[2];
  force.depth_of_cut_um = row.number(3, kAboveZero);
  force.width_mm = row.number(4, kAboveZero);
  force.event = row[5];
  force.time_s = row.number_or_none(6);
  force.fx_n = row.number_or_none(7);
  force.fy_n = row.number_or_none(8);
  force.fz_n = row.number_or_none(9);
  return force;
}

}  // namespace

std::vector<MeasuredForce> parse_forces(std::string_view text, const std::string& source_name) {
  std::vector<MeasuredForce> forces;
  CsvReader table(text, source_name, kMaxTextBytes, kColumns);
  while (table.next()) forces.push_back(force_of(table));
  if (forces.empty()) table.fail("the file must contain forces, but is empty");
  return forces;
}

std::vector<MeasuredForce> shipped_forces() {
  const auto file = data_directory() / "cutting_forces.csv";
  return parse_forces(read_file(file), file.string());
}

}  // namespace retrace::fabrication
