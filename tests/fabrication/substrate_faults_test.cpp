// Tests of faults that are inserted into programs for elements on substrates.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/fabrication/substrate_programs.h"

namespace retrace::fabrication::test::substrate_faults_test {
namespace {

/// Fixture with the text of a program, into which tests insert faults.
class SubstrateFaults : public ::testing::TestWithParam<bool> {
 protected:
  SubstrateFaults()
      : job_(GetParam() ? cubes_on(sphere_substrate(4.0, ElementAxes::normal), false)
                        : prisms_on(cylinder_substrate(6.0, false, ElementAxes::normal))),
        text_(text_of(job_)) {}

  /// Returns the text with one changed word in the first line after `from` that begins with `start`.
  std::string changed(std::size_t from, const std::string& start, char letter, double by) const {
    const std::size_t line = text_.find("\n" + start, from) + 1;
    const std::size_t word = text_.find(letter, line) + 1;
    const std::size_t end = text_.find_first_of(" \n", word);
    const double value = std::stod(text_.substr(word, end - word));
    return text_.substr(0, word) + fmt::format("{:.7f}", value + by) + text_.substr(end);
  }
  std::string without_line(std::size_t at) const {
    const std::size_t first = text_.rfind('\n', at) + 1;
    return text_.substr(0, first) + text_.substr(text_.find('\n', at) + 1);
  }
  std::size_t last_visit(int element) const { return text_.rfind(fmt::format("(element {})", element)); }

  Job job_;
  std::string text_;
};

TEST_P(SubstrateFaults, NoneWithoutAFault) {
  EXPECT_EQ(kinds_of(verified(job_, text_)), "");
}

TEST_P(SubstrateFaults, AShiftedElement) {
  // Words that do not change are not written. The word to change is Y, or X if Y is not written.
  const std::size_t visit = last_visit(4);
  const bool has_y = text_.find(" Y", visit) < text_.find(" call", visit);
  const std::size_t word = text_.find(has_y ? " Y" : " X", visit);
  ASSERT_LT(word, text_.find(" call", visit));
  const Verification v =
      verified(job_, changed(visit, text_.substr(text_.rfind('\n', word) + 1, 4), has_y ? 'Y' : 'X', 0.0005));
  ASSERT_FALSE(v.passes());
  for (const Finding& finding : v.findings) EXPECT_EQ(finding.element, 4) << listed(v);
}

TEST_P(SubstrateFaults, AWrongTilt) {
  const std::size_t turn = text_.rfind(GetParam() ? "\nG0 B" : "\nG0 A", last_visit(4));
  const Verification v = verified(job_, changed(turn - 1, GetParam() ? "G0 B" : "G0 A", GetParam() ? 'B' : 'A', 0.02));
  EXPECT_FALSE(v.passes());
}

TEST_P(SubstrateFaults, AWrongC) {
  const std::size_t turn = text_.rfind(GetParam() ? "\nG0 B" : "\nG0 A", last_visit(4));
  const Verification v = verified(job_, changed(turn - 1, GetParam() ? "G0 B" : "G0 A", 'C', 0.02));
  EXPECT_FALSE(v.passes());
}

TEST_P(SubstrateFaults, AMissingPlunge) {
  const Verification v = verified(job_, without_line(text_.find(" call", last_visit(4))));
  ASSERT_FALSE(v.passes());
  EXPECT_EQ(v.findings.front().element, 4) << listed(v);
}

TEST_P(SubstrateFaults, ATurnLost) {
  const std::size_t turn = text_.rfind(GetParam() ? "\nG0 B" : "\nG0 A", last_visit(4));
  EXPECT_FALSE(verified(job_, without_line(turn + 1)).passes());
}

TEST_P(SubstrateFaults, AnElementCutAtTheHeightOfAFlatArray) {
  Job flat = job_;
  flat.substrate.reset();
  EXPECT_FALSE(verified(job_, text_of(flat)).passes());
}

TEST_P(SubstrateFaults, ARapidMoveThroughTheBlank) {
  const std::size_t line = text_.find("\nG0 Z", last_visit(4)) + 1;
  const double z_mm = std::stod(text_.substr(line + 4));
  const std::string low = text_.substr(0, line) + fmt::format("G0 Z{:.6f}\n", z_mm - 0.8) + text_.substr(line);
  const std::string kinds = kinds_of(verified(job_, low));
  EXPECT_NE(kinds.find("rapid_in_material"), std::string::npos) << kinds;
}

INSTANTIATE_TEST_SUITE_P(OfPrismsAndCubes, SubstrateFaults, ::testing::Values(false, true));

}  // namespace
}  // namespace retrace::fabrication::test::substrate_faults_test
