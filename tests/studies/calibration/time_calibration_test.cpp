#include "studies/calibration/time_calibration.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/error.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "studies/calibration/io/time_files.h"
#include "studies/calibration/time_programs.h"
#include "tests/support/refusals.h"

// Tests of the calibration of times. The accelerations and settling times of the real machine differ from the values in
// its machine file. The test computes the time of each move independently. From the times of programs, with noise, the
// calibration must determine the values of the real machine.

namespace retrace::studies::time_calibration_test {
namespace {

using namespace fabrication;

Machine nominal() {
  return load_machine("thesis", {});
}

/// The values of the real machine, which its file does not contain. X, Y and Z have equal values, and so do A and C.
struct Hidden {
  double settling_s = 0.0;
  double acceleration = 500.0;
  double ramp_s = 0.0;
  double rotary_acceleration = 50.0;
};

/// Returns the time of a move from rest to rest. The maximum speed is found by bisection.
double clock_s(double distance, double speed, double acceleration, double ramp_s) {
  const double jerk = acceleration / ramp_s;
  const auto speeding_s = [&](double v) {
    return v * jerk < acceleration * acceleration ? 2.0 * std::sqrt(v / jerk) : v / acceleration + ramp_s;
  };
  if (speed * speeding_s(speed) <= distance) return distance / speed + speeding_s(speed);
  double low = 0.0;
  double high = speed;
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (middle * speeding_s(middle) < distance ? low : high) = middle;
  }
  return 2.0 * speeding_s(low);
}

/// Returns the time of a program as the sum of the times of its moves.
double clock_s(const Program& program, const Hidden& hidden) {
  const Machine file = nominal();
  constexpr double kAlmostNoRampS = 1e-9;
  AxisWords before = {std::nullopt, std::nullopt, std::nullopt, 0, 0};
  double sum_s = 0.0;
  for_each_move(program, [&](const PlannedMove& planned) {
    double move_s = 0.0;
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      if (!planned.move.to[axis] || !before[axis] || *before[axis] == *planned.move.to[axis]) continue;
      const auto by = static_cast<double>(std::abs(*planned.move.to[axis] - *before[axis]));
      const bool is_linear = axis <= kZ;
      const double speed = !is_linear           ? file.c.speed_deg_per_s.value
                           : planned.is_rapid() ? file.x.rapid_mm_per_min.value / 60.0
                                                : planned.move.feed_mm_per_min / 60.0;
      const double one_s = is_linear
                               ? clock_s(by * 1e-6, speed, hidden.acceleration, std::max(hidden.ramp_s, kAlmostNoRampS))
                               : clock_s(by * 1e-7, speed, hidden.rotary_acceleration, kAlmostNoRampS);
      move_s = std::max(move_s, one_s);
    }
    if (move_s > 0.0) sum_s += move_s + hidden.settling_s;
    before = planned.at;
  });
  return sum_s;
}

struct Timed {
  std::vector<Program> programs = time_programs(nominal(), "rs274ngc");
  FileTexts texts;

  Timed() {
    for (const Program& program : programs) texts[program.name + ".ngc"] = nc_text(program, "rs274ngc");
  }
  std::string table(const Hidden& hidden, double noise_s, std::uint32_t seed, std::size_t rows = 4) const {
    std::mt19937 bits(seed);
    std::normal_distribution<double> normal(0.0, noise_s);
    std::string text = "program,seconds,uncertainty\n";
    for (std::size_t k = 0; k < rows; ++k)
      text += fmt::format("{}.ngc,{:.6f},{}\n", programs[k].name, clock_s(programs[k], hidden) + normal(bits), noise_s);
    return text;
  }
  TimeCalibration calibrate(const std::string& table) const {
    return calibrate_times(parse_times(table, "times.csv", nominal(), texts), nominal());
  }
};

const Timed& timed() {
  static const Timed programs;
  return programs;
}

