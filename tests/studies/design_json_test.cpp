#include "design/io/design_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "design/io/design_reader.h"
#include "design/io/init_templates.h"

namespace retrace::studies::design_json_test {
namespace {

nlohmann::ordered_json quoted(const std::string& kind, const std::vector<std::string>& overrides) {
  return design::to_json(design::parse_design(design::design_template(kind), "d.toml", overrides));
}

TEST(DesignJson, PolarisationIsAWordOrStokesParameters) {
  const auto polarisation = [](const std::vector<std::string>& overrides) {
    return quoted("rtp", overrides)["light"]["polarisation"].dump();
  };
  EXPECT_EQ(polarisation({}), "\"unpolarised\"");
  EXPECT_EQ(polarisation({"light.polarisation=[2, 0, 0, 0]"}), "\"unpolarised\"");
  EXPECT_EQ(polarisation({"light.polarisation=right_circular"}), "\"right_circular\"");
  EXPECT_EQ(polarisation({"light.polarisation=left_circular"}), "\"left_circular\"");
  EXPECT_EQ(polarisation({"light.polarisation=linear"}), "[1.0,1.0,0.0,0.0]");
  EXPECT_EQ(polarisation({"light.polarisation=[2, 0, 1, 0]"}), "[1.0,0.0,0.5,0.0]");
}

TEST(DesignJson, AngleErrorsAreQuotedByKind) {
  const auto surface = [](const std::string& kind, const std::vector<std::string>& overrides) {
    return quoted(kind, overrides)["surface"].dump();
  };
  EXPECT_EQ(surface("rtp", {"surface.dihedral_error_arcmin=2", "surface.facet_tilt_arcmin=[0.5, -1]"}),
            R"({"dihedral_error_arcmin":2.0,"facet_tilt_arcmin":[0.5,-1.0]})");
  EXPECT_EQ(surface("hexagonal_icc", {"surface.dihedral_error_arcmin=2"}),
            R"({"dihedral_error_arcmin":[2.0,2.0,2.0],"facet_tilt_arcmin":[0.0,0.0,0.0]})");
}

TEST(DesignJson, EdgesAreQuotedWhereThereAreAny) {
  const auto surface = [](const std::vector<std::string>& overrides) {
    return quoted("triangular_icc", overrides)["surface"];
  };
  EXPECT_FALSE(surface({}).contains("edge_chords"));
  EXPECT_EQ(surface({"surface.root_radius_um=2", "surface.rim_chamfer_um=3"}).dump(),
            R"({"dihedral_error_arcmin":[0.0,0.0,0.0],"facet_tilt_arcmin":[0.0,0.0,0.0],"root_radius_um":2.0,)"
            R"("rim_chamfer_um":3.0,"edge_chords":16})");
  EXPECT_EQ(surface({"surface.root_chamfer_um=2", "surface.rim_radius_um=3", "surface.edge_chords=32"}).dump(),
            R"({"dihedral_error_arcmin":[0.0,0.0,0.0],"facet_tilt_arcmin":[0.0,0.0,0.0],"root_chamfer_um":2.0,)"
            R"("rim_radius_um":3.0,"edge_chords":32})");
}

TEST(DesignJson, CantIsQuoted) {
  const nlohmann::ordered_json element =
      quoted("hexagonal_icc", {"element.cant_deg=7", "element.cant_azimuth_deg=-90"})["element"];
  EXPECT_EQ(element["cant_deg"], 7.0);
  EXPECT_EQ(element["cant_azimuth_deg"], -90.0);
}

}  // namespace
}  // namespace retrace::studies::design_json_test
