// Tests of correct and changed programs of planing mills and lathes. Correct programs of random parts must pass in
// every dialect. The verifier must find every small change that an independent rule calls a fault. The changed programs
// are small.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "core/error.h"
#include "fabrication/planing/check/check.h"
#include "fabrication/planing/plan/nose_path.h"
#include "fabrication/planing/plan/plan.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/mutants.h"
#include "tests/fabrication/planing/turned_lens.h"

namespace retrace::fabrication::planing_mutation_test {
namespace {

using test::PlainMove;
using test::PlainProgram;

PlanedPart mill_part() {
  PlanedPart part;
  part.source = "part.toml";
  part.lens = {60.0, 10.0, 1.6, 50.0};
  part.length_mm = 30.0;
  part.tolerance_mm = 1.0;
  part.mill = PlaningMill{};
  part.mill->fast_feed_mm_per_min = 3000.0;
  part.mill->grid_mm = 0.1;
  return part;
}

PlanedPart lathe_part(double nose_mm) {
  return test::turned_lens({60.0, 10.0, 1.6, 45.0}, 0.2, 6.0, nose_mm);
}

std::vector<PlaningText> texts_of(const PlanedPart& part, const std::string& dialect) {
  std::vector<PlaningText> texts;
  for (const PlannedProgram& planned : plan_planing(part).programs)
    texts.push_back({planned.program.name, nc_text(planned.program, dialect)});
  return texts;
}

/// Returns true if the check reports a finding or refuses the text.
bool is_found(const PlanedPart& part, const std::vector<PlaningText>& texts) {
  try {
    return !check_planing(part, texts, NcDialect::rs274ngc).passes();
  } catch (const InputError&) {
    return true;
  }
}

/// Function that returns the first kind of fault in a set of programs, or an empty string.
using Rule = std::function<std::string(const std::vector<PlainProgram>&)>;

std::string form_fault(const PlainProgram& program) {
  if (program.is_odd) return "not understood";
  if (!program.ends) return "does not end";
  if (!program.is_prepared) return "settings";
  if (program.moves.empty()) return "";
  const PlainMove& first = program.moves.front();
  if (!first.named[2] || first.named[0] || first.named[1] || !first.is_rapid) return "first move";
  return "";
}

/// Returns the first fault of programs of a mill, or an empty string. The strokes of a tool with a vertical outer side
/// are superimposed at sample points of the profile.
std::string mill_fault(const PlanedPart& part, double slope, const std::vector<PlainProgram>& programs) {
  struct Stroke {
    double x;
    double depth;
  };
  std::vector<Stroke> strokes;
  const double least[] = {part.mill->min_move_x_mm, part.mill->min_move_y_mm, part.mill->min_move_z_mm};
  for (const PlainProgram& program : programs) {
    if (const std::string fault = form_fault(program); !fault.empty()) return fault;
    if (!program.stops_spindle || program.spindle_is_left_on) return "spindle";
    for (const PlainMove& m : program.moves) {
      if (m.is_spindle_on) return "spindle";
      if (!m.is_stop) return "blending";
      if (!m.is_rapid) return "no fast feed";
      if (m.named[3]) return "C";
      int moved = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double way = std::abs(m.at[axis] - m.from[axis]);
        const bool is_off = std::abs(std::remainder(m.at[axis], part.mill->grid_mm)) > 1e-6;
        if (m.named[axis] && is_off) return "grid";
        if (!m.named[axis] || !m.known[axis] || way == 0.0) continue;
        ++moved;
        if (!(m.known[0] && m.known[1] && m.known[2])) return "moves before its place is known";
        if (way < least[axis] - 1e-6) return "short";
        const double low = std::min(m.from[2], m.at[2]);
        const auto is_over = [&](double y) { return y >= 0.0 && y <= part.length_mm; };
        if (low < 0.0 && (is_over(m.from[1]) || is_over(m.at[1]))) return "in the part";
        if (axis == 1 && low < 0.0 && (m.from[1] < 0.0) != (m.at[1] < 0.0)) strokes.push_back({m.at[0], -low});
      }
      if (moved > 1) return "several axes";
    }
  }
  const ZoneProfile profile(part.lens);
  for (double x = -part.lens.half_width_mm; x <= part.lens.half_width_mm; x += 0.13) {
    double left = 0.0;
    for (const Stroke& s : strokes)
      if (s.x >= x) left = std::max(left, s.depth - slope * (s.x - x));
    const double place = std::abs(x);
    bool is_near_wall = place > part.lens.half_width_mm - 0.3;
    for (const Zone& zone : profile.zones()) is_near_wall = is_near_wall || std::abs(place - zone.to_mm) < 0.3;
    if (is_near_wall) continue;
    const double off = left - profile.depth_mm(place);
    if (off > part.tolerance_mm * 1.02) return "too deep";
    if (x >= 0.0 && off < -part.tolerance_mm * 1.02) return "too high";
  }
  return "";
}

struct Tally {
  int tried = 0;
  int faults = 0;
  int missed = 0;
  int found_besides = 0;  ///< number of changes that were found although the rule does not call them a fault
};

Tally judge_all(const PlanedPart& part, const std::vector<PlaningText>& texts,
                const std::vector<test::NumberChange>& changes, const std::vector<std::string>& inserted,
                const Rule& rule) {
  Tally tally;
  for (std::size_t k = 0; k < texts.size(); ++k)
    for (const test::Mutant& mutant : test::mutants_of(texts[k].text, changes, inserted)) {
      std::vector<PlaningText> mutated = texts;
      mutated[k].text = mutant.text;
      std::vector<PlainProgram> programs;
      for (const PlaningText& text : mutated) programs.push_back(test::plain_program(text.text));
      const std::string fault = rule(programs);
      const bool found = is_found(part, mutated);
      ++tally.tried;
      tally.faults += !fault.empty();
      tally.missed += !fault.empty() && !found;
      tally.found_besides += fault.empty() && found;
      if (!fault.empty() && !found && tally.missed < 20)
        ADD_FAILURE() << texts[k].name << ": " << mutant.what << ": " << fault << " is not found";
    }
  return tally;
}

void record(const Tally& tally) {
  ::testing::Test::RecordProperty("tried", tally.tried);
  ::testing::Test::RecordProperty("faults", tally.faults);
  ::testing::Test::RecordProperty("found_besides", tally.found_besides);
  EXPECT_EQ(tally.missed, 0);
}

TEST(PlaningMutants, OfAMillAreFound) {
  const PlanedPart part = mill_part();
  const std::vector<PlaningText> texts = texts_of(part, "rs274ngc");
  const double slope = plan_planing(part).flank_slope;
  const auto rule = [&](const std::vector<PlainProgram>& programs) { return mill_fault(part, slope, programs); };
  EXPECT_FALSE(is_found(part, texts));
  std::vector<PlainProgram> right;
  for (const PlaningText& text : texts) right.push_back(test::plain_program(text.text));
  EXPECT_EQ(rule(right), "");
  record(judge_all(part, texts,
                   {{'X', 1.0, 0.1},
                    {'X', 1.0, -2.0},
                    {'X', 1.0, 15.0},
                    {'X', -1.0, 0.0},
                    {'X', 1.0, 0.03},
                    {'Y', 1.0, 0.1},
                    {'Y', 1.0, 30.0},
                    {'Y', 1.0, -30.0},
                    {'Z', 1.0, 0.1},
                    {'Z', 1.0, -1.2},
                    {'Z', 1.0, 2.0},
                    {'Z', 5.0, 0.0},
                    {'Z', -1.0, 0.0}},
                   {"M3 S3000", "G64", "G91", "G20", "G1 F500."}, rule));
}

/// Returns the first fault of programs of a lathe, or an empty string. The nose of the tool is a disc that follows the
/// moves. The remaining height is computed at sample points.
std::string lathe_fault(const PlanedPart& part, const std::vector<PlainProgram>& programs) {
  const double end = part.lens.half_width_mm;
  const double nose = part.lathe->nose_radius_mm;
  constexpr double kStep = 0.1003;
  std::vector<double> standing(static_cast<std::size_t>(end / kStep) + 1, 0.0);
  std::vector<double> before = standing;
  const auto lower = [&](std::size_t i, double z) {
    const double taken = std::max(0.0, standing[i] - z);
    standing[i] -= taken;
    return taken;
  };
  const auto cut = [&](double x0, double z0, double x1, double z1) {
    double most = 0.0;
    const int pieces = std::max(1, static_cast<int>(std::hypot(x1 - x0, z1 - z0) / 0.06));
    for (int k = 0; k <= pieces; ++k) {
      const double x = x0 + (x1 - x0) * k / pieces;
      const double z = z0 + (z1 - z0) * k / pieces;
      const auto first = static_cast<std::size_t>(std::max(0.0, (std::abs(x) - nose) / kStep));
      for (std::size_t i = first;
           nose > 0.0 && i < standing.size() && kStep * static_cast<double>(i) < std::abs(x) + nose; ++i) {
        const double aside = std::abs(kStep * static_cast<double>(i) - std::abs(x));
        if (aside < nose) most = std::max(most, lower(i, z + nose - std::sqrt(nose * nose - aside * aside)));
      }
    }
    for (std::size_t i = 0; nose == 0.0 && x0 != x1 && i < standing.size(); ++i)
      for (const double x : {kStep * static_cast<double>(i), -kStep * static_cast<double>(i)})
        if (std::min(x0, x1) <= x && x <= std::max(x0, x1))
          most = std::max(most, lower(i, z0 + (z1 - z0) * (x - x0) / (x1 - x0)));
    return most;
  };
  const auto ends_pass = [&] {
    double most = 0.0;
    for (std::size_t i = 0; i < standing.size(); ++i) most = std::max(most, before[i] - standing[i]);
    before = standing;
    return most > part.lathe->depth_of_cut_mm + 1.5 * part.tolerance_mm;
  };
  for (const PlainProgram& program : programs) {
    if (const std::string fault = form_fault(program); !fault.empty()) return fault;
    for (const PlainMove& m : program.moves) {
      if (m.named[1] || m.named[3]) return "axis";
      if (m.is_rapid) {
        if (ends_pass()) return "chip";
        if (!m.known[2]) continue;
        if (!(m.known[0] || m.named[0])) continue;
        const double x0 = m.known[0] ? m.from[0] : m.at[0];
        if (cut(x0, std::min(m.from[2], m.at[2]), m.at[0], std::min(m.from[2], m.at[2])) > 0.01) return "rapid";
        before = standing;
        continue;
      }
      if (!(m.known[0] && m.known[2])) return "cuts before its place is known";
      if (!m.is_stop) return "blending";
      if (!m.is_spindle_on || m.rpm != part.lathe->spindle_rpm) return "spindle";
      if (m.is_timed || m.feed <= 0.0 || m.feed > part.lathe->feed_mm_per_min * 1.001) return "feed";
      cut(m.from[0], m.from[2], m.at[0], m.at[2]);
    }
    if (program.spindle_is_left_on) return "spindle at the end";
    if (ends_pass()) return "chip";
  }
  // Skip points that are close to walls, within twice the sum of the nose radius and the tolerance. The deviation at
  // all other points is unambiguous.
  const ZoneProfile profile(part.lens);
  for (std::size_t i = 0; i < standing.size(); ++i) {
    const double x = kStep * static_cast<double>(i);
    bool is_near_wall = x > end - 0.5;
    for (const Zone& zone : profile.zones())
      is_near_wall = is_near_wall || std::abs(x - zone.to_mm) < 2.0 * (nose + part.tolerance_mm);
    if (is_near_wall) continue;
    const double slope = profile.slope_in_zone(profile.zone_of(x), x);
    const double off = (standing[i] + profile.depth_mm(x)) / std::sqrt(1.0 + slope * slope);
    if (off > 1.2 * part.tolerance_mm) return "too high";
    if (off < -1.2 * part.tolerance_mm) return "too deep";
  }
  return "";
}

TEST(PlaningMutants, OfALatheAreFound) {
  for (const double nose : {0.0, 0.8}) {
    const PlanedPart part = lathe_part(nose);
    const std::vector<PlaningText> texts = texts_of(part, "rs274ngc");
    const auto rule = [&](const std::vector<PlainProgram>& programs) { return lathe_fault(part, programs); };
    EXPECT_FALSE(is_found(part, texts)) << nose;
    EXPECT_EQ(rule({test::plain_program(texts[0].text)}), "") << nose;
    record(judge_all(part, texts,
                     {{'X', 1.0, 0.3},
                      {'X', 1.0, -2.0},
                      {'X', -1.0, 0.0},
                      {'Z', 1.0, 0.06},
                      {'Z', 1.0, -0.5},
                      {'Z', 1.0, 0.5},
                      {'Z', 1.0, -3.0},
                      {'F', 5.0, 0.0},
                      {'S', 1.1, 0.0}},
                     {"M5", "S400", "G64", "G91", "G20", "G93"}, rule));
  }
}

TEST(Planing, ATruncatedProgramIsAFinding) {
  for (const PlanedPart& part : {mill_part(), lathe_part(0.8)})
    for (const char* dialect : {"rs274ngc", "sinumerik", "fanuc", "pmac", "a3200", "automation1"}) {
      const auto word = std::find(std::begin(kNcDialectWords), std::end(kNcDialectWords), dialect);
      const auto read_as = static_cast<NcDialect>(word - std::begin(kNcDialectWords));
      const std::vector<PlaningText> texts = texts_of(part, dialect);
      const std::vector<std::string> lines = test::lines_of_text(texts.back().text);
      for (std::size_t kept = 12; kept + 1 < lines.size(); kept += 7) {
        std::vector<PlaningText> cut = texts;
        cut.back().text = test::text_of_lines({lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(kept)});
        const PlaningCheck check = check_planing(part, cut, read_as);
        EXPECT_TRUE(std::any_of(check.findings.begin(), check.findings.end(),
                                [](const Finding& f) { return f.kind == "truncated"; }))
            << dialect << ' ' << kept;
      }
    }
}

TEST(Planing, ProgramsMayBeSplitAndBegunAgain) {
  // Split the passes of a lathe into two programs. Then interrupt the last pass and restart it.
  const PlanedPart part = lathe_part(0.8);
  const std::string text = texts_of(part, "rs274ngc")[0].text;
  std::vector<std::string> lines = test::lines_of_text(text);
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i + 1 < lines.size(); ++i)
    if (lines[i].starts_with("G0 Z") && lines[i + 1].starts_with("G0 X")) starts.push_back(i);
  ASSERT_GE(starts.size(), 3U);
  const auto from = [&](std::size_t i) { return lines.begin() + static_cast<std::ptrdiff_t>(i); };
  const std::vector<std::string> head(lines.begin(), from(starts[0]));
  const std::vector<std::string> tail = {"M5", "M2", "%"};
  const auto program = [&](std::vector<std::string> middle) {
    middle.insert(middle.begin(), head.begin(), head.end());
    middle.insert(middle.end(), tail.begin(), tail.end());
    return test::text_of_lines(middle);
  };
  const std::string first = program({from(starts[0]), from(starts.back())});
  const std::string second = program({from(starts.back()), lines.end() - 3});
  EXPECT_FALSE(is_found(part, {{"a", first}, {"b", second}}));
  EXPECT_TRUE(is_found(part, {{"a", first}})) << "the last pass is missing";
  EXPECT_TRUE(is_found(part, {{"b", second}})) << "and so are those before it";
  // The program `broken` contains the beginning of the last pass. The program `again` continues this pass from two
  // lines before its interruption.
  std::vector<std::string> broken(from(starts.back()), from(starts.back() + 12));
  broken.emplace_back("G0 Z2.000000");
  std::vector<std::string> again = {"G0 Z2.000000", lines[starts.back() + 10]};
  again[1] = "G0 " + again[1].substr(3, again[1].find(" Z") - 3);
  again.insert(again.end(), from(starts.back() + 10), lines.end() - 3);
  EXPECT_FALSE(is_found(part, {{"a", first}, {"b", program(broken)}, {"c", program(again)}}));
}