/// Returns a random machine. Acceleration times ramp time is above 1 mm/s, the speed of short steps, because settling
/// times and ramps could otherwise not be distinguished. It is below half of the rapid speed of 33 mm/s, because ramps
/// and accelerations could otherwise not be distinguished.
Hidden drawn(std::uint32_t seed) {
  std::mt19937 bits(seed);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(bits); };
  return {between(0.005, 0.08), between(200.0, 800.0), between(0.01, 0.02), between(20.0, 150.0)};
}

std::array<double, kTimeQuantities> truth_of(const Hidden& hidden) {
  return {hidden.settling_s, hidden.acceleration / nominal().x.acceleration_mm_per_s2.value, hidden.ramp_s,
          hidden.rotary_acceleration / nominal().c.acceleration_deg_per_s2.value};
}

TEST(TimeCalibration, IntervalsHoldTheMachine) {
  constexpr int kMachines = 200;
  std::array<int, kTimeQuantities> held{};
  for (std::uint32_t seed = 1; seed <= kMachines; ++seed) {
    const Hidden hidden = drawn(seed);
    const TimeCalibration found = timed().calibrate(timed().table(hidden, 0.5, seed + 1000));
    for (std::size_t k = 0; k < kTimeQuantities; ++k) {
      EXPECT_TRUE(found.quantities[k].is_observable) << kTimeQuantityWords[k].key << " of machine " << seed;
      if (std::abs(found.quantities[k].value - truth_of(hidden)[k]) < 1.96 * found.quantities[k].uncertainty) ++held[k];
    }
  }
  for (std::size_t k = 0; k < kTimeQuantities; ++k) {
    EXPECT_GE(held[k], 180) << kTimeQuantityWords[k].key;
    EXPECT_LE(held[k], 198) << kTimeQuantityWords[k].key;
  }
}

TEST(TimeCalibration, FindsTheMachineExactlyWithoutNoise) {
  const Hidden hidden{0.031, 350.0, 0.025, 30.0};
  std::string table = timed().table(hidden, 1e-4, 1);
  const TimeCalibration found = timed().calibrate(table);
  EXPECT_NEAR(found.machine.settling_s.value, 0.031, 1e-5);
  EXPECT_NEAR(found.machine.y.acceleration_mm_per_s2.value, 350.0, 0.1);
  EXPECT_NEAR(found.machine.z.jerk_mm_per_s3.value, 14000.0, 20.0);
  EXPECT_NEAR(found.machine.a.acceleration_deg_per_s2.value, 30.0, 0.01);
  EXPECT_EQ(found.degrees_of_freedom, 0U);
  EXPECT_TRUE(found.warnings.empty());
}

TEST(TimeCalibration, WhatTheFileSaysStaysWhereItIsRight) {
  const TimeCalibration found = timed().calibrate(timed().table({}, 1e-3, 7));
  EXPECT_LT(found.machine.settling_s.value, 1e-5);
  EXPECT_NEAR(found.quantities[1].value, 1.0, 1e-3);
  EXPECT_NEAR(found.quantities[3].value, 1.0, 1e-3);
}

TEST(TimeCalibration, SaysWhatProgramsDoNotTell) {
  // The first table lacks the program that rotates axes. The second table contains only the program of short steps,
  // whose time depends on the sum of settling and ramps.
  const TimeCalibration without_turns = timed().calibrate(timed().table(drawn(3), 0.5, 3, 3));
  ASSERT_EQ(without_turns.unobservable.size(), 1U);
  EXPECT_EQ(without_turns.unobservable[0], "rotary_acceleration_factor");
  EXPECT_FALSE(without_turns.quantities[3].is_observable);
  EXPECT_EQ(without_turns.quantities[3].value, 1.0);
  EXPECT_EQ(without_turns.machine.a.acceleration_deg_per_s2.basis, Basis::assumed);
  const TimeCalibration steps_alone = timed().calibrate(timed().table(drawn(3), 0.5, 3, 1));
  EXPECT_EQ(steps_alone.unobservable.size(), 3U);
  EXPECT_FALSE(steps_alone.quantities[0].is_observable);
}

