// Tests of the border of turned parts. The verifier must find cuts that are too high at the border. The reference is
// PlainCut, which computes the cut surface at points on the border.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <random>

#include "fabrication/post/post.h"
#include "fabrication/turning/check/turning_check.h"
#include "fabrication/turning/io/part_files.h"
#include "fabrication/turning/plan/turning_program.h"
#include "tests/fabrication/turning/plain_cut.h"

namespace retrace::fabrication::turning::border_test {
namespace {

using fabrication::test::border_places, fabrication::test::deviations, fabrication::test::PlainCut;

/// First lines of a part file. The surface is a bowl with a cubic term. Because the surface is inclined, the point of
/// contact is farther from the axis than the lowest point of the nose.
const std::string kHead =
    "schema = \"retrace.turned_part/1\"\n[base]\nkind = \"xy_polynomial\"\nterms = [[2, 0, 0.05], [0, 2, 0.03], [3, 0, "
    "0.02]]\n[tool]\nnose_radius_mm = 0.5\nclearance_deg = 15\n";
const std::string kTail = "[inspect]\nform_tolerance_nm = 20\nmap_pixels = 21\n";
const std::string kRaster = kHead +
                            "[path]\nstrategy = \"raster\"\nsize_mm = [0.05, 0.05]\nfeed_um = 10\narc_um = "
                            "10\ncutting_mm_per_min = 120\nclear_mm = 0.5\n" +
                            kTail;

std::string spiral(double overrun_mm) {
  return kHead +
         fmt::format(
             "[path]\nradius_mm = 0.05\noverrun_mm = {}\nfeed_um = 10\nspindle_rpm = 60\npoints_per_turn = 60\n",
             overrun_mm) +
         kTail;
}

struct Planned {
  explicit Planned(const std::string& file) : part(parse_turned_part(file, "part.toml")) {
    const std::vector<Pass> passes = make_path(part.surface, part.tool, part.path, {"part.toml", 0, "path"});
    lines = fabrication::test::lines_of_text(nc_text(turning_program(passes, part.path, "part", {}), "rs274ngc"));
  }

  TurnedPart part;
  std::vector<std::string> lines;

  /// Returns the line indices of the blocks of a cut.
  /// \param number index of the cut, from 0
  std::vector<std::size_t> blocks(std::size_t number) const {
    std::vector<std::size_t> result;
    std::size_t cuts = 0;
    bool is_timed = false;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (lines[i].starts_with("G93")) ++cuts;
      if (lines[i].starts_with("G93")) is_timed = true;
      if (lines[i].starts_with("G94")) is_timed = false;
      if (is_timed && cuts == number + 1 && lines[i].find(" Z") != std::string::npos) result.push_back(i);
    }
    return result;
  }

  /// Returns the program with increased Z words in the lines `which`.
  std::string raised(const std::vector<std::size_t>& which, double by_mm) const {
    std::vector<std::string> changed = lines;
    for (const std::size_t i : which) {
      const std::size_t at = lines[i].find(" Z") + 2;
      const std::size_t end = std::min(lines[i].find(' ', at), lines[i].size());
      changed[i] =
          lines[i].substr(0, at) + fmt::format("{:.6f}", std::stod(lines[i].substr(at)) + by_mm) + lines[i].substr(end);
    }
    return fabrication::test::text_of_lines(changed);
  }

  std::vector<Finding> findings(const std::string& text) const {
    // Use one thread. The programs are so small that parallel loops would be slower.
    const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
    FindingList list;
    check_turning(part, read_cuts(part, {parse_nc(text, "p", NcDialect::rs274ngc)}, list), std::nullopt, list);
    return list.take();
  }