/// Calls `use` with random parts that can be planned, and with their plans.
template <class Use>
void for_random_parts(unsigned seed, int count, const Use& use) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int made = 0, tried = 0; made < count && tried < 100 * count; ++tried) {
    PlanedPart part = tried % 2 == 0 ? mill_part() : lathe_part(tried % 4 == 1 ? 0.0 : between(0.05, 1.5));
    part.lens = {between(60.0, 400.0), between(2.0, 12.0), between(1.3, 2.2), between(20.0, 90.0)};
    part.length_mm = between(20.0, 200.0);
    part.tolerance_mm = between(0.05, 0.4);
    if (part.mill) {
      part.mill->grid_mm = tried % 3 == 0 ? 0.01 : 0.02;
      part.mill->frame_s = between(0.0, 1.0);
      part.mill->max_hours = between(0.3, 8.0);
    } else {
      part.lathe->feed_mm_per_min = between(20.0, 400.0);
      part.lathe->depth_of_cut_mm = between(0.5, 5.0);
      part.lathe->clearance_mm = between(0.5, 5.0);
      if (tried % 5 == 0) part.lathe->spindle_direction = SpindleDirection::counterclockwise;
    }
    try {
      const ZoneProfile profile(part.lens);
      if (part.tolerance_mm > 0.4 * profile.step_mm()) continue;
      bool is_wide = true;
      for (const Zone& zone : profile.zones()) is_wide = is_wide && zone.to_mm - zone.from_mm > 1.0;
      if (!is_wide || (part.lathe && !nose_fits(profile, part.lathe->nose_radius_mm))) continue;
      use(part, plan_planing(part));
      ++made;
    } catch (const InputError&) {
      continue;  // the lens does not exist or cannot be planned
    }
  }
}

