#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/controls.h"
#include "tests/fabrication/findings_text.h"
#include "tests/fabrication/jobs.h"
#include "tests/support/refusals.h"

// Tests, in every dialect, of programs on a control whose state is unknown at the start: an earlier program, a manual
// input or a reset may have changed it. The verifier must notice if any word of the preparation is missing. If a later
// line changes a state, the verifier must report this at the next cut.

namespace retrace::fabrication::test::control_state_test {
namespace {

using geometry::Arrangement;

using Lines = std::vector<std::string>;

/// Returns a machine whose control has all optional features.
Machine full_machine(NcDialect dialect) {
  const std::string file = std::string(RETRACE_SOURCE_DIR) + "/data/machines/paper.toml";
  Machine machine = parse_machine(read_file(file), file);
  machine.control.has_rotation = machine.control.has_mirror = true;
  return for_dialect(machine, kNcDialectWords[static_cast<std::size_t>(dialect)]);
}

class ControlState : public ::testing::TestWithParam<NcDialect> {
 protected:
  ControlState() : machine_(full_machine(GetParam())) {
    const Program program = make_plan(job_, machine_).programs.front();
    const std::string text = nc_text(program, kNcDialectWords[static_cast<std::size_t>(GetParam())]);
    std::size_t begin = 0;
    for (std::size_t end = text.find('\n'); end != std::string::npos; begin = end + 1, end = text.find('\n', begin))
      lines_.push_back(text.substr(begin, end - begin));
  }

  bool is_pmac() const { return GetParam() == NcDialect::pmac; }
  bool has_texts() const { return has_own_texts(GetParam()); }

  /// Returns the kinds of the findings, each kind one time. Returns "error" for a text that cannot be executed.
  std::string kinds_in(const Lines& lines) const {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    std::vector<std::string> kinds;
    try {
      for (const Finding& f :
           verify_programs(job_, machine_, {parse_nc(text, "p", GetParam(), control_texts())}, {}, {}).findings)
        kinds.push_back(f.kind);
    } catch (const InputError&) {
      return "error";
    }
    std::sort(kinds.begin(), kinds.end());
    kinds.erase(std::unique(kinds.begin(), kinds.end()), kinds.end());
    return fmt::format("{}", fmt::join(kinds, " "));
  }

  /// Returns the index of the first line of the main program that moves an axis.
  std::size_t first_move() const {
    const std::string rapid = is_pmac() ? "rapid " : "G0 ";
    std::size_t i = 0;
    while (!lines_[i].starts_with(rapid)) ++i;
    return i;
  }
  /// Returns true for lines before which other lines can be inserted. They are lines after the preparation, including
  /// lines of subroutines.
  bool is_step(std::size_t i) const {
    return lines_[i].starts_with(is_pmac() ? "rapid " : "G0 ") || is_feed(lines_[i]) || lines_[i] == dwell_line();
  }
  std::string dwell_line() const {
    switch (GetParam()) {
      case NcDialect::pmac: return "dwell 100";
      case NcDialect::sinumerik: return "G4 F0.100";
      case NcDialect::fanuc: return "G4 P100";
      case NcDialect::automation1: return "Dwell(0.100)";
      case NcDialect::rs274ngc:
      case NcDialect::a3200: break;
    }
    return "G4 P0.100";
  }
  std::string kinds_with(std::size_t at, const Lines& inserted) const {
    Lines lines = lines_;
    lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), inserted.begin(), inserted.end());
    return kinds_in(lines);
  }
  static bool holds(const std::string& kinds, const std::string& kind) {
    return (" " + kinds + " ").find(" " + kind + " ") != std::string::npos;
  }
  bool is_feed(const std::string& line) const { return line.starts_with(is_pmac() ? "linear " : "G1 "); }

  Job job_ = small_prism_job();
  Machine machine_;
  Lines lines_;
};

TEST_P(ControlState, RightProgramsPass) {
  EXPECT_EQ(kinds_in(lines_), "");
}