  /// Returns the deviations from the design at points on the border, in nm.
  std::vector<double> border_nm(const std::string& text, int places) const {
    std::vector<fabrication::test::PlainMove> cuts;
    for (const fabrication::test::PlainMove& m : fabrication::test::plain_program(text).moves)
      if (m.is_timed && !m.is_rapid) cuts.push_back(m);
    std::vector<double> result = deviations(PlainCut(part, cuts), border_places(part, places));
    for (double& nm : result) nm *= 1e6;
    return result;
  }
};

double largest_excess(const std::vector<double>& now, const std::vector<double>& right) {
  double worst = 0.0;
  for (std::size_t i = 0; i < now.size(); ++i) worst = std::max(worst, now[i] - right[i]);
  return worst;
}

TEST(TurningBorder, ARaisedFirstLineOfARasterIsFound) {
  const Planned plan(kRaster);
  const std::string text = fabrication::test::text_of_lines(plan.lines);
  EXPECT_TRUE(plan.findings(text).empty());
  const std::vector<std::size_t> first = plan.blocks(0);
  ASSERT_EQ(first.size(), 5U);
  for (const double by_mm : {0.02, 0.001, 0.0001}) {
    const std::string high = plan.raised(first, by_mm);
    const std::vector<Finding> found = plan.findings(high);
    ASSERT_FALSE(found.empty()) << by_mm;
    double told_nm = 0.0;
    for (const Finding& f : found) told_nm = std::max(told_nm, f.kind == "excess" ? f.value : 0.0);
    const std::vector<double> border = plan.border_nm(high, 200);
    EXPECT_NEAR(told_nm, *std::max_element(border.begin(), border.end()), 1.0) << by_mm;
    // The second line of the raster is 10 um away. When the tool is on this line, its nose is 80.4 nm above the surface
    // at the border. The second line therefore limits the excess. Words are rounded to 1 nm.
    EXPECT_NEAR(told_nm, 80.4, 1.5) << by_mm;
  }
  EXPECT_TRUE(plan.findings(plan.raised(first, 1e-5)).empty()) << "less than the tolerance";
}

TEST(TurningBorder, AMissingOuterLineOfARasterIsFound) {
  const Planned plan(kRaster);
  for (const bool is_first : {true, false}) {
    std::vector<std::size_t> begins;
    for (std::size_t i = 0; i < plan.lines.size(); ++i)
      if (plan.lines[i].starts_with("G0 X")) begins.push_back(i);
    ASSERT_EQ(begins.size(), 6U);
    const auto at = [](std::size_t i) { return static_cast<std::ptrdiff_t>(i); };
    std::vector<std::string> lines = plan.lines;
    const std::size_t from = is_first ? begins[0] : begins[5];
    lines.erase(lines.begin() + at(from), lines.begin() + at(from + begins[1] - begins[0]));
    const std::vector<Finding> found = plan.findings(fabrication::test::text_of_lines(lines));
    EXPECT_TRUE(std::any_of(found.begin(), found.end(), [](const Finding& f) {
      return f.kind == "uncut" || f.kind == "feed_step";
    })) << is_first;
  }
}

/// Raises random blocks near the border and compares the result with the correct program. The verifier must report a
/// change that leaves 1.05 times the tolerance more material at the border.
void judge_raised(const Planned& plan, std::size_t first_cut, std::size_t last_cut, std::size_t outer_blocks) {
  EXPECT_TRUE(plan.findings(fabrication::test::text_of_lines(plan.lines)).empty());
  const std::vector<double> right = plan.border_nm(fabrication::test::text_of_lines(plan.lines), 60);
  std::mt19937 bits(5);
  const double heights_mm[] = {0.02, 0.001, 1e-4, 4e-5};
  int faults = 0;
  for (int k = 0; k < 60; ++k) {
    std::vector<std::size_t> blocks = plan.blocks(k % 2 == 0 ? first_cut : last_cut);
    const std::size_t count = std::min(outer_blocks, blocks.size());
    const std::size_t begin = std::uniform_int_distribution<std::size_t>(0, count - 1)(bits);
    const std::size_t length = k % 3 == 0 ? 1 : std::uniform_int_distribution<std::size_t>(1, count - begin)(bits);
    blocks = {blocks.begin() + static_cast<std::ptrdiff_t>(begin),
              blocks.begin() + static_cast<std::ptrdiff_t>(begin + length)};
    const double by_mm = heights_mm[k % 4];
    const std::string text = plan.raised(blocks, by_mm);
    const double excess_nm = largest_excess(plan.border_nm(text, 60), right);
    if (excess_nm < 1.05 * plan.part.form_tolerance_nm) continue;
    ++faults;
    EXPECT_FALSE(plan.findings(text).empty())
        << length << " blocks from line " << blocks.front() + 1 << " raised by " << by_mm << " mm leave " << excess_nm;
  }
  EXPECT_GT(faults, 20);
}

TEST(TurningBorder, RaisedBlocksOfOuterLinesAreFound) {
  judge_raised(Planned(kRaster), 0, 5, 5);
}

TEST(TurningBorder, RaisedBlocksOfTheFirstTurnAreFound) {
  judge_raised(Planned(spiral(0.0)), 0, 0, 60);
}

TEST(TurningBorder, RaisedBlocksOfASpiralThatBeginsBeyondThePartAreFound) {
  judge_raised(Planned(spiral(0.006)), 0, 0, 90);
}

/// Blocks that are too far outside of the border do not cut the part. They may be raised without a finding.
TEST(TurningBorder, CutsBeyondThePartAreFree) {
  const Planned plan(spiral(0.04));
  std::vector<std::size_t> blocks = plan.blocks(0);
  blocks.resize(90);
  const std::string text = plan.raised(blocks, 0.005);
  EXPECT_LT(largest_excess(plan.border_nm(text, 60), plan.border_nm(plan.raised(blocks, 0.0), 60)), 1.0);
  for (const Finding& finding : plan.findings(text)) ADD_FAILURE() << text_of(finding);
}

/// A cut that is too deep outside of the border can gouge the part, because the nose is wider than the feed.
TEST(TurningBorder, LoweredOuterCutsAreFound) {
  for (const std::string& file : {kRaster, spiral(0.0)}) {
    const Planned plan(file);
    const std::string text = plan.raised(plan.blocks(0), -1e-4);
    EXPECT_FALSE(plan.findings(text).empty());
    std::vector<std::size_t> one = {plan.blocks(0)[2]};
    const std::vector<double> border = plan.border_nm(plan.raised(one, -1e-4), 200);
    EXPECT_LT(*std::min_element(border.begin(), border.end()), -40.0);
    EXPECT_FALSE(plan.findings(plan.raised(one, -1e-4)).empty());
  }
}

}  // namespace
}  // namespace retrace::fabrication::turning::border_test
