#include "studies/calibration/io/time_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/named_file.h"
#include "core/number_format.h"
#include "fabrication/check/io/program_files.h"

namespace retrace::studies {
namespace {

namespace fs = std::filesystem;
using namespace fabrication;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxTimesBytes = std::size_t{1} << 22;
constexpr std::size_t kMaxRows = 100000;
constexpr std::size_t kMaxPrograms = 100;
constexpr NumberRange kSeconds{.low = 0.0, .low_included = false, .high = 1e8};
constexpr NumberRange kLine{.low = 1.0, .high = 1e9};

/// Moves and dwells of a program for each line of its main part. Equal moves are stored one time.
class Timeline final : public NcSink {
 public:
  explicit Timeline(const NcProgram& program) : program_(program) {
    const NcEnd end = run_nc(program, *this);
    if (!end.is_complete) throw InputError({program.file, end.line, ""}, "the program is incomplete: " + end.reason);
  }

  void motion(const NcMotion& motion, const NcSettings&) override {
    if (motion.moved == 0) return;
    const auto [known, is_new] = kinds_.try_emplace(key_of(motion), motions_.size());
    if (is_new) motions_.push_back(motion);
    moves_.push_back({main_line(motion.location), known->second});
  }
  void dwell(double seconds, const NcLocation& place, const AxisPositions&) override {
    dwells_.emplace_back(main_line(place), seconds);
  }

  void add(TimedMoves& row, int from_line, int to_line) const {
    std::map<std::size_t, std::int64_t> counts;
    for (const auto& [line, kind] : of_lines(moves_, from_line, to_line)) ++counts[kind];
    for (const auto& [kind, count] : counts) row.moves.push_back({motions_[kind], count});
    for (const auto& [line, seconds] : of_lines(dwells_, from_line, to_line)) row.dwell_s += seconds;
  }

  int lines() const { return program_.lines; }

 private:
  /// Key of equal moves, with all values that determine the time of a move: travels in nanometres and 1e-7 degrees,
  /// feed or time, and kind of move.
  using Key = std::array<std::int64_t, kNcAxes + 4>;

  /// Returns the events of a range of lines. The events are sorted, because main programs have no jumps.
  template <class Event>
  static std::span<const Event> of_lines(const std::vector<Event>& events, int from_line, int to_line) {
    const auto first = std::ranges::lower_bound(events, from_line, {}, &Event::first);
    return {first, std::ranges::upper_bound(first, events.end(), to_line, {}, &Event::first)};
  }

  static int main_line(const NcLocation& place) { return place.call_line > 0 ? place.call_line : place.line; }

  static Key key_of(const NcMotion& motion) {
    constexpr double kUnits[] = {1e6, 1e7};
    const auto travel = [](double from, double to, double units) { return std::llround((to - from) * units); };
    const AxisPositions& a = motion.from;
    const AxisPositions& b = motion.to;
    return {travel(a.x_mm, b.x_mm, kUnits[0]),
            travel(a.y_mm, b.y_mm, kUnits[0]),
            travel(a.z_mm, b.z_mm, kUnits[0]),
            travel(a.a_deg, b.a_deg, kUnits[1]),
            travel(a.c_deg, b.c_deg, kUnits[1]),
            travel(a.b_deg, b.b_deg, kUnits[1]),
            motion.known,
            std::bit_cast<std::int64_t>(motion.feed_mm_per_min),
            std::bit_cast<std::int64_t>(motion.duration_s),
            (motion.move == NcMove::rapid ? 1 : 0) + (motion.is_exact_stop ? 2 : 0)};
  }

  const NcProgram& program_;
  std::map<Key, std::size_t> kinds_;
  std::vector<NcMotion> motions_;
  std::vector<std::pair<int, std::size_t>> moves_;  ///< line, and index of the kind of move
  std::vector<std::pair<int, double>> dwells_;
};

/// Indices of the columns.
struct TimeColumns {
  std::size_t program, seconds, uncertainty;
  std::optional<std::size_t> from_line, to_line;