TEST_P(ControlState, EveryWordOfThePreparationIsAskedFor) {
  // Lines of the preparation that do not affect straight moves, such as the selection of a plane or the end of a cycle.
  const Lines without_effect = {"G17", "G80", "M5", "X0.", "Y0.", "Z0."};
  int asked = 0;
  // The preparation consists of all lines before the first move that are neither comments nor part of a subroutine.
  std::size_t begin = first_move();
  const auto is_prepared = [&](const std::string& line) {
    return line.starts_with("G") || line.starts_with("M5") || line.starts_with("T") || line.starts_with("Coord") ||
           line.starts_with("frax") || line.starts_with("ccmode") || line == "abs" || line.starts_with("WAIT") ||
           line.starts_with("SetupTask") || line.ends_with("Off()");
  };
  while (begin > 0 && is_prepared(lines_[begin - 1])) --begin;
  for (std::size_t i = begin; i < first_move(); ++i)
    for (std::size_t at = 0; at < lines_[i].size();) {
      const std::size_t end = std::min(lines_[i].find(' ', at), lines_[i].size());
      const std::string word = lines_[i].substr(at, end - at);
      Lines spoilt = lines_;
      spoilt[i].erase(at, end - at);
      const std::string kinds = kinds_in(spoilt);
      if (word == "M5") {
        EXPECT_EQ(kinds, "spindle");
      } else if (std::find(without_effect.begin(), without_effect.end(), word) == without_effect.end()) {
        EXPECT_TRUE(kinds.find("setup") != std::string::npos || kinds == "error") << word << ": " << kinds;
      }
      ++asked;
      at = end + 1;
    }
  EXPECT_GE(asked, 6);
}

TEST_P(ControlState, WhatChangesInTheMiddleIsFound) {
  using Changes = std::vector<std::pair<std::string, std::string>>;
  Changes changes = {{"M3 S3000", "spindle"}, {"M4 S3000", "spindle"}, {"G64", "blending"}, {"M9", "mist"}};
  if (is_pmac()) changes = {{"Coord[1].NoBlend=0", "blending"}, {"M3", "spindle"}};
  if (GetParam() == NcDialect::a3200)
    changes = {{"M3 S3000", "spindle"}, {"M4 S3000", "spindle"}, {"G108", "blending"}, {"VELOCITY ON", "blending"}};
  if (GetParam() == NcDialect::automation1) changes = {{"M3 S3000", "spindle"}, {"VelocityBlendingOn()", "blending"}};
  int tried = 0;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (!is_feed(lines_[i])) continue;
    for (const auto& [line, kind] : changes) {
      Lines spoilt = lines_;
      spoilt.insert(spoilt.begin() + static_cast<std::ptrdiff_t>(i), line);
      const std::string kinds = kinds_in(spoilt);
      // Feed moves at or above the clearance height cut nothing. A fault before such a move is reported at the next
      // cut.
      EXPECT_NE(kinds.find(kind), std::string::npos) << line << " before " << lines_[i] << ": " << kinds;
      ++tried;
    }
  }
  EXPECT_GE(tried, 10);
}

TEST_P(ControlState, MistThatNeverComesOn) {
  Lines spoilt = lines_;
  const std::string on = has_texts() ? machine_.control.mist_on : "M7";
  std::erase(spoilt, on);
  EXPECT_EQ(kinds_in(spoilt), "mist");
}

/// The first move must move only Z, away from the part. No other move may go lower before the positions of all axes are
/// known.
TEST_P(ControlState, TheFirstMoves) {
  const std::size_t first = first_move();
  const std::string feed = is_pmac() ? "linear Z-12. F2000." : "G1 Z-12. F2000.";
  const auto with = [&](std::size_t at, const std::string& line) {
    Lines spoilt = lines_;
    spoilt.insert(spoilt.begin() + static_cast<std::ptrdiff_t>(at), line);
    return kinds_in(spoilt);
  };
  EXPECT_NE(with(first, feed).find("first_move"), std::string::npos);
  EXPECT_NE(with(first + 1, feed).find("unknown_position"), std::string::npos);
  EXPECT_NE(with(first + 2, feed).find("unknown_position"), std::string::npos);
  Lines spoilt = lines_;
  spoilt.erase(spoilt.begin() + static_cast<std::ptrdiff_t>(first));
  EXPECT_NE(kinds_in(spoilt).find("first_move"), std::string::npos);
  // Exchange the move of X and Y with the downward move.
  spoilt = lines_;
  std::size_t across = first + 1;
  while (spoilt[across].find(" X") == std::string::npos) ++across;
  std::swap(spoilt[across], spoilt[across + 1]);
  EXPECT_NE(kinds_in(spoilt).find("unknown_position"), std::string::npos) << kinds_in(spoilt);
}

