#include "fabrication/forces/io/force_table.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "core/atomic_file.h"
#include "core/data_directory.h"
#include "core/error.h"
#include "core/message_text.h"

namespace retrace::fabrication {
namespace {

constexpr std::string_view kHeader = "experiment,strategy,configuration,doc_um,width_mm,event,time_s,fx_n,fy_n,fz_n";
constexpr std::size_t kColumns = 10;

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

std::optional<double> number_of(std::string_view field, const InputLocation& where) {
  if (field.empty()) return std::nullopt;
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(value))
    throw InputError(where, "must be a number or empty, got " + in_quotes(field));
  return value;
}

double positive(std::string_view field, const InputLocation& where) {
  const std::optional<double> value = number_of(field, where);
  if (!value || !(*value > 0.0)) throw InputError(where, "must be a number > 0, got " + in_quotes(field));
  return *value;
}

MeasuredForce force_of(const std::vector<std::string_view>& f, const std::string& file, int line) {
  const auto where = [&](const char* key) { return InputLocation{file, line, key}; };
  MeasuredForce force;
  force.experiment = static_cast<int>(positive(f[0], where("experiment")));
  force.strategy = f[1];
  force.configuration = f[2];
  force.depth_of_cut_um = positive(f[3], where("doc_um"));
  force.width_mm = positive(f[4], where("width_mm"));
  force.event = f[5];
  force.time_s = number_of(f[6], where("time_s"));
  force.fx_n = number_of(f[7], where("fx_n"));
  force.fy_n = number_of(f[8], where("fy_n"));
  force.fz_n = number_of(f[9], where("fz_n"));
  return force;
}

}  // namespace

std::vector<MeasuredForce> parse_forces(std::string_view text, const std::string& source_name) {
  std::vector<MeasuredForce> forces;
  bool has_header = false;
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = text.find('\n');
    std::string_view row = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    if (row.ends_with('\r')) row.remove_suffix(1);
    if (row.empty() || row.front() == '#') continue;
    if (!has_header) {
      if (row != kHeader) throw InputError({source_name, line, ""}, fmt::format("must be the header {}", kHeader));
      has_header = true;
      continue;
    }
    const std::vector<std::string_view> fields = fields_of(row);
    if (fields.size() != kColumns)
      throw InputError({source_name, line, ""}, fmt::format("must have {} columns, got {}", kColumns, fields.size()));
    forces.push_back(force_of(fields, source_name, line));
  }
  if (forces.empty()) throw InputError({source_name, 0, ""}, "must hold forces, is empty");
  return forces;
}

std::vector<MeasuredForce> shipped_forces() {
  const auto file = data_directory() / "cutting_forces.csv";
  return parse_forces(read_file(file), file.string());
}

}  // namespace retrace::fabrication