TEST(Planing, RightProgramsOfRandomPartsPassInEveryDialect) {
  int count = 0;
  for_random_parts(20, 60, [&](const PlanedPart& part, const PlaningPlan& plan) {
    ++count;
    for (std::size_t d = 0; d < std::size(kNcDialectWords); ++d) {
      std::vector<PlaningText> texts;
      for (const PlannedProgram& planned : plan.programs)
        texts.push_back({planned.program.name, nc_text(planned.program, std::string(kNcDialectWords[d]))});
      const PlaningCheck check = check_planing(part, texts, static_cast<NcDialect>(d));
      for (const Finding& f : check.findings)
        ADD_FAILURE() << kNcDialectWords[d] << ' ' << text_of(f) << ' ' << f.kind << ' ' << f.value << ' ' << f.limit
                      << " lens " << part.lens.focal_length_mm << ' ' << part.lens.wavelength_mm << ' '
                      << part.lens.refractive_index << ' ' << part.lens.half_width_mm << ' ' << part.tolerance_mm;
      if (part.mill) {
        EXPECT_NEAR(check.flank_slope, plan.flank_slope, 1e-12 * plan.flank_slope);
      }
    }
  });
  EXPECT_EQ(count, 60);
}

}  // namespace
}  // namespace retrace::fabrication::planing_mutation_test