  explicit TimeColumns(const CsvReader& table)
      : program(needed(table, "program")),
        seconds(needed(table, "seconds")),
        uncertainty(needed(table, "uncertainty")),
        from_line(table.find("from_line")),
        to_line(table.find("to_line")) {}

 private:
  static std::size_t needed(const CsvReader& table, std::string_view column) {
    if (const auto found = table.find(column)) return *found;
    table.fail(fmt::format("the table must have the columns program, seconds and uncertainty: {} is missing", column));
  }
};

class TimeReader {
 public:
  TimeReader(std::string_view text, const fs::path& file, const Machine& machine, const FileTexts& texts)
      : table_(text, file.string(), kMaxTimesBytes),
        columns_(table_),
        folder_(file.parent_path()),
        machine_(machine),
        texts_(texts) {
    result_.file = file.string();
  }

  TimedPrograms read() {
    while (table_.next()) {
      if (table_.rows() > kMaxRows) table_.fail(fmt::format("at most {} rows are allowed", kMaxRows));
      add_row();
    }
    if (result_.rows.empty()) table_.fail("the table must contain at least one row with a time");
    return std::move(result_);
  }

 private:
  void add_row() {
    TimedMoves row;
    row.line = table_.line();
    row.program = table_[columns_.program];
    row.uncertainty_s = table_.number(columns_.uncertainty, kSeconds);
    const Timeline& timeline = timeline_of(row.program);
    const int from = line_or(columns_.from_line, 1);
    const int to = line_or(columns_.to_line, std::numeric_limits<int>::max());
    if (from > to) table_.fail(*columns_.to_line, fmt::format("must be at least from_line ({}), got {}", from, to));
    if (from > timeline.lines())
      table_.fail(*columns_.from_line,
                  fmt::format("must be the number of a line of {}, which has {} lines", row.program, timeline.lines()));
    if (table_[columns_.seconds].empty()) {
      ++result_.empty_rows;
      return;
    }
    row.seconds = table_.number(columns_.seconds, kSeconds);
    timeline.add(row, from, to);
    if (row.moves.empty()) table_.fail("the range of lines must include a line that moves an axis");
    result_.rows.push_back(std::move(row));
  }

  int line_or(const std::optional<std::size_t>& column, int otherwise) const {
    if (!column || table_[*column].empty()) return otherwise;
    const double value = table_.number(*column, kLine);
    if (value != std::floor(value))
      table_.fail(*column, fmt::format("must be a whole number, got {}", printable(table_[*column])));
    return static_cast<int>(value);
  }

  const Timeline& timeline_of(const std::string& name) {
    if (name.empty()) table_.fail(columns_.program, "must be the name of a program");
    if (printable(name, name.size()) != name)
      table_.fail(columns_.program, "must be the name of a program, got " + in_quotes(name));
    if (const auto known = timelines_.find(name); known != timelines_.end()) return known->second.timeline;
    if (timelines_.size() == kMaxPrograms) table_.fail(fmt::format("at most {} programs are allowed", kMaxPrograms));
    auto program = std::make_unique<NcProgram>(read_named({result_.file, table_.line(), "program"}, [&] {
      return std::move(read_programs({(folder_ / name).string()}, "auto", texts_of(machine_.control), texts_).front());
    }));
    const NcProgram& read = *program;
    return timelines_.try_emplace(name, std::move(program), read).first->second.timeline;
  }

  /// Program with its moves and dwells.
  struct Known {
    std::unique_ptr<NcProgram> program;
    Timeline timeline;
    Known(std::unique_ptr<NcProgram> read, const NcProgram& of) : program(std::move(read)), timeline(of) {}
  };

