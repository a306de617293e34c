// Tests of the designs that `retrace init` writes.
#include "design/io/init_templates.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "core/error.h"
#include "tests/studies/design_texts.h"
#include "tests/support/refusals.h"

namespace retrace::studies::init_templates_test {
namespace {

using geometry::HexagonalCube;
using geometry::RtpElement;
using geometry::TriangularCube;

TEST(InitTemplates, EveryKindParsesAndIsCommented) {
  ASSERT_EQ(design::design_kinds().size(), 4U);
  for (const std::string_view kind : design::design_kinds()) {
    const std::string text = design::design_template(kind);
    EXPECT_NO_THROW(design::parse_design(text, "t.toml", {})) << kind;
    EXPECT_EQ(text.substr(0, 2), "# ");
  }
  EXPECT_TRUE(
      std::holds_alternative<RtpElement>(design::parse_design(design::design_template("rtp"), "t", {}).part().element));
  EXPECT_TRUE(std::holds_alternative<HexagonalCube>(
      design::parse_design(design::design_template("hexagonal_icc"), "t", {}).part().element));
  EXPECT_TRUE(std::holds_alternative<TriangularCube>(
      design::parse_design(design::design_template("triangular_icc"), "t", {}).part().element));
  EXPECT_TRUE(std::holds_alternative<geometry::RoundCube>(
      design::parse_design(design::design_template("round_icc"), "t", {}).part().element));
}

/// Lines with a default value are commented out. They must be valid, and equal to the default, when their "#" is
/// removed.
TEST(InitTemplates, CommentedDefaultsAreValidAndTheDefaults) {
  for (const std::string_view kind : design::design_kinds()) {
    std::istringstream lines(design::design_template(kind));
    std::string text;
    int uncommented = 0;
    for (std::string line; std::getline(lines, line);) {
      const bool is_setting = line.substr(0, 2) == "# " && (line.find(" = ") != std::string::npos || line[2] == '[');
      const bool needs_more =
          line.find("refractive_index") != std::string::npos || line.find("absorption") != std::string::npos;
      uncommented += is_setting ? 1 : 0;
      text += (is_setting && !needs_more ? line.substr(2) : line) + "\n";
    }
    EXPECT_GT(uncommented, 5);
    EXPECT_NO_THROW(design::parse_design(text, "t.toml", {})) << text;
  }
}

TEST(InitTemplates, UnknownKindIsRefused) {
  try {
    design::design_template("cube");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(recorded_place_of(error), "refused");
  }
}

}  // namespace
}  // namespace retrace::studies::init_templates_test