TEST(TimeCalibration, JerkAloneIsToldWhereAccelerationIsNeverReached) {
  // At half of the rapid speed, the acceleration is at most 31 mm/s / 0.06 s, which is less than 1000 mm/s2. The
  // acceleration limit is therefore never reached, and only the jerk has an effect.
  const Hidden hidden{0.02, 1000.0, 0.06, 30.0};
  const TimeCalibration found = timed().calibrate(timed().table(hidden, 0.5, 3));
  EXPECT_TRUE(found.quantities[0].is_observable);
  EXPECT_FALSE(found.quantities[1].is_observable);
  EXPECT_FALSE(found.quantities[2].is_observable);
  ASSERT_EQ(found.unobservable.size(), 1U);
  EXPECT_EQ(found.unobservable[0], "linear_acceleration_factor, linear_ramp_s");
  EXPECT_NEAR(found.machine.x.jerk_mm_per_s3.value, 1000.0 / 0.06, 300.0);
}

TEST(TimeCalibration, BlockTimesOfALogTellAsMuch) {
  // Every line of every program has its own time, as in a log. The lines of the set-up are left out.
  const Hidden hidden = drawn(11);
  std::string text = "program,from_line,to_line,seconds,uncertainty\n";
  for (const Program& program : timed().programs) {
    Program prefix = program;
    prefix.items.clear();
    double before_s = 0.0;
    int line = 10;  // first line after the preparation
    const std::string& written = timed().texts.at(program.name + ".ngc");
    line = static_cast<int>(
               std::count(written.begin(), written.begin() + static_cast<std::ptrdiff_t>(written.find("G0 Z")), '\n')) +
           1;
    for (std::size_t k = 0; k < 40; ++k, ++line) {
      prefix.items.push_back(program.items[k]);
      const double so_far_s = clock_s(prefix, hidden);
      if (k >= 3) text += fmt::format("{}.ngc,{},{},{:.9f},0.001\n", program.name, line, line, so_far_s - before_s);
      before_s = so_far_s;
    }
  }
  const TimeCalibration found = timed().calibrate(text);
  for (std::size_t k = 0; k < kTimeQuantities; ++k) {
    EXPECT_TRUE(found.quantities[k].is_observable);
    EXPECT_NEAR(found.quantities[k].value, truth_of(hidden)[k], 1e-3 * truth_of(hidden)[k]);
  }
  EXPECT_EQ(found.degrees_of_freedom, 4U * 37U - 4U);
}

TEST(TimeCalibration, NamesTheRowThatContradictsTheOthers) {
  std::string table = timed().table(drawn(5), 0.5, 5);
  table += timed().table(drawn(5), 0.5, 6).substr(table.find('\n') + 1);
  table += "times-ways.ngc,400,0.5\n";
  const TimeCalibration found = timed().calibrate(table);
  ASSERT_FALSE(found.warnings.empty());
  EXPECT_TRUE(std::any_of(found.warnings.begin(), found.warnings.end(),
                          [](const Warning& warning) { return warning.text.starts_with("line 10: "); }));
  EXPECT_GT(found.scatter, 10.0);
}

TEST(TimeCalibration, NamesATimeThatNoMachineTakes) {
  for (const char* seconds : {"1e-9", "1e7"}) {
    const TimeCalibration found =
        timed().calibrate(std::string("program,seconds,uncertainty\ntimes-ways.ngc,") + seconds + ",1\n");
    ASSERT_EQ(found.warnings.size(), 1U) << seconds;
    EXPECT_EQ(found.warnings[0].id, "outlier");
    EXPECT_TRUE(found.warnings[0].text.starts_with("line 2: "));
    EXPECT_NO_THROW(parse_machine(machine_text(found.machine), "machine.toml")) << "it can be read all the same";
  }
}