TEST_P(ControlState, FeedsAreThoseOfTheMachine) {
  int tried = 0;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const std::size_t feed = lines_[i].find(" F");
    if (!is_feed(lines_[i]) || feed == std::string::npos) continue;
    Lines spoilt = lines_;
    spoilt[i] = lines_[i].substr(0, feed) + " F50000.";
    EXPECT_NE(kinds_in(spoilt).find("feed_too_high"), std::string::npos) << lines_[i];
    ++tried;
  }
  EXPECT_GE(tried, 3);
}

/// Finishing cuts must have the finishing feed. The verifier recognises finishing cuts from the path of the edge, and
/// does not use comments or names in the program.
TEST_P(ControlState, FeedsAreThoseOfTheStage) {
  const double finishing = job_.process.finishing_feed_mm_per_min;
  const std::string feed = fmt::format(" F{:.3f}", finishing);
  int tried = 0;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const std::size_t at = lines_[i].find(feed);
    if (!is_feed(lines_[i]) || at == std::string::npos) continue;
    Lines spoilt = lines_;
    spoilt[i] = lines_[i].substr(0, at) + fmt::format(" F{:.3f}", job_.process.roughing_feed_mm_per_min);
    EXPECT_NE(kinds_in(spoilt).find("feed_too_high"), std::string::npos) << lines_[i];
    ++tried;
  }
  EXPECT_EQ(tried, 2);
}

TEST_P(ControlState, DwellsInTheMaterial) {
  const std::string dwell = dwell_line();
  const auto as_long_as = [&](const std::string& text, double factor) {
    const std::size_t digits = text.find_first_of("0123456789", 3);
    const std::size_t end = std::min(text.find_first_not_of("0123456789.", digits), text.size());
    const double value = factor * std::stod(text.substr(digits));
    return text.substr(0, digits) +
           (text.find('.') == std::string::npos ? fmt::format("{:.0f}", value) : fmt::format("{:.3f}", value)) +
           text.substr(end);
  };
  int tried = 0;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (lines_[i] != dwell) continue;
    Lines spoilt = lines_;
    spoilt[i] = as_long_as(dwell, 1000.0);
    EXPECT_EQ(kinds_in(spoilt), "dwell_too_long");
    spoilt[i] = as_long_as(dwell, 2.5);
    EXPECT_EQ(kinds_in(spoilt), "");
    spoilt[i] = as_long_as(dwell, 0.5);
    EXPECT_EQ(kinds_in(spoilt), "missing_dwell");
    // Dwells at one position are added up. A stop may take any time, because the operator resumes the program.
    spoilt.insert(spoilt.begin() + static_cast<std::ptrdiff_t>(i), spoilt[i]);
    EXPECT_EQ(kinds_in(spoilt), "");
    spoilt.insert(spoilt.begin() + static_cast<std::ptrdiff_t>(i), 5, spoilt[i]);
    EXPECT_EQ(kinds_in(spoilt), "dwell_too_long");
    const std::string stop = has_texts() ? machine_.control.optional_stop : "M0";
    // Lines of the machine file occur only in the main program, and cuts only in subprograms.
    for (const std::size_t at : {i, i + 1})
      EXPECT_TRUE(holds(kinds_with(at, {stop}), has_texts() ? "error" : "dwell_too_long"));
    ++tried;
  }
  EXPECT_GE(tried, 3);
  // A dwell above the part is harmless.
  Lines rests = lines_;
  rests.insert(rests.begin() + static_cast<std::ptrdiff_t>(first_move()) + 1, as_long_as(dwell, 1000.0));
  EXPECT_EQ(kinds_in(rests), "");
}

/// The spindle must never rotate a chisel, at any line of the program.
TEST_P(ControlState, TheSpindleNeverTurns) {
  if (is_pmac()) return;  // the machine codes of this control contain no spindle codes, so M3 is an error
  int tried = 0;
  for (std::size_t i = 0; i <= lines_.size(); ++i) {
    if (i < lines_.size() && !is_step(i)) continue;
    const std::size_t at = i < lines_.size() ? i : i - 2;  // line before the end of the program
    EXPECT_TRUE(holds(kinds_with(at, {"M3 S3000", "M5"}), "spindle")) << lines_[at];
    ++tried;
  }
  EXPECT_GE(tried, 20);
}