  CsvReader table_;
  TimeColumns columns_;
  fs::path folder_;
  const Machine& machine_;
  const FileTexts& texts_;
  std::map<std::string, Known> timelines_;
  TimedPrograms result_;
};

}  // namespace

TimedPrograms parse_times(std::string_view text, const fs::path& file, const Machine& machine, const FileTexts& texts) {
  return TimeReader(text, file, machine, texts).read();
}

TimedPrograms read_times(const fs::path& file, const Machine& machine) {
  return parse_times(read_file(file, kMaxTimesBytes), file, machine);
}

std::string time_calibration_json(const TimeCalibration& result) {
  Json json;
  json["times"] = result.programs.file;
  json["machine"] = result.machine.name;
  json["used"] = result.programs.rows.size();
  json["empty"] = result.programs.empty_rows;
  json["degrees_of_freedom"] = result.degrees_of_freedom;
  json["scatter"] = result.scatter;
  json["quantities"] = Json::array();
  for (std::size_t k = 0; k < kTimeQuantities; ++k)
    json["quantities"].push_back({{"quantity", kTimeQuantityWords[k].key},
                                  {"description", kTimeQuantityWords[k].description},
                                  {"observable", result.quantities[k].is_observable},
                                  {"value", result.quantities[k].value},
                                  {"uncertainty", result.quantities[k].uncertainty}});
  json["unobservable"] = result.unobservable;
  json["rows"] = Json::array();
  for (std::size_t k = 0; k < result.programs.rows.size(); ++k) {
    const TimedMoves& row = result.programs.rows[k];
    json["rows"].push_back({{"line", row.line},
                            {"program", row.program},
                            {"measured_s", row.seconds},
                            {"before_s", row.predicted_s(result.nominal)},
                            {"after_s", row.predicted_s(result.machine)},
                            {"residual", result.residuals[k]}});
  }
  return result_text("retrace.time_calibration/2", std::move(json), result.warnings);
}

std::string time_calibration_table(const TimeCalibration& result) {
  std::string text = fmt::format("{} on machine {}: {} times\n", printable(result.programs.file, std::string::npos),
                                 printable(result.machine.name), result.programs.rows.size());
  for (std::size_t k = 0; k < kTimeQuantities; ++k) {
    const CalibratedTime& found = result.quantities[k];
    text += fmt::format("  {:<50} {}\n", kTimeQuantityWords[k].description,
                        found.is_observable
                            ? fmt::format("{:>10} +- {}", fixed(found.value, 4), fixed(found.uncertainty, 4))
                            : "unobservable");
  }
  for (const std::string& keys : result.unobservable)
    text += fmt::format("  {}: {}\n", keys.find(',') == std::string::npos ? "unobservable" : "not separable", keys);
  constexpr std::size_t kMaxShownRows = 20;
  for (std::size_t k = 0; k < std::min(result.programs.rows.size(), kMaxShownRows); ++k) {
    const TimedMoves& row = result.programs.rows[k];
    text += fmt::format("  line {:<4} {:<28} measured {} s; computed {} s before and {} s after the calibration\n",
                        row.line, row.program, fixed(row.seconds, 2), fixed(row.predicted_s(result.nominal), 2),
                        fixed(row.predicted_s(result.machine), 2));
  }
  if (result.programs.rows.size() > kMaxShownRows)
    text += fmt::format("  and {} more rows\n", result.programs.rows.size() - kMaxShownRows);
  if (result.degrees_of_freedom > 0)
    text += fmt::format("  scatter of residuals {} times their uncertainties, {} degrees of freedom\n",
                        fixed(result.scatter, 2), result.degrees_of_freedom);
  return text;
}

std::string times_csv(const std::vector<std::string>& programs) {
  constexpr double kByHandS = 0.5;
  CsvWriter table("program,seconds,uncertainty");
  for (const std::string& program : programs) table.row(program, std::optional<double>(), kByHandS);
  return table.text();
}

std::string time_programs_json(const Machine& machine, const std::vector<std::string>& programs) {
  Json json;
  json["machine"] = machine.name;
  json["programs"] = programs;
  return result_text("retrace.time_programs/1", std::move(json), {});
}

}  // namespace retrace::studies
