#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "fabrication/read/nc_motion.h"
#include "fabrication/read/nc_program.h"
#include "tests/fabrication/controls.h"
#include "tests/fabrication/nc_record.h"
#include "tests/support/refusals.h"

namespace retrace::fabrication::nc_reader_test {
namespace {

using test::Record;
using test::record_of;

constexpr NcDialect kAll[] = {NcDialect::rs274ngc, NcDialect::sinumerik, NcDialect::fanuc,
                              NcDialect::pmac,     NcDialect::a3200,     NcDialect::automation1};

std::string word_of(NcDialect dialect) {
  return std::string(kNcDialectWords[static_cast<std::size_t>(dialect)]);
}

/// Returns a program in the given dialect, written by hand according to the manual of the control. All dialects give
/// the same moves. The program rotates the table, approaches the part, and calls a subroutine at two positions. The
/// subroutine plunges, dwells, ploughs and retracts.
std::string sample(NcDialect dialect) {
  switch (dialect) {
    case NcDialect::rs274ngc:
      return "%\n(a sample)\no101 sub\nG91\nG1 F50. Z-0.25\nG4 P0.100\nG1 Y-0.1\nG1 F200. Z0.35\nG90\no101 endsub\n"
             "G17 G21 G40 G49 G54 G61 G80 G90 G94\nM5\nM7\nG0 Z5.\nG0 A45. C-0.1192463\n(MSG, half way)\n"
             "G0 X1.5 Y-2.25\nG0 Z0.2\no101 call\nN10 G0 X 1.7 Z1.0 ; remark\nG0 Y0.\ng0 z.2\nO101 CALL\nM9\nM2\n%\n";
    case NcDialect::sinumerik:
      return "; a sample\nG17 G40 G54 G60 G90 G94 G710\nD0\nTRAFOOF\nM5\nM7\nG0 Z5.\nG0 A45. C=-0.1192463\n"
             "MSG(\"half way; 50 percent\")\nG0 X1.5 Y-2.25\nG0 Z0.2\nCALL BLOCK RT101 TO RE101\nN10 G0 X=1.7 Z1.0 ; "
             "x\n"
             "G0 Y0.\ng0 z.2\nCALL BLOCK RT101 TO RE101\nM9\nM30\n"
             "RT101:\nG91\nG1 F50. Z-0.25\nG4 F0.100\nG1 Y-0.1\nG1 F200. Z0.35\nRE101: G90\n";
    case NcDialect::fanuc:
      return "%\nO0001 (a sample)\nG17 G21 G40 G49 G54 G61 G80 G90 G94\nM5\nM7\nG0 Z5.\nG0 A45. C-0.1192463\n(half "
             "way)\n"
             "G0 X1.5 Y-2.25\nG0 Z0.2\nM98 P0101\nN10 G0 X1.7 Z1.0\nG0 Y0.\nG0 Z.2\nM98 P0101\nM9\nM30\n"
             "O0101\nG91\nG1 F50. Z-0.25\nG4 P100\nG1 Y-0.1\nG1 F200. Z0.35\nG90\nM99\n%\n";
    case NcDialect::pmac:
      return "// a sample\nopen subprog 101\ninc\nlinear F50. Z-0.25\ndwell 100\nlinear Y-0.1\nlinear F200. "
             "Z0.35\nabs\nclose\n"
             "open prog 1\nCoord[1].NoBlend=1\nCoord[1].FeedTime=60000\nfrax(X,Y,Z)\nabs\nM5\nM7\nrapid Z5.\n"
             "rapid A45. C-0.1192463\n// half way\nrapid X1.5 Y-2.25\nrapid Z0.2\ncall 101\nrapid X1.7 Z1.0\nrapid "
             "Y0.\n"
             "rapid Z.2\ncall 101\nM9\nclose\n";
    case NcDialect::a3200:
      return "' a sample\nPROGRAM\nMETRIC ; mm\nMINUTES\nABSOLUTE\nG94 G40 G149\nVELOCITY OFF\nWAIT MODE INPOS\nM5\n"
             "M107\nRAPID Z5.\nG0 A45. C-0.1192463 // remark\n'half way\nrapid X 1.5 Y-2.25\nG0 Z0.2\nCALL plunge\n"
             "N10 G0 X1.7 Z1.0\ng0y0.\nG0 Z.2\nCALL PLUNGE\nEND PROGRAM\n"
             "DFS PLUNGE\nG91\nLINEAR F50. Z-0.25\nDWELL 0.1\nG1 Y-0.1\nG1 F200. Z0.35\nG90\nENDDFS\n";
    case NcDialect::automation1:
      return "// a sample\nprogram\n  SetupTaskDistanceUnits(DistanceUnits.Primary)\n  SetupTaskTimeUnits( "
             "TimeUnits.Minutes )\n  g90 G94 G40 G149 G109\n  CornerRoundingOff()\n  "
             "SetupTaskWaitMode(WaitMode.InPosition)\n  M5\n  M107\n  MoveRapid(Z, 5.)\n  G0 A45. C-0.1192463\n"
             "  G0 X 1.5 Y-2.25 // half way\n  MoveRapid([Z], [0.2])\n  Plunge()\n  N10 G0 X1.7 Z1.0\n  G0 Y0.\n  "
             "G0 Z.2\n  Plunge()\nend\n"
             "function Plunge()\n  SetupTaskTargetMode(TargetMode.Incremental)\n  SetupCoordinatedSpeed(50.)\n  "
             "MoveLinear([Z], [-0.25])\n  Dwell(0.1)\n  G1 Y-0.1\n  G1 F200. Z0.35\n  G90\nend\n";
  }
  return {};
}

struct Expected {
  NcMove move;
  std::array<double, 5> to;
  double feed;
};

TEST(NcReader, OneProgramInEveryLanguage) {
  using enum NcMove;
  const double c = -0.1192463;
  const std::vector<Expected> expected = {{rapid, {0, 0, 5, 0, 0}, 0},
                                          {rapid, {0, 0, 5, 45, c}, 0},
                                          {rapid, {1.5, -2.25, 5, 45, c}, 0},
                                          {rapid, {1.5, -2.25, 0.2, 45, c}, 0},
                                          {linear, {1.5, -2.25, -0.05, 45, c}, 50},
                                          {linear, {1.5, -2.35, -0.05, 45, c}, 50},
                                          {linear, {1.5, -2.35, 0.3, 45, c}, 200},
                                          {rapid, {1.7, -2.35, 1, 45, c}, 0},
                                          {rapid, {1.7, 0, 1, 45, c}, 0},
                                          {rapid, {1.7, 0, 0.2, 45, c}, 0},
                                          {linear, {1.7, 0, -0.05, 45, c}, 50},
                                          {linear, {1.7, -0.1, -0.05, 45, c}, 50},
                                          {linear, {1.7, -0.1, 0.3, 45, c}, 200}};
  for (const NcDialect dialect : kAll) {
    const Record record = record_of(sample(dialect), dialect, test::control_texts());
    EXPECT_TRUE(record.end.is_complete) << word_of(dialect) << ": " << record.end.reason;
    ASSERT_EQ(record.motions.size(), expected.size()) << word_of(dialect);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const NcMotion& m = record.motions[i];
      EXPECT_EQ(m.move, expected[i].move) << word_of(dialect) << " " << i;
      EXPECT_EQ(m.feed_mm_per_min, expected[i].feed) << word_of(dialect) << " " << i;
      const std::array<double, 5> to = {m.to.x_mm, m.to.y_mm, m.to.z_mm, m.to.a_deg, m.to.c_deg};
      for (std::size_t axis = 0; axis < 5; ++axis)
        EXPECT_NEAR(to[axis], expected[i].to[axis], 1e-12) << word_of(dialect) << i;
    }
    ASSERT_EQ(record.dwells.size(), 2U) << word_of(dialect);
    EXPECT_DOUBLE_EQ(record.dwells[1].seconds, 0.1) << word_of(dialect);
    EXPECT_EQ(record.settings.exact_stop, true) << word_of(dialect);
    EXPECT_EQ(record.settings.spindle, NcSpindle::stopped) << word_of(dialect);
    EXPECT_EQ(record.settings.mist_on, true) << word_of(dialect);
    EXPECT_EQ(recognise_dialect(sample(dialect), "p"), dialect);
  }
}

TEST(NcReader, MovesKnowTheirLineAndTheCallThatLedThere) {
  const Record record = record_of(sample(NcDialect::rs274ngc), NcDialect::rs274ngc);
  EXPECT_EQ(record.motions[4].location.line, 5);
  EXPECT_EQ(record.motions[4].location.call_line, 19);
  EXPECT_EQ(record.motions[10].location.call_line, 23);
  EXPECT_EQ(record.motions[0].location.line, 14);
  EXPECT_EQ(record.motions[0].location.call_line, 0);
}

/// One move of a random program.
struct Step {
  bool is_absolute = true;
  NcMove move = NcMove::rapid;
  std::size_t axis = 0;
  long long micro = 0;  ///< distance in 1e-6 mm, or angle in 1e-7 degrees
};

std::string number_of(const Step& step) {
  const int digits = step.axis < 3 ? 6 : 7;
  const long long scale = step.axis < 3 ? 1000000 : 10000000;
  return fmt::format("{}{}.{:0{}}", step.micro < 0 ? "-" : "", std::abs(step.micro) / scale,
                     std::abs(step.micro) % scale, digits);
}

std::string text_of(const std::vector<Step>& steps, NcDialect dialect) {
  const bool is_pmac = dialect == NcDialect::pmac;
  std::string text = dialect == NcDialect::rs274ngc      ? "%\n"
                     : dialect == NcDialect::fanuc       ? "%\nO1\n"
                     : is_pmac                           ? "open prog 1\n"
                     : dialect == NcDialect::automation1 ? "program\n"
                                                         : "";
  text += is_pmac ? "linear F10 abs X0. Y0. Z0. A0. C0.\n" : "G1 F10 G90 X0. Y0. Z0. A0. C0.\n";
  for (const Step& s : steps) {
    const bool rapid = s.move == NcMove::rapid;
    text += is_pmac ? fmt::format("{} {} ", s.is_absolute ? "abs" : "inc", rapid ? "rapid" : "linear")
                    : fmt::format("G{} G{} ", s.is_absolute ? 90 : 91, rapid ? 0 : 1);
    text += fmt::format("{}{}\n", kNcAxisLetters[s.axis], number_of(s));
  }
  if (dialect == NcDialect::rs274ngc) text += "M2\n%\n";
  if (dialect == NcDialect::sinumerik) text += "M30\n";
  if (dialect == NcDialect::a3200) text += "END PROGRAM\n";
  if (dialect == NcDialect::automation1) text += "end\n";
  if (dialect == NcDialect::fanuc) text += "M30\n%\n";
  return is_pmac ? text + "close\n" : text;
}

/// After 200 random moves, absolute or incremental, positions agree with sums of whole nanometres to 1e-10 mm.
RC_GTEST_PROP(NcReader, RandomMovesInEveryLanguage, ()) {
  std::vector<Step> steps;
  for (int i = 0; i < 200; ++i) {
    Step step;
    step.is_absolute = *rc::gen::inRange(0, 2) == 1;
    step.move = *rc::gen::inRange(0, 2) == 1 ? NcMove::rapid : NcMove::linear;
    step.axis = *rc::gen::inRange<std::size_t>(0, 5);
    step.micro = *rc::gen::inRange<long long>(-100000000, 100000001);
    steps.push_back(step);
  }
  for (const NcDialect dialect : kAll) {
    const Record record = record_of(text_of(steps, dialect), dialect);
    RC_ASSERT(record.end.is_complete);
    RC_ASSERT(record.motions.size() == steps.size() + 1);
    std::array<long long, 5> at{};
    for (std::size_t i = 0; i < steps.size(); ++i) {
      at[steps[i].axis] = steps[i].micro + (steps[i].is_absolute ? 0 : at[steps[i].axis]);
      const AxisPositions& to = record.motions[i + 1].to;
      const std::array<double, 5> got = {to.x_mm, to.y_mm, to.z_mm, to.a_deg, to.c_deg};
      for (std::size_t axis = 0; axis < 5; ++axis)
        RC_ASSERT(std::abs(got[axis] - static_cast<double>(at[axis]) * (axis < 3 ? 1e-6 : 1e-7)) < 1e-10);
    }
  }
}

std::string refusal(const std::string& text, NcDialect dialect) {
  std::string taken;
  const std::string refused = refusal_of([&] {
    const Record record = record_of(text, dialect);
    taken = record.end.is_complete ? "accepted" : fmt::format("cut off at {}", record.end.line);
    if (!record.end.is_complete) record_message(record.end.reason);
  });
  return refused + taken;
}

TEST(NcReader, WhatIsNotUnderstoodIsAnErrorWithItsLine) {
  const auto rs274 = [](const std::string& from, const std::string& to) {
    return refusal(with_replaced(sample(NcDialect::rs274ngc), from, to), NcDialect::rs274ngc);
  };
  EXPECT_EQ(rs274("G0 Z5.", "G2 Z5."), "p:14");
  EXPECT_EQ(rs274("G0 Z5.", "G0 U5."), "p:14");
  EXPECT_EQ(rs274("G0 Z5.", "G0 G1 Z5."), "p:14");
  EXPECT_EQ(rs274("G0 Z5.", "G0 Z5. Z6."), "p:14");
  EXPECT_EQ(rs274("G0 Z5.", "G0 Z"), "p:14");
  EXPECT_EQ(rs274("G0 Z5.", "G0 Z#1"), "p:14");
  EXPECT_EQ(rs274("G0 Z5.", "/G0 Z5."), "p:14");
  EXPECT_EQ(rs274("G0 Z5.", "G53 G0 Z5."), "p:14");
  EXPECT_EQ(rs274("M7", "M6"), "p:13");
  EXPECT_EQ(rs274("(a sample)", "(a sample"), "p:2");
  EXPECT_EQ(rs274("G4 P0.100", "G4"), "p:6");
  EXPECT_EQ(rs274("o101 call", "o101 while [1]"), "p:19");
  EXPECT_EQ(rs274("G0 Z5.", "Z5."), "p:14");
  EXPECT_EQ(rs274("G90 G94\n", "G91 G94\n"), "p:14");
  EXPECT_EQ(refusal(with_replaced(sample(NcDialect::fanuc), "X1.5", "X1500"), NcDialect::fanuc), "p:9");
  EXPECT_EQ(refusal(with_replaced(sample(NcDialect::fanuc), "M98 P0101", "M99"), NcDialect::fanuc), "p:11");
  EXPECT_EQ(refusal(with_replaced(sample(NcDialect::sinumerik), "TRAFOOF", "TRAORI"), NcDialect::sinumerik), "p:4");
  EXPECT_EQ(refusal(with_replaced(sample(NcDialect::sinumerik), "D0", "D1"), NcDialect::sinumerik), "p:3");
  EXPECT_EQ(refusal(with_replaced(sample(NcDialect::pmac), "frax(X,Y,Z)", "frax(X,Y)"), NcDialect::pmac), "p:13");
  EXPECT_EQ(refusal(with_replaced(sample(NcDialect::pmac), "rapid Z5.", "spline Z5."), NcDialect::pmac), "p:17");
}

TEST(NcReader, WhatIsNotUnderstoodOfAnA3200) {
  const auto read = [](const std::string& from, const std::string& to) {
    return refusal(with_replaced(with_replaced(sample(NcDialect::a3200), "M107\n", ""), from, to), NcDialect::a3200);
  };
  expect_change_refusals(read, {{"M5", "M5", "accepted"},
                                {"INPOS", "NOWAIT", "p:8"},
                                {"G94", "G93", "p:6"},
                                {"M5", "M7", "p:9"},
                                {"RAPID Z5.", "CW X1. Y1. R1.", "p:10"},
                                {"RAPID Z5.", "RAPID Z5. ZF25", "p:10"},
                                {"RAPID Z5.", "G1 Z5. E10", "p:10"},
                                {"DWELL 0.1", "G4", "p:24"},
                                {"DWELL 0.1", "G1 P0.1", "p:24"},
                                {"END PROGRAM\n", "", "p:20"},
                                {"END PROGRAM\n", "M2\nEND PROGRAM\n", "accepted"},
                                {"ENDDFS\n", "ENDDFS\nG0 Z9.\n", "p:29"},
                                {"ENDDFS\n", "", "cut off at 15"}});
  EXPECT_EQ(refusal("G90\nG0 Z5.\n", NcDialect::a3200), "cut off at 2");
  EXPECT_EQ(refusal("END PROGRAM\nDFS A\n", NcDialect::a3200), "cut off at 2");
  EXPECT_EQ(read("DFS PLUNGE", "DFS 101"), "p:21");
  EXPECT_EQ(read("CALL plunge", "CALL other"), "cut off at 15");
}

TEST(NcReader, WhatIsNotUnderstoodOfAeroScript) {
  const auto read = [](const std::string& from, const std::string& to) {
    const std::string text = with_replaced(sample(NcDialect::automation1), "  M107\n", "");
    return refusal(with_replaced(text, from, to), NcDialect::automation1);
  };
  expect_change_refusals(read, {{"M5", "M5", "accepted"},
                                {"InPosition", "Auto", "p:7"},
                                {"DistanceUnits.Primary", "DistanceUnits.Secondary", "p:3"},
                                {"g90", "g90 G71", "p:5"},
                                {"G0 Y0.", "G0 y0.", "p:15"},
                                {"MoveLinear([Z], [-0.25])", "MoveLinear([Z], [-0.25], 5)", "p:22"},
                                {"MoveRapid([Z], [0.2])", "MoveRapid([Z, Y], [0.2])", "p:12"},
                                {"MoveRapid([Z], [0.2])", "MoveRapid([S], [0.2])", "p:12"},
                                {"Plunge()\n  N10", "Plunge(1)\n  N10", "p:13"},
                                {"Plunge()\n  N10", "Plunge(\n  N10", "p:13"},
                                {"Plunge()\n  N10", "plunge()\n  N10", "cut off at 13"},
                                {"function Plunge()", "function Plunge($z as real)", "p:19"},
                                {"program\n", "", "p:2"},
                                {"// half way", "/* half way */", "p:11"}});
  EXPECT_EQ(refusal("program\nG90\n", NcDialect::automation1), "cut off at 2");
  EXPECT_EQ(read("G90\nend\n", "G90\n"), "cut off at 13");
}

/// The feed of an Aerotech control is the speed along the common path of all axes. It therefore determines the time of
/// a move whose ends are blended.
TEST(NcReader, FeedsOfAllAxesSayTimes) {
  const auto move = [](const std::string& line, const std::string& mode) {
    const Record record =
        record_of("G71 G75 G90\n" + mode + "\nG0 X0. Y0. Z0. C0.\n" + line + "\nEND PROGRAM\n", NcDialect::a3200);
    return record.motions.back();
  };
  EXPECT_DOUBLE_EQ(move("G1 X3. Z4. F10.", "G108").duration_s, 30.0);
  EXPECT_DOUBLE_EQ(move("G1 X3. C4. F10.", "G108").duration_s, 30.0);
  EXPECT_DOUBLE_EQ(move("G1 X3. C4. F10.", "G109").duration_s, 30.0) << "C turns too";
  EXPECT_DOUBLE_EQ(move("G76 G1 X3. Z4. F10.", "G108").duration_s, 0.5) << "per second";
  EXPECT_EQ(move("G1 X3. Z4. F10.", "G109").duration_s, 0.0) << "ramps at both ends";
  EXPECT_EQ(move("G1 X3. Z4. F10.", "G109").feed_mm_per_min, 10.0);
}

struct NoSink : NcSink {
  void motion(const NcMotion&, const NcSettings&) override {}
  void dwell(double, const NcLocation&, const AxisPositions&) override {}
};

NcSettings settings_after(const std::string& text, NcDialect dialect, const NcTexts& spindle = {}) {
  NoSink sink;
  return run_nc(parse_nc(text, "p", dialect, spindle), sink).settings;
}

TEST(NcReader, WhatTheSpindleDoes) {
  for (const auto& [dialect, text] : {std::pair{NcDialect::rs274ngc, "%\nG97 S800 M3\nS900.5\nM2\n%\n"},
                                      {NcDialect::sinumerik, "S800 M3\nS900.5\nM30\n"},
                                      {NcDialect::fanuc, "%\nO1\nG97 S800 M3\nS900.5\nM30\n%\n"}}) {
    EXPECT_EQ(settings_after(text, dialect).spindle, NcSpindle::clockwise) << word_of(dialect);
    EXPECT_EQ(settings_after(text, dialect).spindle_rpm, 900.5) << word_of(dialect);
    EXPECT_EQ(settings_after(with_replaced(text, "M3", "M4"), dialect).spindle, NcSpindle::counterclockwise);
    EXPECT_EQ(settings_after(with_replaced(text, "S900.5", "M5"), dialect).spindle, NcSpindle::stopped);
    const std::string before = std::string(text).substr(0, std::string(text).find("S900.5"));
    const std::string place = fmt::format("p:{}", 1 + std::count(before.begin(), before.end(), '\n'));
    EXPECT_EQ(refusal(with_replaced(text, "S900.5", "S1 S2"), dialect), place);
    EXPECT_EQ(refusal(with_replaced(text, "S900.5", "S-1"), dialect), place);
  }
}

TEST(NcReader, APmacsSpindleIsTakenLetterByLetter) {
  const NcTexts texts = {"send1\"go 800\"", "M105", "", "", ""};
  const std::string text = "open prog 1\nM5\n  send1\"go 800\"\nclose\n";
  EXPECT_EQ(settings_after(text, NcDialect::pmac, texts).spindle, NcSpindle::started_by_text);
  EXPECT_EQ(settings_after(with_replaced(text, "close", "M105\nclose"), NcDialect::pmac, texts).spindle,
            NcSpindle::stopped_by_text);
  EXPECT_EQ(settings_after(with_replaced(text, "close", "M5\nclose"), NcDialect::pmac, texts).spindle,
            NcSpindle::stopped);
  EXPECT_THROW(settings_after(text, NcDialect::pmac), InputError);
  EXPECT_THROW(settings_after(with_replaced(text, "800", "801"), NcDialect::pmac, texts), InputError);
  EXPECT_THROW(settings_after(with_replaced(text, "send1", "SEND1"), NcDialect::pmac, texts), InputError);
  EXPECT_THROW(settings_after("M105\n" + text, NcDialect::pmac, texts), InputError) << "outside of the program";
}

/// P of G64 is the tolerance for rounding corners, and Q is the tolerance for merging blocks. The path may deviate by P
/// + Q. If Q is missing, it equals P. Both are in the unit of the program.
TEST(NcReader, BlendingOfLinuxCncIsPAndQ) {
  const auto blend_mm = [](const std::string& words) {
    return settings_after("G21\n" + words + "\nM2\n", NcDialect::rs274ngc).blend_mm;
  };
  EXPECT_EQ(blend_mm("G64"), std::nullopt);
  EXPECT_DOUBLE_EQ(blend_mm("G64 P0.5").value(), 1.0);
  EXPECT_DOUBLE_EQ(blend_mm("G64 P0.5 Q0.25").value(), 0.75);
  EXPECT_DOUBLE_EQ(blend_mm("G20 G64 P0.5 Q0").value(), 12.7);
  for (const char* words : {"G64 P-0.5", "G64 P0.5 Q-0.25", "G64 P-1 Q2"})
    EXPECT_EQ(refusal(std::string(words) + "\nM2\n", NcDialect::rs274ngc), fmt::format("p:1", words));
}

TEST(NcReader, EndlessRecursionIsRefused) {
  EXPECT_EQ(refusal("o1 sub\no2 call\no1 endsub\no2 sub\no1 call\no2 endsub\no1 call\nM2\n", NcDialect::rs274ngc),
            "p:2");
  EXPECT_EQ(refusal("%\nO1\nM98 P2\nM30\nO2\nM98 P2\nM99\n%\n", NcDialect::fanuc), "p:6");
  EXPECT_EQ(refusal("open subprog 1\ncall 1\nclose\nopen prog 1\ncall 1\nclose\n", NcDialect::pmac), "p:2");
  EXPECT_EQ(refusal("A1:\nCALL BLOCK A1 TO E1\nE1:\nM30\n", NcDialect::sinumerik), "p:2");
}

TEST(NcReader, TextThatIsNoProgram) {
  EXPECT_EQ(refusal("", NcDialect::rs274ngc), "p");
  EXPECT_EQ(refusal(" \n\n", NcDialect::pmac), "p");
  EXPECT_EQ(refusal("%\nG0 \x01Z5\n", NcDialect::rs274ngc), "p:2");
  EXPECT_EQ(refusal(std::string("%\n\0\0", 4), NcDialect::fanuc), "p:2");
  EXPECT_EQ(refusal("%\n" + std::string(100000, 'G'), NcDialect::rs274ngc), "p:2");
  EXPECT_THROW(recognise_dialect("hello world\n", "p"), InputError);
}

/// An incomplete file is not an error for the reader. The reader reports the line at which the file ends, and the
/// verifier reports a finding.
TEST(NcReader, EveryCutOffFileIsRecognised) {
  for (const NcDialect dialect : kAll) {
    const std::string whole = sample(dialect);
    // A missing line end after the last line makes no difference to a controller.
    for (std::size_t length = 1; length + 1 < whole.size(); ++length) {
      bool is_complete = false;
      const std::string refused =
          unrecorded_refusal_of([&] { is_complete = record_of(whole.substr(0, length), dialect).end.is_complete; });
      EXPECT_FALSE(is_complete) << word_of(dialect) << " cut to " << length << ' ' << refused;
    }
  }
}

/// The file ends within the line of the end label of a subroutine. It contains the label, but the block after the label
/// is incomplete. The subroutine is therefore incomplete.
TEST(NcReader, AFileThatStopsInTheLineOfALabelLacksItsSubroutine) {
  const std::string text = "G0 A45. C=-0.1\nCALL BLOCK RT101 TO RE101\nM30\nRT101:\nG91\nG1 F50. Z-0.25\nRE101:1.5 Y";
  const std::string outcome = refusal(text, NcDialect::sinumerik);
  EXPECT_EQ(outcome, "cut off at 2");
}

}  // namespace
}  // namespace retrace::fabrication::nc_reader_test