TEST_P(ControlState, MistStaysOnWhileTheToolIsInTheMaterial) {
  const std::string on = has_texts() ? machine_.control.mist_on : "M7";
  const std::string off = has_texts() ? machine_.control.mist_off : "M9";
  int tried = 0;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (lines_[i] != dwell_line()) continue;
    EXPECT_EQ(kinds_with(i, {off, dwell_line(), on}), has_texts() ? "error" : "mist");
    ++tried;
  }
  EXPECT_GE(tried, 3);
  if (has_texts()) return;
  Lines flooded = lines_;
  std::replace(flooded.begin(), flooded.end(), std::string("M7"), std::string("M8"));
  EXPECT_EQ(kinds_in(flooded), "mist");
}

TEST_P(ControlState, CutsAreNotTooSlow) {
  const std::string retract = fmt::format(" F{:.3f}", job_.process.retract_feed_mm_per_min);
  int tried = 0;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const std::size_t feed = lines_[i].find(" F");
    if (!is_feed(lines_[i]) || feed == std::string::npos || lines_[i].substr(feed) == retract) continue;
    Lines spoilt = lines_;
    spoilt[i] = lines_[i].substr(0, feed) + " F0.500";
    EXPECT_EQ(kinds_in(spoilt), "feed_too_low") << lines_[i];
    ++tried;
  }
  EXPECT_GE(tried, 3);
}

/// All moves must respect the limits of the axes, including moves of rotary axes and the first moves.
TEST_P(ControlState, FeedsOfEveryMove) {
  int tried = 0;
  for (std::size_t i = first_move(); i < lines_.size(); ++i) {
    if (!lines_[i].starts_with(is_pmac() ? "rapid " : "G0 ")) continue;
    Lines spoilt = lines_;
    spoilt[i] = (is_pmac() ? "linear " : "G1 ") + lines_[i].substr(lines_[i].find(' ') + 1);
    // Only lines before the first feed word have no feed.
    if (i == first_move()) {
      EXPECT_TRUE(holds(kinds_in(spoilt), "zero_feed")) << spoilt[i];
    }
    spoilt[i] += " F999999.";
    const std::string kinds = kinds_in(spoilt);
    EXPECT_TRUE(holds(kinds, "feed_too_high") || kinds == "error") << spoilt[i] << ": " << kinds;
    ++tried;
  }
  EXPECT_GE(tried, 10);
}

/// During rotations, the tool must be at least `rotary_clearance_mm` above the highest point of the blank.
TEST_P(ControlState, TurnsKeepTheirClearance) {
  Job asks_more = job_;
  asks_more.process.rotary_clearance_mm *= 2.0;
  std::string text;
  for (const std::string& line : lines_) text += line + "\n";
  const NcProgram program = parse_nc(text, "p", GetParam(), control_texts());
  int found = 0;
  for (const Finding& f : verify_programs(asks_more, machine_, {program}, {}, {}).findings) {
    EXPECT_EQ(f.kind, "rotation_too_low");
    ++found;
  }
  EXPECT_GE(found, 1);
}

/// A tilted edge leaves a strip at the root. The test ends one finishing plunge 20 nm (100 nm for Fanuc) too high. The
/// verifier must report that the strip at this root is higher than expected.
TEST_P(ControlState, RootsAreThoseOfTheirPlunge) {
  const std::string feed = fmt::format(" F{:.3f}", job_.process.finishing_feed_mm_per_min);
  int tried = 0;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const std::size_t z = lines_[i].find(" Z") + 2;
    const std::size_t at = lines_[i].find(feed);
    if (!is_feed(lines_[i]) || at == std::string::npos) continue;
    Lines spoilt = lines_;
    const int decimals = GetParam() == NcDialect::fanuc ? 4 : 6;
    const double by_mm = GetParam() == NcDialect::fanuc ? 1e-4 : 2e-5;
    const double end = std::stod(lines_[i].substr(z, at - z)) + by_mm;
    spoilt[i] = fmt::format("{}{:.{}f}{}", lines_[i].substr(0, z), end, decimals, lines_[i].substr(at));
    EXPECT_TRUE(holds(kinds_in(spoilt), "root_residual")) << spoilt[i] << ": " << kinds_in(spoilt);
    ++tried;
  }
  EXPECT_EQ(tried, 2);
}

