#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "fabrication/check/program_time.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/chisel/plan/move_time.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/chiseling_jobs.h"
#include "tests/fabrication/controls.h"
#include "tests/fabrication/findings_text.h"
#include "tests/fabrication/jobs.h"
#include "tests/fabrication/mutants.h"
#include "tests/fabrication/nc_record.h"
#include "tests/fabrication/substrate_jobs.h"

// Tests of feeds and times. The verifier must give equal results for feeds per minute, inverse-time feeds and inches.
// The planned time must agree with the time of the program text and with closed forms.

namespace retrace::fabrication::test::rates_test {
namespace {

using geometry::Arrangement;

Machine shipped(const std::string& name) {
  const std::string file = std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml";
  return parse_machine(read_file(file), file);
}

std::string dialect_word(NcDialect dialect) {
  return std::string(kNcDialectWords[static_cast<std::size_t>(dialect)]);
}

std::string text_of(const Job& job, const Machine& machine, NcDialect dialect) {
  return nc_text(make_plan(job, for_dialect(machine, dialect_word(dialect))).programs.front(), dialect_word(dialect));
}

Verification verified(const Job& job, const Machine& machine, const std::string& text, NcDialect dialect) {
  return verify_programs(job, machine, {parse_nc(text, "p", dialect, control_texts())}, {}, {});
}

/// Returns the program with changed words in all G0 and G1 blocks.
/// \param change function that returns the new word from the letter and the number of the old word
std::string with_words(const std::string& text, const std::function<std::string(char, double)>& change) {
  std::vector<std::string> lines = lines_of_text(text);
  for (std::string& line : lines) {
    if (!line.starts_with("G0 ") && !line.starts_with("G1 ")) continue;
    std::string changed = line.substr(0, 2);
    for (std::size_t at = 3; at < line.size();) {
      const std::size_t end = std::min(line.find(' ', at), line.size());
      char* rest = nullptr;
      const double value = std::strtod(line.c_str() + at + 1, &rest);
      const bool is_plain = rest == line.c_str() + end;
      changed += " " + (is_plain ? change(line[at], value) : line.substr(at, end - at));
      at = end + 1;
    }
    line = changed;
  }
  return text_of_lines(lines);
}

/// Returns the program with inverse-time feeds (G93) instead of feeds per minute.
/// \param factor factor on all speeds
std::string by_inverse_times(const std::string& text, double factor = 1.0) {
  double length = 0.0;
  std::vector<std::string> lines = lines_of_text(text);
  for (std::string& line : lines) {
    length = 0.0;
    line = with_words(line + "\n", [&](char letter, double value) {
      if (letter == 'F') return fmt::format("F{:.6f}", factor * value / length);
      length = std::hypot(length, value);
      return fmt::format("{}{:.{}f}", letter, value, letter < 'D' ? 7 : 6);
    });
    line.pop_back();
  }
  const auto is_rapid = [](const std::string& line) { return line.starts_with("G0 "); };
  lines.insert(std::find_if(lines.begin(), lines.end(), is_rapid), "G93");
  return text_of_lines(lines);
}

TEST(Rates, InverseTimesAreFeedsOverLengths) {
  const Machine machine = shipped("ideal");
  for (const NcDialect dialect : {NcDialect::rs274ngc, NcDialect::sinumerik}) {
    const std::string text = text_of(small_prism_job(), machine, dialect);
    Machine prompt = machine;
    for (LinearAxis* axis : {&prompt.x, &prompt.y, &prompt.z}) axis->acceleration_mm_per_s2.value = 1e9;
    const Verification by_feed = verified(small_prism_job(), prompt, text, dialect);
    const Verification v = verified(small_prism_job(), machine, by_inverse_times(text), dialect);
    EXPECT_TRUE(v.passes()) << dialect_word(dialect) << "\n" << listed(v);
    EXPECT_NEAR(v.time.feed_s / by_feed.time.feed_s, 1.0, 1e-5) << "without ramps";
    const Verification fast = verified(small_prism_job(), machine, by_inverse_times(text, 1.002), dialect);
    EXPECT_NE(listed(fast).find("feed_too_high"), std::string::npos) << listed(fast);
  }
}

/// The checks of feed limits tolerate the rounding of printed numbers. They must report a feed that exceeds its limit
/// by 0.2 %.
TEST(Rates, ProgramsInInchesPass) {
  const Machine machine = shipped("ideal");
  const auto in_inches = [](const std::string& text, int decimals, int decimals_of_feeds, double factor) {
    std::string inches = with_words(text, [&](char letter, double value) {
      if (letter == 'F') return fmt::format("F{:.{}f}", factor * value / 25.4, decimals_of_feeds);
      return letter < 'X' ? fmt::format("{}{:.7f}", letter, value)
                          : fmt::format("{}{:.{}f}", letter, value / 25.4, decimals);
    });
    return inches.replace(inches.find("G21"), 3, "G20");
  };
  const std::string text = text_of(small_prism_job(), machine, NcDialect::rs274ngc);
  for (const int decimals : {7, 8})
    for (const int decimals_of_feeds : {3, 4, 5, 6, 8}) {
      const Verification v =
          verified(small_prism_job(), machine, in_inches(text, decimals, decimals_of_feeds, 1.0), NcDialect::rs274ngc);
      EXPECT_TRUE(v.passes()) << decimals << " " << decimals_of_feeds << "\n" << listed(v);
    }
  const Verification fast = verified(small_prism_job(), machine, in_inches(text, 8, 6, 1.002), NcDialect::rs274ngc);
  EXPECT_NE(listed(fast).find("feed_too_high"), std::string::npos) << listed(fast);
  // The verifier treats a feed without decimals as exact. It must therefore report a feed that is 0.4 mm/min too high.
  Job slower = small_prism_job();
  slower.process.roughing_feed_mm_per_min -= 0.4;
  const std::string whole = with_words(
      text, [](char letter, double value) { return fmt::format("{}{:.{}f}", letter, value, letter == 'F' ? 0 : 6); });
  const Verification v = verified(slower, machine, whole, NcDialect::rs274ngc);
  EXPECT_NE(listed(v).find("feed_too_high"), std::string::npos) << listed(v);
}

double trapezoid_s(double distance, double speed, double acceleration) {
  if (distance == 0.0) return 0.0;
  return distance * acceleration > speed * speed ? distance / speed + speed / acceleration
                                                 : 2.0 * std::sqrt(distance / acceleration);
}

/// If only rotary axes move, the feed is in degrees per minute along their common path.
TEST(Rates, FeedsOfRotaryAxesAreDegrees) {
  Machine machine = shipped("ideal");
  machine.settling_s.value = 0.0;
  machine.a.acceleration_deg_per_s2.value = 40.0;
  machine.c.acceleration_deg_per_s2.value = 30.0;
  const auto seconds = [&](const std::string& line) {
    ProgramTime time;
    const Record record = record_of("G21 G90 G94\nG0 Z5\nG0 A45 C90\n" + line + "\nM2\n", NcDialect::rs274ngc);
    time.add(machine, record.motions.back());
    return time;
  };
  const double path_deg = std::hypot(45.0, 90.0);
  const double acceleration = std::min(40.0 * path_deg / 45.0, 30.0 * path_deg / 90.0);
  EXPECT_NEAR(seconds("G1 A0 C0 F90").feed_s, trapezoid_s(path_deg, 1.5, acceleration), 1e-9);
  EXPECT_NEAR(seconds("G1 C0 F30").feed_s, trapezoid_s(90.0, 0.5, 30.0), 1e-9);
  EXPECT_EQ(seconds("G1 C0 F30").rotary_s, 0.0);
  EXPECT_NEAR(seconds("G93 G1 A0 C0 F2").feed_s, 30.0, 1e-9);
  EXPECT_EQ(
      record_of("G90\nG0 Z5\nG0 C90\nG93 G1 C0 F2\nM2\n", NcDialect::rs274ngc).motions.back().path_speed_per_min(),
      180.0);
  // The time of a simultaneous move is the time of its slowest axis.
  EXPECT_NEAR(seconds("G0 Z5.5 C0").total_s(), seconds("G0 C0").total_s(), 1e-9);
}

/// Returns the time, in s, of a simultaneous move of several axes from rest to rest. At any time, all axes have
/// travelled the same fraction of their distance. The time is integrated over small steps of this fraction. In each
/// step, the speed is limited by the maximum speed of each axis, by its acceleration since the start and by its
/// deceleration before the end.
/// \param axes travel, maximum speed and maximum acceleration of each axis
double integrated_s(const std::vector<std::array<double, 3>>& axes) {
  constexpr int kSteps = 4000;
  double seconds = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const double done = (k + 0.5) / kSteps;
    double rate = std::numeric_limits<double>::infinity();
    for (const auto& [travel, speed, acceleration] : axes) {
      const double to_go = std::abs(travel) * std::min(done, 1.0 - done);
      rate = std::min(rate, std::min(speed, std::sqrt(2.0 * acceleration * to_go)) / std::abs(travel));
    }
    seconds += 1.0 / (kSteps * rate);
  }
  return seconds;
}

/// The times of rapid moves of linear and rotary axes agree with numerically integrated times. If rapid moves are
/// straight, all axes move together along a line. Otherwise the slowest axis determines the time. Planner and verifier
/// agree.
TEST(Rates, RapidMovesOfAllAxesAreIntegrated) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  double largest_excess = 0.0;
  for (int tried = 0; tried < 60; ++tried) {
    Machine machine = shipped("ideal");
    machine.settling_s.value = 0.0;
    for (LinearAxis* axis : {&machine.x, &machine.y, &machine.z}) {
      axis->rapid_mm_per_min.value = between(300.0, 5000.0);
      axis->acceleration_mm_per_s2.value = between(10.0, 1000.0);
    }
    for (RotaryAxis* axis : {&machine.a, &machine.c}) {
      axis->speed_deg_per_s.value = between(1.0, 40.0);
      axis->acceleration_deg_per_s2.value = between(1.0, 100.0);
    }
    const bool is_linear = tried % 3 != 0;
    const geometry::Vec3 by_mm =
        is_linear ? geometry::Vec3(between(-20, 20), between(-20, 20), between(1, 20)) : geometry::Vec3::Zero();
    const double a_deg = tried % 3 == 1 ? 0.0 : between(1.0, 90.0);
    const double c_deg = between(-180.0, -1.0);
    std::vector<std::array<double, 3>> axes;
    const LinearAxis* const linear[] = {&machine.x, &machine.y, &machine.z};
    for (Eigen::Index k = 0; k < 3; ++k)
      axes.push_back({by_mm[k], linear[k]->rapid_mm_per_min.value / 60.0, linear[k]->acceleration_mm_per_s2.value});
    axes.push_back({a_deg, machine.a.speed_deg_per_s.value, machine.a.acceleration_deg_per_s2.value});
    axes.push_back({c_deg, machine.c.speed_deg_per_s.value, machine.c.acceleration_deg_per_s2.value});
    std::erase_if(axes, [](const std::array<double, 3>& axis) { return axis[0] == 0.0; });
    double slowest_s = 0.0;
    for (const auto& axis : axes) slowest_s = std::max(slowest_s, integrated_s({axis}));
    const double along_s = integrated_s(axes);
    largest_excess = std::max(largest_excess, along_s / slowest_s - 1.0);
    NcMotion motion;
    motion.move = NcMove::rapid;
    motion.known = 0xff;
    motion.to = {by_mm.x(), by_mm.y(), by_mm.z(), a_deg, c_deg, 0.0};
    for (const bool is_straight : {false, true}) {
      machine.control.rapids_are_straight = is_straight;
      const double expected_s = is_straight ? along_s : slowest_s;
      ProgramTime time;
      time.add(machine, motion);
      EXPECT_NEAR(time.total_s() / expected_s, 1.0, 0.01) << tried << ' ' << is_straight;
      if (!is_linear) {
        EXPECT_NEAR(rotary_move_s(machine, a_deg, c_deg), time.total_s(), 1e-12);
      }
    }
  }
  EXPECT_GT(largest_excess, 0.1) << "the two rules differ";
}

