// Tests of the keys of designs for facets: errors, textures, edges and scratches.
#include "design/io/design_reader.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "geometry/elements/element_cells.h"
#include "tests/studies/design_texts.h"
#include "tests/support/refusals.h"

namespace retrace::studies::design_surface_test {
namespace {

namespace fs = std::filesystem;
using geometry::AngleErrors;

TEST(DesignReader, HeightMapIsFoundFromTheDesignsFolder) {
  const std::string text = with_line(11, "[surface]\nheight_map = \"maps/m.gsf\"");
  const auto texture_of = [&](const std::string& source, const std::vector<std::string>& overrides = {}) {
    return std::get<design::HeightMapTexture>(design::parse_design(text, source, overrides).surface.texture);
  };
  const design::HeightMapTexture texture = texture_of("parts/d.toml");
  EXPECT_EQ(texture.name, "maps/m.gsf");
  EXPECT_EQ(texture.file, fs::path("parts/maps/m.gsf"));
  EXPECT_EQ(texture.horizontal_axis, design::HeightMapAxis::x);
  EXPECT_EQ(texture.form_degree, 1);
  EXPECT_EQ(texture_of("standard input").file, fs::path("maps/m.gsf"));
  const std::vector<std::string> overrides = {"surface.height_map=m.txt", "surface.height_map_horizontal_axis=y",
                                              "surface.height_map_form=poly3"};
  const design::HeightMapTexture other = texture_of("parts/d.toml", overrides);
  EXPECT_EQ(other.file, fs::path("m.txt")) << "as typed, from the working directory";
  EXPECT_EQ(other.horizontal_axis, design::HeightMapAxis::y);
  EXPECT_EQ(other.form_degree, 3);
}

TEST(DesignReader, HeightMapKeysAreChecked) {
  const auto said = [](const std::string& lines) { return complaint(with_line(11, "[surface]\n" + lines)); };
  expect_refusals(said, {{"model = \"height_map\"", "d.toml:11: surface.height_map"},
                         {"height_map = \"\"", "d.toml:12: surface.height_map"},
                         {"height_map = 3", "d.toml:12: surface.height_map"},
                         {"model = \"smooth\"\nheight_map = \"m.txt\"", "d.toml:13: surface.height_map"},
                         {"height_map_form = \"poly2\"", "d.toml:12: surface.height_map_form"},
                         {"model = \"height_map\"\nheight_map = \"m.txt\"\nwaviness_sq_nm = 5\nwaviness_length_um = 9",
                          "d.toml:14: surface.waviness_sq_nm"}});
  EXPECT_EQ(said("height_map = \"m.txt\"\nheight_map_horizontal_axis = \"z\""),
            "d.toml:13: surface.height_map_horizontal_axis");
  EXPECT_EQ(said("height_map = \"m.txt\"\nheight_map_form = \"none\""), "d.toml:13: surface.height_map_form");
}

TEST(DesignReader, PlanesOfSingleFacetsAreAFile) {
  const std::string text =
      "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\nx_length_mm = 1\ny_length_mm = 1\n"
      "[body]\nthickness_mm = 1\n[part]\nfacets = \"planes.csv\"\n";
  const design::Design design = design::parse_design(text, "folder/d.toml");
  ASSERT_TRUE(design.facet_planes());
  EXPECT_EQ(design.facet_planes()->name, "planes.csv");
  EXPECT_EQ(design.facet_planes()->file, std::filesystem::path("folder/planes.csv"));
  const auto refused = [&](const std::vector<std::string>& sets) {
    return refusal_of([&] { design::parse_design(text, "d.toml", sets); }, "accepted");
  };
  EXPECT_EQ(refused({"surface.facet_tilt_arcmin=[1,1]"}), "d.toml:11: part.facets");
  EXPECT_NE(refused({"surface.angle_error_sigma_arcmin=1"}), "accepted");
  EXPECT_NE(refused({"part.facets=3"}), "accepted");
  EXPECT_NE(refused({"part.facet=a.csv"}), "accepted");
}

TEST(DesignReader, CantIsReadForCubeCornersAlone) {
  const auto read = [](const std::string& element, const std::vector<std::string>& overrides) {
    return design::parse_design(design_of(element, "extent = \"infinite\""), "d", overrides).part();
  };
  const auto refused = [&](const std::string& element, const std::vector<std::string>& overrides) -> std::string {
    return refusal_of([&] { read(element, overrides); });
  };
  for (const std::string& cube : {kHexagonal, kTriangular}) {
    const std::string azimuth = "element.cant_azimuth_deg=-90";
    const geometry::Cant cant =
        geometry::cant_of(read(cube, {"element.cant_deg=7.5", azimuth, "body.thickness_mm=9"}).element);
    EXPECT_EQ(cant.deg, 7.5);
    EXPECT_EQ(cant.azimuth_deg, -90.0);
    EXPECT_EQ(geometry::cant_of(read(cube, {}).element).deg, 0.0);
    EXPECT_EQ(refused(cube, {"element.cant_deg=31"}), "--set element.cant_deg=31: element.cant_deg");
    EXPECT_EQ(refused(cube, {"element.cant_azimuth_deg=361"}),
              "--set element.cant_azimuth_deg=361: element.cant_azimuth_deg");
    EXPECT_EQ(refused(cube, {"element.cant_deg=30", "surface.facet_tilt_arcmin=[0, -300, 0]"}),
              "--set surface.facet_tilt_arcmin=[0, -300, 0]: surface.facet_tilt_arcmin");
    EXPECT_EQ(refused(cube, {"element.cant_deg=20", "body.thickness_mm=1e-3"}),
              "--set body.thickness_mm=1e-3: body.thickness_mm");
  }
  for (const std::string key : {"element.cant_deg", "element.cant_azimuth_deg"}) {
    EXPECT_EQ(refused(kRtp, {key + "=2"}), "--set " + key + "=2: " + key);
    EXPECT_EQ(refused(kRtp, {key + "=0"}), "");
  }
}

TEST(DesignReader, AngleErrorsAreReadForEveryKind) {
  const auto errors = [](const std::string& element, const std::vector<std::string>& overrides) {
    return design::parse_design(design_of(element, "extent = \"infinite\""), "d", overrides).part().angle_errors;
  };
  EXPECT_EQ(errors(kRtp, {"surface.dihedral_error_arcmin=2"}), (AngleErrors{{2.0, 0.0, 0.0}, {}}));
  EXPECT_EQ(errors(kRtp, {"surface.facet_tilt_arcmin=[2, -300]"}), (AngleErrors{{}, {2.0, -300.0, 0.0}}));
  for (const std::string& cube : {kHexagonal, kTriangular}) {
    EXPECT_EQ(errors(cube, {"surface.dihedral_error_arcmin=-2"}), (AngleErrors{{-2.0, -2.0, -2.0}, {}}));
    EXPECT_EQ(errors(cube, {"surface.dihedral_error_arcmin=[3]"}), (AngleErrors{{3.0, 3.0, 3.0}, {}}));
    EXPECT_EQ(errors(cube, {"surface.dihedral_error_arcmin=[1, -2, 0.5]", "surface.facet_tilt_arcmin=[4, 5, 6]"}),
              (AngleErrors{{1.0, -2.0, 0.5}, {4.0, 5.0, 6.0}}));
    EXPECT_EQ(errors(cube, {"surface.facet_tilt_arcmin=0"}), AngleErrors{});
  }
}

TEST(DesignReader, RandomTiltsNeedAFiniteArray) {
  const std::string key = "surface.angle_error_sigma_arcmin";
  const design::Design design =
      design::parse_design(design_of(kHexagonal, "x_length_mm = 10\ny_length_mm = 10"), "d",
                           std::vector<std::string>{key + "=1.5", "surface.angle_error_seed=7"});
  EXPECT_EQ(design.part().random_tilts.sigma_arcmin, 1.5);
  EXPECT_EQ(design.part().random_tilts.seed, 7U);
  EXPECT_EQ(set_complaint({key + "=-1"}), "--set " + key + "=-1: " + key);
  EXPECT_EQ(set_complaint({"surface.angle_error_seed=1.5"}),
            "--set surface.angle_error_seed=1.5: surface.angle_error_seed");
  EXPECT_EQ(complaint(design_of(kRtp, "extent = \"infinite\"") + "[surface]\nangle_error_sigma_arcmin = 1"),
            "d.toml:10: surface.angle_error_sigma_arcmin");
}

TEST(DesignReader, TexturesOfFacetsAreRead) {
  const auto surface = [](const std::vector<std::string>& overrides) {
    return design::parse_design(design_of(kRtp, "extent = \"infinite\""), "d", overrides).surface;
  };
  const design::SurfaceFinish texture =
      surface({"surface.roughness_sq_nm=5", "surface.correlation_length_um=2"}).texture;
  const auto* const rough = std::get_if<design::HarveyShackTexture>(&texture);
  ASSERT_NE(rough, nullptr) << "usual for a roughness";
  EXPECT_EQ(rough->roughness_sq_nm, 5.0);
  EXPECT_EQ(rough->correlation_length_um, 2.0);
  EXPECT_TRUE(surface({"surface.roughness_sq_nm=0"}).is_smooth());
  EXPECT_TRUE(surface({"surface.model=harvey_shack"}).is_smooth()) << "0 is the smooth answer";
  EXPECT_EQ(std::get<design::AbgTexture>(
                surface({"surface.model=abg", "surface.abg_a=1e-4", "surface.abg_b=1e-4", "surface.abg_g=2"}).texture)
                .g,
            2.0);
  EXPECT_TRUE(
      std::get<design::MicrofacetTexture>(surface({"surface.model=microfacet", "surface.waviness_sq_nm=300",
                                                   "surface.waviness_length_um=80", "surface.slope_distribution=ggx"})
                                              .texture)
          .ggx);
  EXPECT_TRUE(surface({"surface.walls=absorbing"}).absorbing_walls);
}

TEST(DesignReader, TexturesThatSayTooLittleOrTooMuchAreRefused) {
  const auto refused = [](const std::vector<std::string>& overrides) { return set_complaint(overrides); };
  EXPECT_EQ(refused({"surface.model=abg", "surface.abg_a=1e300", "surface.abg_b=1e-4", "surface.abg_g=2"}),
            "--set surface.abg_a=1e300: surface.abg_a");
  EXPECT_EQ(refused({"surface.model=abg", "surface.abg_a=1", "surface.abg_b=1e-4", "surface.abg_g=1e-300"}),
            "--set surface.abg_g=1e-300: surface.abg_g");
  EXPECT_EQ(refused({"surface.roughness_sq_nm=5"}), "d.toml: surface.correlation_length_um");
  EXPECT_EQ(refused({"surface.waviness_sq_nm=5"}), "d.toml: surface.waviness_length_um");
  EXPECT_EQ(refused({"surface.roughness_sq_nm=-1"}), "--set surface.roughness_sq_nm=-1: surface.roughness_sq_nm");
  EXPECT_EQ(refused({"surface.roughness_sq_nm=rough"}), "--set surface.roughness_sq_nm=rough: surface.roughness_sq_nm");
  EXPECT_EQ(refused({"surface.model=matt"}), "--set surface.model=matt: surface.model");
  EXPECT_EQ(refused({"surface.model=abg"}), "d.toml: surface.abg_a");
  EXPECT_EQ(refused({"surface.abg_a=1"}), "--set surface.abg_a=1: surface.abg_a");
  EXPECT_EQ(refused({"surface.slope_distribution=ggx"}),
            "--set surface.slope_distribution=ggx: surface.slope_distribution");
  EXPECT_EQ(refused({"surface.model=smooth", "surface.roughness_sq_nm=5", "surface.correlation_length_um=2"}),
            "--set surface.roughness_sq_nm=5: surface.roughness_sq_nm");
  EXPECT_EQ(refused({"surface.walls=rough"}), "--set surface.walls=rough: surface.walls");
}

TEST(DesignReader, EdgesMustFitIntoTheFacets) {
  const design::Design design =
      design::parse_design(design_of(kRtp, "extent = \"infinite\""), "d",
                           std::vector<std::string>{"surface.root_radius_um=5", "surface.rim_radius_um=2"});
  EXPECT_EQ(design.part().edges, (geometry::EdgeShape{5e-3, 0.0, 2e-3}));
  for (const std::string key :
       {"surface.root_radius_um", "surface.root_chamfer_um", "surface.rim_radius_um", "surface.rim_chamfer_um"})
    for (const std::string value : {"-1", "1e6", "nan", "wide"})
      EXPECT_EQ(set_complaint({key + "=" + value}), "--set " + key + "=" + value + ": " + key);
  EXPECT_EQ(set_complaint({"surface.root_radius_um=1", "surface.root_chamfer_um=1"}),
            "--set surface.root_chamfer_um=1: surface.root_chamfer_um");
  EXPECT_EQ(set_complaint({"surface.rim_radius_um=1", "surface.rim_chamfer_um=1"}),
            "--set surface.rim_chamfer_um=1: surface.rim_chamfer_um");
  for (const std::string value : {"2", "66", "7", "8.5", "-8"})
    EXPECT_EQ(set_complaint({"surface.edge_chords=" + value}),
              "--set surface.edge_chords=" + value + ": surface.edge_chords");
}

TEST(DesignReader, ScratchesAreThoseOfPrisms) {
  const std::string good = "facet = \"-x\", position_um = 40, width_um = 3, depth_um = 0.5";
  const auto with = [](const std::string& element, const std::string& list) {
    return design_of(element, "extent = \"infinite\"") + "[surface]\nscratches = " + list + "\n";
  };
  const std::string other = "{ facet = \"+x\", position_um = 40, width_um = 3, depth_um = -0.5 }";
  const design::Design design = design::parse_design(with(kRtp, "[{ " + good + " }, " + other + "]"), "d.toml", {});
  ASSERT_EQ(design.part().scratches.size(), 2U);
  EXPECT_EQ(design.part().scratches[0].facet, 0U);
  EXPECT_DOUBLE_EQ(design.part().scratches[0].position_mm, 0.04);
  EXPECT_EQ(design.part().scratches[1].facet, 1U);
  EXPECT_DOUBLE_EQ(design.part().scratches[1].depth_mm, -5e-4);
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string entry = good;
    return complaint(with(kRtp, "[{ " + entry.replace(entry.find(from), from.size(), to) + " }]"));
  };
  EXPECT_EQ(refused("-x", "y"), "d.toml:10: surface.scratches[1].facet");
  EXPECT_EQ(refused("40", "600"), "d.toml:10: surface.scratches[1].position_um");
  EXPECT_EQ(refused("3,", "0,"), "d.toml:10: surface.scratches[1].width_um");
  EXPECT_EQ(refused("0.5", "1.6"), "d.toml:10: surface.scratches[1].depth_um");
  EXPECT_EQ(refused(", depth_um = 0.5", ""), "d.toml:10: surface.scratches[1].depth_um");
  EXPECT_EQ(complaint(with(kRtp, "[{ " + good + " }, { " + good + " }]")),
            "d.toml:10: surface.scratches[2].position_um");
  EXPECT_EQ(complaint(with(kRtp, "3")), "d.toml:10: surface.scratches");
  EXPECT_EQ(complaint(with(kHexagonal, "[{ " + good + " }]")), "d.toml:9: surface.scratches");
}

TEST(DesignReader, RimsOfEveryKindAndWhatTheyNeed) {
  const auto rims = [](const std::string& element, const std::string& array, const std::string& lines) {
    return design::parse_design(design_of(element, array) + "[surface]\n" + lines, "d.toml", {}).part().edges;
  };
  EXPECT_EQ(rims(kHexagonal, "extent = \"infinite\"", "rim_radius_um = 1"), (geometry::EdgeShape{0.0, 0.0, 1e-3}));
  EXPECT_EQ(rims(kTriangular, "extent = \"infinite\"", "rim_chamfer_um = 2\nedge_chords = 8"),
            (geometry::EdgeShape{0.0, 0.0, 0.0, 2e-3, 8}));
  const std::string apart = "extent = \"infinite\"\nx_gap_mm = 0.01";
  EXPECT_EQ(rims(kRtp, apart, "rim_radius_um = 12"), (geometry::EdgeShape{0.0, 0.0, 12e-3}));
  // tan(22.5 degrees) 20 um on either side
  EXPECT_EQ(complaint(design_of(kRtp, apart) + "[surface]\nrim_radius_um = 20"), "d.toml:11: surface.rim_radius_um");
  EXPECT_EQ(complaint(design_of(kRtp, apart) + "[surface]\nrim_chamfer_um = 20"), "d.toml:11: surface.rim_chamfer_um");
  EXPECT_EQ(complaint(design_of(kRtp, "arrangement = \"checker\"\nextent = \"infinite\"\ny_gap_mm = 0.001") +
                      "[surface]\nrim_radius_um = 20"),
            "d.toml:12: surface.rim_radius_um");
}

TEST(DesignReader, AngleErrorsThatDoNotFitAreRefused) {
  const auto refused = [](const std::string& element, const std::string& line) {
    return complaint(design_of(element, "extent = \"infinite\"") + "[surface]\n" + line);
  };
  EXPECT_EQ(refused(kRtp, "dihedral_error_arcmin = [1, 2, 3]"), "d.toml:10: surface.dihedral_error_arcmin");
  EXPECT_EQ(refused(kRtp, "dihedral_error_arcmin = 301"), "d.toml:10: surface.dihedral_error_arcmin");
  EXPECT_EQ(refused(kHexagonal, "dihedral_error_arcmin = [1, -301, 0]"), "d.toml:9: surface.dihedral_error_arcmin");
  EXPECT_EQ(refused(kHexagonal, "dihedral_error_arcmin = [1, 2]"), "d.toml:9: surface.dihedral_error_arcmin");
  EXPECT_EQ(refused(kHexagonal, "dihedral_error_arcmin = \"1\""), "d.toml:9: surface.dihedral_error_arcmin");
  EXPECT_EQ(refused(kRtp, "facet_tilt_arcmin = [1, 2, 3]"), "d.toml:10: surface.facet_tilt_arcmin");
  EXPECT_EQ(refused(kTriangular, "facet_tilt_arcmin = [1, 2]"), "d.toml:9: surface.facet_tilt_arcmin");
  EXPECT_EQ(refused(kTriangular, "facet_tilt_arcmin = 1"), "d.toml:9: surface.facet_tilt_arcmin");
  EXPECT_EQ(refused(kTriangular, "facet_tilt_arcmin = [1, nan, 2]"), "d.toml:9: surface.facet_tilt_arcmin");
  EXPECT_EQ(refused(kRtp + "; apex_angle_deg = 119", "facet_tilt_arcmin = [30, 31]"),
            "d.toml:11: surface.facet_tilt_arcmin");
  EXPECT_EQ(refused(kRtp + "; apex_angle_deg = 61", "facet_tilt_arcmin = [-30, -30]\ndihedral_error_arcmin = -60"),
            "d.toml:12: surface.dihedral_error_arcmin");
  EXPECT_EQ(refused(kRtp + "; apex_angle_deg = 120", "facet_tilt_arcmin = [7, -7]"), "");
  EXPECT_EQ(set_complaint({"surface.facet_tilt_arcmin=[1]"}),
            "--set surface.facet_tilt_arcmin=[1]: surface.facet_tilt_arcmin");
}

TEST(DesignReader, PlateMustBeThickerThanRimsStand) {
  const std::vector<std::string> errors = {"surface.facet_tilt_arcmin=[-60, 60]"};
  EXPECT_EQ(complaint(with_line(10, "thickness_mm = 0.001"), errors).substr(0, 46), "d.toml:10: body.thickness_mm");
  EXPECT_EQ(complaint(with_line(10, "thickness_mm = 0.01"), errors), "");
  EXPECT_EQ(complaint(with_line(10, "thickness_mm = 1e-6")), "");
}

}  // namespace
}  // namespace retrace::studies::design_surface_test