TEST_P(ControlState, WhatControlsRefuse) {
  if (GetParam() == NcDialect::rs274ngc) {
    EXPECT_EQ(kinds_with(first_move(), {"(" + std::string(251, '-') + ")"}), "error") << "a line that is too long";
  }
  if (is_pmac()) {
    machine_.control.coordinate_system = 2;
    EXPECT_EQ(kinds_in(lines_), "setup");
  }
  if (GetParam() == NcDialect::sinumerik) {
    machine_.control.modulo_axes = "";
    EXPECT_EQ(kinds_in(lines_), "word") << "DC() of an axis that is none";
    machine_.control.modulo_axes = "AC";
    EXPECT_EQ(kinds_in(lines_), "") << "A stays within a turn";
    machine_.control.modulo_axes = "C";
    int tried = 0;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const std::size_t at = lines_[i].find("C=DC(");
      if (at == std::string::npos) continue;
      Lines spoilt = lines_;
      const double c_deg = std::stod(lines_[i].substr(at + 5));
      spoilt[i] = lines_[i].substr(0, at) + fmt::format("C{:.7f}", c_deg - 360.0);
      EXPECT_TRUE(holds(kinds_in(spoilt), "word")) << spoilt[i];
      ++tried;
    }
    EXPECT_GE(tried, 2);
  }
  if (GetParam() != NcDialect::fanuc) return;
  machine_.control.increment_system = IncrementSystem::d;
  EXPECT_EQ(kinds_in(lines_), "word") << "a decimal too many";
  machine_.control.increment_system = IncrementSystem::e;
  EXPECT_EQ(kinds_with(1, {"G90"}), "error") << "before the number of the program";
  machine_.control.has_rotation = false;
  EXPECT_EQ(kinds_in(lines_), "setup");
}

/// A coarse increment of the control rounds positions and displaces facets. The displacement must be at most the
/// tolerance, even where two facets meet.
TEST_P(ControlState, CoarseIncrementsLeaveWhatTheyRound) {
  if (GetParam() != NcDialect::fanuc) return;
  for (const IncrementSystem system : {IncrementSystem::d, IncrementSystem::c})
    for (const auto& [name, width_mm] :
         {std::pair<std::string, double>{"ideal", 0.451}, {"paper", 0.451}, {"thesis", 0.2}}) {
      const std::string file = std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml";
      Machine machine = parse_machine(read_file(file), file);
      machine.control.increment_system = system;
      machine = for_dialect(machine, "fanuc");
      Job job = square_job(3, Arrangement::offset);
      job.tool.width_mm = width_mm;
      const std::string text = nc_text(make_plan(job, machine).programs.front(), "fanuc");
      const Verification v = verify_programs(job, machine, {parse_nc(text, "p", NcDialect::fanuc)}, {}, {});
      EXPECT_TRUE(v.passes()) << name << " " << v.tolerance_nm << "\n" << listed(v);
    }
}

TEST_P(ControlState, IncrementsAreFinerThanCuts) {
  if (GetParam() != NcDialect::fanuc) return;
  Machine machine = machine_;
  machine.control.increment_system = IncrementSystem::b;
  EXPECT_EQ(refusal_of([&] { make_plan(job_, for_dialect(machine, "fanuc")); }), "process.finishing_depth_um");
}

/// A correct program passes even with a tolerance that is larger than the chip thickness. Such a tolerance does not
/// affect the check that chips are separated.
TEST_P(ControlState, WideTolerancesPassToo) {
  std::string text;
  for (const std::string& line : lines_) text += line + "\n";
  for (const double tolerance_nm : {1e3, 1e4, 1e6}) {
    VerifyOptions options;
    options.tolerance_nm = tolerance_nm;
    const Verification v =
        verify_programs(job_, machine_, {parse_nc(text, "p", GetParam(), control_texts())}, options, {});
    EXPECT_TRUE(v.passes()) << tolerance_nm << "\n" << listed(v);
  }
}

INSTANTIATE_TEST_SUITE_P(Dialects, ControlState,
                         ::testing::Values(NcDialect::rs274ngc, NcDialect::sinumerik, NcDialect::fanuc, NcDialect::pmac,
                                           NcDialect::a3200, NcDialect::automation1),
                         [](const auto& dialect) {
                           return std::string(kNcDialectWords[static_cast<std::size_t>(dialect.param)]);
                         });

}  // namespace
}  // namespace retrace::fabrication::test::control_state_test