/// Adds up the times of the moves of a program in two ways: by closed forms and by ProgramTime.
class TimeSink : public NcSink {
 public:
  explicit TimeSink(const Machine& machine) : machine_(machine) {}

  void motion(const NcMotion& motion, const NcSettings&) override {
    NcMotion from_known = motion;
    from_known.known = known_;
    time.add(machine_, from_known);
    const auto is_known = [&](std::size_t axis) { return (known_ >> axis & 1U) != 0; };
    const double by[] = {is_known(0) ? motion.to.x_mm - motion.from.x_mm : 0.0,
                         is_known(1) ? motion.to.y_mm - motion.from.y_mm : 0.0,
                         is_known(2) ? motion.to.z_mm - motion.from.z_mm : 0.0};
    double length = std::hypot(by[0], by[1], by[2]);
    const LinearAxis* const axes[] = {&machine_.x, &machine_.y, &machine_.z};
    double slowest_s = 0.0;
    double speed = motion.feed_mm_per_min > 0.0 ? motion.feed_mm_per_min / 60.0 : 1e9;
    double acceleration = 1e9;
    for (std::size_t k = 0; k < 3; ++k) {
      if (by[k] == 0.0) continue;
      const double share = std::abs(by[k]) / length;
      const double rapid = axes[k]->rapid_mm_per_min.value / 60.0;
      slowest_s = std::max(slowest_s, trapezoid_s(std::abs(by[k]), rapid, axes[k]->acceleration_mm_per_s2.value));
      if (motion.move == NcMove::rapid) speed = std::min(speed, rapid / share);
      acceleration = std::min(acceleration, axes[k]->acceleration_mm_per_s2.value / share);
    }
    const double tilt_deg = motion.to.a_deg + motion.to.b_deg - motion.from.a_deg - motion.from.b_deg;
    double c_deg = motion.to.c_deg - motion.from.c_deg;
    if (!machine_.shortest_axes.empty()) c_deg = std::remainder(c_deg, 360.0);
    if (length == 0.0) length = std::hypot(tilt_deg, c_deg);
    for (const auto& [axis, by_deg] : {std::pair{&machine_.a, tilt_deg}, {&machine_.c, c_deg}}) {
      if (by_deg == 0.0) continue;
      const double share = std::abs(by_deg) / length;
      const double axis_acceleration = axis->acceleration_deg_per_s2.value;
      slowest_s = std::max(slowest_s, trapezoid_s(std::abs(by_deg), axis->speed_deg_per_s.value, axis_acceleration));
      speed = std::min(speed, axis->speed_deg_per_s.value / share);
      acceleration = std::min(acceleration, axis_acceleration / share);
    }
    const bool is_line = motion.move == NcMove::linear || machine_.control.rapids_are_straight;
    const double moving_s = is_line ? trapezoid_s(length, speed, acceleration) : slowest_s;
    if (moving_s > 0.0) moves_s += moving_s + machine_.settling_s.value;
    known_ = static_cast<std::uint8_t>(known_ | motion.absolute | motion.shortest);
  }
  void dwell(double seconds, const NcLocation&, const AxisPositions&) override {
    time.dwell_s += seconds;
    moves_s += seconds;
  }
  void stop(NcStop kind, const NcSettings&, const NcLocation&) override {
    if (kind == NcStop::always) known_ = 0;
  }

