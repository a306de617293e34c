#include "design/io/design_labels.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "design/io/design_reader.h"
#include "design/io/init_templates.h"

namespace retrace::studies::design_labels_test {
namespace {

using Texts = std::vector<std::string>;

design::Design design_in(const std::string& file, const Texts& overrides, const std::string& kind = "rtp") {
  return design::parse_design(design::design_template(kind), file, overrides);
}

Texts names(const std::vector<design::Design>& designs) {
  return design::design_labels(designs).names;
}

TEST(DesignLabels, NameTheKeysThatDiffer) {
  EXPECT_EQ(names({design_in("a.toml", {"body.material=PMMA"}), design_in("b.toml", {"body.material=PC"})}),
            (Texts{"material = PMMA", "material = PC"}));
  EXPECT_EQ(names({design_in("a.toml", {"element.base_mm=1", "element.width_mm=2", "title=One"}),
                   design_in("a.toml", {"element.base_mm=1", "element.width_mm=3", "title=Two"})}),
            (Texts{"element.width_mm = 2", "element.width_mm = 3"}));
}

TEST(DesignLabels, HaveTheValuesOfASingleNumericKey) {
  const auto labels = design::design_labels(
      std::vector{design_in("a.toml", {"body.thickness_mm=2"}), design_in("a.toml", {"body.thickness_mm=3.5"})});
  EXPECT_EQ(labels.key, "thickness_mm");
  EXPECT_EQ(labels.values, (std::vector{2.0, 3.5}));
  const auto words = design::design_labels(
      std::vector{design_in("a.toml", {"body.material=PMMA"}), design_in("a.toml", {"body.material=PC"})});
  EXPECT_EQ(words.key, "");
  EXPECT_TRUE(words.values.empty());
}

TEST(DesignLabels, TablesThatSomeDesignsLackAreNamedAsAWhole) {
  const Texts coated = {"coating.entrance=[{material=\"MgF2\", thickness_nm=100}]"};
  const Texts labels = names({design_in("a.toml", {}), design_in("a.toml", coated)});
  ASSERT_EQ(labels.size(), 2U);
  EXPECT_TRUE(labels[0].starts_with("without ")) << labels[0];
  EXPECT_TRUE(labels[1].starts_with("with ")) << labels[1];
}

TEST(DesignLabels, DesignsThatDifferMuchHaveTheNamesOfTheirFiles) {
  EXPECT_EQ(names({design_in("x/bricks.toml", {}), design_in("y/comb.toml", {}, "hexagonal_icc")}),
            (Texts{"bricks", "comb"}));
}

TEST(DesignLabels, DesignsOfOneFileAmongOthersAddWhatDiffers) {
  EXPECT_EQ(names({design_in("bricks.toml", {"body.thickness_mm=2"}), design_in("comb.toml", {}, "hexagonal_icc"),
                   design_in("bricks.toml", {"body.thickness_mm=3"})}),
            (Texts{"bricks, thickness_mm = 2", "comb", "bricks, thickness_mm = 3"}));
}

TEST(DesignLabels, EqualDesignsHaveNumbers) {
  const design::Design prisms = design_in("a.toml", {"body.thickness_mm=2"});
  const Texts equal = names({prisms, prisms});
  ASSERT_EQ(equal.size(), 2U);
  EXPECT_TRUE(equal[0].ends_with(" (1)")) << equal[0];
  EXPECT_TRUE(equal[1].ends_with(" (2)")) << equal[1];
  EXPECT_EQ(names({prisms, design_in("a.toml", {"body.thickness_mm=3"}), prisms}),
            (Texts{"thickness_mm = 2 (1)", "thickness_mm = 3", "thickness_mm = 2 (2)"}));
}

TEST(DesignLabels, OneDesignHasItsTitle) {
  EXPECT_EQ(names({design_in("a.toml", {"title=\"Bricks of PMMA\""})}), Texts{"Bricks of PMMA"});
}

}  // namespace
}  // namespace retrace::studies::design_labels_test