TEST(TimeCalibration, TheMachineFileReadsBack) {
  const TimeCalibration found = timed().calibrate(timed().table(drawn(9), 0.5, 9));
  const Machine read = parse_machine(machine_text(found.machine), "machine.toml");
  EXPECT_EQ(read.settling_s.value, found.machine.settling_s.value);
  EXPECT_EQ(read.settling_s.basis, Basis::measured);
  EXPECT_EQ(read.z.jerk_mm_per_s3.value, found.machine.z.jerk_mm_per_s3.value);
  EXPECT_TRUE(std::isinf(read.c.jerk_deg_per_s3.value));
}

TEST(TimePrograms, StayAboveAllAndWithinTravelInEveryDialect) {
  for (const Machine& machine : shipped_machines())
    for (const Dialect& dialect : dialects()) {
      for (const Program& program : time_programs(machine, dialect.name)) {
        SCOPED_TRACE(fmt::format("{} of {} in {}", program.name, machine.name, dialect.name));
        bool is_first = true;
        for_each_move(program, [&](const PlannedMove& planned) {
          if (is_first) {
            EXPECT_TRUE(planned.move.to[kZ] && !planned.move.to[kX] && !planned.move.to[kTilt]);
          }
          is_first = false;
          EXPECT_NEAR(millimetres(*planned.at[kZ]), machine.first_z_mm(), 1e-3);
          AxisPositions at;
          at.z_mm = millimetres(*planned.at[kZ]);
          if (planned.at[kX]) at.x_mm = millimetres(*planned.at[kX]);
          if (planned.at[kY]) at.y_mm = millimetres(*planned.at[kY]);
          (machine.tilt == Tilt::table ? at.a_deg : at.b_deg) = degrees(planned.at[kTilt].value_or(0));
          at.c_deg = degrees(planned.at[kC].value_or(0));
          EXPECT_TRUE(limit_excesses(machine, at).empty());
        });
        EXPECT_FALSE(nc_text(program, dialect.name).empty());
      }
    }
}

TEST(TimeTables, MovesThatSayTheirTimeTakeIt) {
  const FileTexts texts = {{"p.ngc", "%\nG21 G90 G94\nG0 Z50\nG0 X0 Y0\nG93\nG1 X1 F30\nG1 X1.5 F120\nM2\n%\n"}};
  const TimedPrograms read = parse_times(
      "program,from_line,to_line,seconds,uncertainty\np.ngc,6,7,1,1\np.ngc,6,6,1,1\n", "t.csv", nominal(), texts);
  EXPECT_DOUBLE_EQ(read.rows[0].predicted_s(nominal()), 2.5);
  EXPECT_DOUBLE_EQ(read.rows[1].predicted_s(nominal()), 2.0);
}

TEST(TimeTables, RefuseWhatIsWrongWithItsPlace) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      parse_times(text, "t.csv", nominal(), timed().texts);
    } catch (const InputError& error) {
      return recorded_place_of(error);
    }
    return "nothing";
  };
  const std::string head = "program,seconds,uncertainty,from_line,to_line\n";
  expect_refusals(message, {{"", "t.csv"},
                            {"program,seconds\n", "t.csv:1"},
                            {head, "t.csv"},
                            {head + "times-ways.ngc,,1,,\n", "t.csv"},
                            {head + ",1,1,,\n", "t.csv:2: program"},
                            {head + "\x05,1,1,,\n", "t.csv:2: program"},
                            {head + "no.ngc,1,1,,\n", "t.csv:2: program"},
                            {head + "times-ways.ngc,-1,1,,\n", "t.csv:2: seconds"},
                            {head + "times-ways.ngc,nan,1,,\n", "t.csv:2: seconds"},
                            {head + "times-ways.ngc,1,0,,\n", "t.csv:2: uncertainty"},
                            {head + "times-ways.ngc,1,1,2.5,\n", "t.csv:2: from_line"},
                            {head + "times-ways.ngc,1,1,9,8\n", "t.csv:2: to_line"},
                            {head + "times-ways.ngc,1,1,900,\n", "t.csv:2: from_line"},
                            {head + "times-ways.ngc,1,1,1,2\n", "t.csv:2"}});
}

}  // namespace
}  // namespace retrace::studies::time_calibration_test