  ProgramTime time;
  double moves_s = 0.0;

 private:
  const Machine& machine_;
  std::uint8_t known_ = 0;
};

Job zoned_job() {
  Job job = cube_job(true, 0.3);
  job.array.pattern.clear();
  job.array.x_length_mm = 3.0;
  job.array.y_length_mm = 1.5;
  job.zones.resize(3);
  job.zones[0].apexes_mm = {{0.2, 0.2}, {0.2, 0.5}};
  job.zones[1].apexes_mm = {{1.2, 0.4}};
  job.zones[1].rotation_deg = 33.0;
  job.zones[2].apexes_mm = {{2.4, 1.0}, {2.7, 1.0}};
  job.zones[2].rotation_deg = 180.0;
  return job;
}

TEST(Rates, PlannedTimesAreThoseOfTheMoves) {
  std::mt19937 random(4);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<std::pair<Job, std::string>> cases = {{zoned_job(), "ideal-dmc"}, {cube_job(false), "ideal-dmc"}};
  for (const auto strategy : {Strategy::unidirectional, Strategy::bidirectional, Strategy::two_step}) {
    Job job = square_job(3, strategy == Strategy::two_step ? Arrangement::checker : Arrangement::offset);
    job.strategy = strategy;
    job.tool.width_mm = 0.3;
    job.process.roughing_depth_um = 60.0;
    cases.emplace_back(job, "paper");
  }
  for (const auto& [job, name] : cases)
    for (std::size_t d = 0; d < std::size(kNcDialectWords); ++d) {
      const auto dialect = static_cast<NcDialect>(d);
      Machine machine = for_dialect(shipped(name), dialect_word(dialect));
      for (LinearAxis* axis : {&machine.x, &machine.y, &machine.z}) {
        axis->rapid_mm_per_min.value = between(500.0, 5000.0);
        axis->acceleration_mm_per_s2.value = between(100.0, 2000.0);
      }
      machine.c.speed_deg_per_s.value = between(1.0, 20.0);
      machine.a.acceleration_deg_per_s2.value = between(20.0, 100.0);
      machine.c.acceleration_deg_per_s2.value = between(1.0, 20.0);
      machine.settling_s.value = between(0.0, 0.1);
      machine.control.rapids_are_straight = d % 2 == 0;
      const Plan plan = make_plan(job, machine);
      TimeSink sink(machine);
      run_nc(parse_nc(nc_text(plan.programs.front(), dialect_word(dialect)), "p", dialect, control_texts()), sink);
      EXPECT_NEAR(plan.program_times_s.front() / sink.moves_s, 1.0, 1e-4) << name << " " << dialect_word(dialect);
      EXPECT_NEAR(sink.time.total_s() / sink.moves_s, 1.0, 1e-9) << name << " " << dialect_word(dialect);
    }
}

}  // namespace
}  // namespace retrace::fabrication::test::rates_test
