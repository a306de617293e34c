// Tests of designs with zones, which are regions with elements of their own kind: reading, refused values, writing,
// inspection, and the returned light.

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "design/file_names.h"
#include "design/io/design_document.h"
#include "design/io/design_json.h"
#include "design/part_of_design.h"
#include "materials/io/material_library.h"
#include "studies/inspect/inspect.h"
#include "studies/inspect/io/inspect_files.h"
#include "studies/photometry/photometry.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/rre/rre.h"
#include "studies/scene/scene.h"
#include "studies/solids/solids.h"
#include "studies/sweep/io/sweep_reader.h"
#include "studies/sweep/sweep.h"
#include "tests/studies/design_texts.h"

namespace retrace::studies::zones_test {
namespace {

const std::string kHalves = "[[zone]]\narea_fraction = 0.5\n[[zone]]\narea_fraction = 0.5\n";

std::string zoned(const std::string& zones, const std::string& element = kHexagonal,
                  const std::string& array = "x_length_mm = 20; y_length_mm = 10") {
  return design_of(element, array) + zones;  // zones start at line 9
}

design::Design read(const std::string& zones, const std::string& element = kHexagonal,
                    const std::string& array = "x_length_mm = 20; y_length_mm = 10") {
  return design::parse_design(zoned(zones, element, array), "d.toml");
}

TEST(ZonedDesign, WhatIsWrongIsRefusedWithItsPlace) {
  const auto refused = [](const std::string& zones) { return complaint(zoned(zones)); };
  const std::string half = "[[zone]]\narea_fraction = 0.5\n";
  expect_refusals(
      refused,
      {{kHalves, ""},
       {"[[zone]]\n", "d.toml:9: zone[1]"},
       {"[[zone]]\narea_fraction = 0.5\npolygon_mm = [[0, 0], [1, 0], [0, 1]]\n", "d.toml:11: zone[1].polygon_mm"},
       {half, "d.toml:10: zone[1].area_fraction"},
       {half + "[[zone]]\narea_fraction = 0\n", "d.toml:12: zone[2].area_fraction"},
       {half + "[[zone]]\nrectangles_mm = [[10, 0, 20, 10]]\n", "d.toml:11: zone[2]"},
       {"[[zone]]\nrectangles_mm = [[10, 0, 20, 10]]\n" + half, "d.toml:9: zone[1]"},
       {"[[zone]]\nrectangles_mm = [[0, 0, 20, 9]]\n", "d.toml:9: zone[1]"},
       {"[[zone]]\nrectangles_mm = [[0, 0, 20, 11]]\n", "d.toml:9: zone[1]"},
       {"[[zone]]\nrectangles_mm = [[0, 0, 12, 10]]\n[[zone]]\nrectangles_mm = [[10, 0, 20, 10]]\n",
        "d.toml:11: zone[2]"},
       {"[[zone]]\nrectangles_mm = [[0, 0, 0, 10]]\n", "d.toml:10: zone[1].rectangles_mm"},
       {"[[zone]]\npolygon_mm = [[0, 0], [20, 0], [5, 4], [0, 10]]\n", "d.toml:10: zone[1].polygon_mm"},
       {half + half.substr(0, 8) + " \narea_fraction = 0.5\nrotation_deg = 400\n", "d.toml:13: zone[2].rotation_deg"},
       {half + half + "set = [\"element.cant_deg\"]\n", "d.toml:13: zone[2].set"},
       {half + half + "set = [\"body.thickness_mm=2\"]\n", "d.toml:13: zone[2].set"},
       {half + half + "set = [\"element.cant_deg=50\"]\n", "d.toml:13: zone[2].set"},
       {half + half + "set = [\"element.cant=5\"]\n", "d.toml:13: zone[2].set"},
       {half + half + "set = [\"surface.dihedral_error_arcmin=[1, 2]\"]\n", "d.toml:13: zone[2].set"},
       {half + half + "set = [\"array.arrangement='single'\"]\n", "d.toml:13: zone[2].set"},
       {half + half + "set = [\"element.aperture_mm=11\"]\n", "d.toml:11: zone[2]"},
       {"[[zone]]\npolygon_mm = [[0, 0], [20, 0], [20, 10], [0, 10], [0, 0]]\n", "d.toml:10: zone[1].polygon_mm"},
       {"[[zone]]\npolygon_mm = [[0, 0], [20, 0], [20, 10], [0, 10], [0, 0], [20, 0], [20, 10], [0, 10]]\n",
        "d.toml:10: zone[1].polygon_mm"},
       {"[[zone]]\narea_fraction = 0.9999\n[[zone]]\narea_fraction = 0.0001\nrotation_deg = 17\n",
        "d.toml:11: zone[2]"},
       {kHalves + "[substrate]\nkind = \"sphere\"\nradius_mm = 100\n", "d.toml:9: zone"},
       {kHalves + "[form]\nsink_um = 1\n", "d.toml:9: zone"},
       {kHalves + "[wet_back]\nindex = 1.3\nfraction = 0.5\n", "d.toml:9: zone"}});
}

TEST(ZonedDesign, ZonesOfSingleElementsAreRefusedWithTheirPlaceToo) {
  const auto refused = [](const std::string& zones) { return complaint(zoned(zones)); };
  const std::string odd = "[[zone]]\nrows = 1\nevery = 2\n";
  const std::string rest = "[[zone]]\nrest = true\n";
  expect_refusals(refused, {{odd + rest, ""},
                            {odd + "[[zone]]\nrows = 2\nevery = 2\n", ""},
                            {"[[zone]]\ncolumns = [1, 3]\n" + rest, ""},
                            {odd, "d.toml:9: zone[1]"},
                            {odd + odd, "d.toml:12: zone[2]"},
                            {odd + rest + rest, "d.toml:15: zone[3].rest"},
                            {odd + "[[zone]]\nrest = false\n", "d.toml:13: zone[2].rest"},
                            {odd + kHalves, "d.toml:12: zone[2]"},
                            {"[[zone]]\narea_fraction = 0.5\n" + rest, "d.toml:11: zone[2]"},
                            {"[[zone]]\nrows = 1.5\n" + rest, "d.toml:10: zone[1].rows"},
                            {"[[zone]]\nrows = 0\n" + rest, "d.toml:10: zone[1].rows"},
                            {"[[zone]]\nrows = [2, 99]\n" + rest, "d.toml:10: zone[1].rows"},
                            {"[[zone]]\nrows = 3\nevery = 2\n" + rest, "d.toml:10: zone[1].rows"},
                            {"[[zone]]\nrest = true\nevery = 2\n", "d.toml:11: zone[1].every"},
                            {odd + rest + "rotation_deg = 30\n", "d.toml:14: zone[2].rotation_deg"},
                            {odd + rest + "rotation_deg = -120\n", ""},
                            {odd + rest + "set = [\"element.aperture_mm=1\"]\n", "d.toml:14: zone[2].set"},
                            {odd + "set = [\"element.aperture_mm=1\"]\n" + rest, "d.toml:12: zone[1].set"},
                            {"[[zone]]\nrows = 2000\nevery = 9000\n" + rest, "d.toml:9: zone[1]"},
                            {odd + "[[zone]]\nrows = 2\nevery = 2\n" + rest, "d.toml:15: zone[3]"},
                            {odd + rest + "set = [\"element.aperture_mm=30\"]\n", "d.toml:14: zone[2].set"}});
}

TEST(ZonedDesign, WholePartsAreFiniteWithoutMargins) {
  const auto refused = [](const std::string& array) { return complaint(zoned(kHalves, kHexagonal, array)); };
  EXPECT_EQ(refused("extent = \"infinite\""), "d.toml:5: array.extent");
  EXPECT_EQ(refused("x_length_mm = 20; y_length_mm = 10; y_offset_mm = 1"), "d.toml:7: array.y_offset_mm");
  EXPECT_EQ(complaint("[element]\nkind = \"ball\"\ndiameter_mm = 1\n" + kHalves), "d.toml:4: zone");
}

TEST(ZonedDesign, AnEmptyListIsNone) {
  EXPECT_EQ(design::parse_design("zone = []\n" + joined(kLines), "d.toml").zoned(), nullptr);
}

TEST(ZonedDesign, DesignsAreWrittenAsTheyWereRead) {
  const design::Design design = read(
      "[[zone]]\narea_fraction = 0.25\nrotation_deg = 30\n[[zone]]\narea_fraction = 0.75\n"
      "set = [\"element.cant_deg=5\", \"surface.dihedral_error_arcmin=[1, 2, 3]\"]\n");
  const std::string text = design::design_text(design);
  EXPECT_NE(text.find("[[zone]]\nrectangles_mm = [[0, 0, 5, 10]]\nrotation_deg = 30\n"), std::string::npos) << text;
  const design::Design again = design::parse_design(text, "again.toml");
  EXPECT_EQ(design::design_text(again), text);
  const design::ZonedPart& part = *again.zoned();
  ASSERT_EQ(part.spec.zones.size(), 2U);
  EXPECT_EQ(geometry::cant_of(part.spec.zones[1].elements.element).deg, 5.0);
  EXPECT_EQ(geometry::cant_of(part.spec.zones[0].elements.element).deg, 0.0);
  EXPECT_EQ(part.spec.zones[1].elements.angle_errors.dihedral_error_arcmin[2], 3.0);
  EXPECT_EQ(design::design_text(design_of_json(design::to_json(design))), text);
  const design::Design thicker = design::with(design, std::vector<std::string>{"body.thickness_mm=3"});
  EXPECT_EQ(thicker.zoned()->spec.thickness_mm, 3.0);
}

TEST(ZonedDesign, TheSameKindKeepsWhatTheDesignSays) {
  const auto aperture_mm = [](const std::string& kind) {
    const design::Design design = read("[[zone]]\narea_fraction = 0.5\nset = [" + kind +
                                       ", \"array.partial_elements=omit\"]\n" + "[[zone]]\narea_fraction = 0.5\n");
    const geometry::Element& element = design.zoned()->spec.zones[0].elements.element;
    return geometry::bounding_box(geometry::aperture_outline(element)).size().maxCoeff();
  };
  const double of_design =
      geometry::bounding_box(geometry::aperture_outline(read(kHalves).zoned()->spec.zones[1].elements.element))
          .size()
          .maxCoeff();
  for (const std::string kind :
       {"'element.kind = \"hexagonal_icc\" '", "\"element.kind='hexagonal_icc'\"", "\"element.kind=hexagonal_icc\""})
    EXPECT_EQ(aperture_mm(kind), of_design) << kind;
  EXPECT_EQ(refusal_of([&] { aperture_mm("'element.kind=\"triangular_icc\"'"); }), "d.toml:11: zone[1].set");
}

TEST(ZonedDesign, ZonesOfSingleElementsAreWrittenAsTheyWereRead) {
  const design::Design design = read(
      "[[zone]]\nrows = [1, 2]\nevery = 3\n[[zone]]\nrest = true\nrotation_deg = 180\n"
      "set = [\"element.cant_deg=5\"]\n");
  const std::string text = design::design_text(design);
  EXPECT_NE(text.find("[[zone]]\nrows = [1, 2]\nevery = 3\n"), std::string::npos) << text;
  EXPECT_NE(text.find("[[zone]]\nrest = true\nrotation_deg = 180\n"), std::string::npos) << text;
  EXPECT_EQ(design::design_text(design::parse_design(text, "again.toml")), text);
  EXPECT_EQ(design::design_text(design_of_json(design::to_json(design))), text);
}

/// A temporary folder with mask images in PGM format. The images have dark and light halves.
class MaskFolder {
 public:
  MaskFolder() {
    std::filesystem::create_directories(path_);
    std::ofstream(path_ / "left.pgm") << "P2 2 1 255\n0 255\n";
    std::ofstream(path_ / "right.pgm") << "P2 2 1 255\n255 0\n";
    std::ofstream(path_ / "above.pgm") << "P2 1 2 255\n0 255\n";
    std::ofstream(path_ / "light.pgm") << "P2 1 2 255\n200 255\n";
    std::ofstream(path_ / "short.pgm") << "P2 2 2 255\n0 255\n";
    std::ofstream(path_ / "negative.pgm") << "P2 -3 4 255\n0 255\n";
    std::ofstream corner(path_ / "corner.pgm");
    corner << "P2 80 40 255\n0\n";
    for (int pixel = 1; pixel < 80 * 40; ++pixel) corner << "255\n";
  }
  ~MaskFolder() { std::filesystem::remove_all(path_); }
  MaskFolder(const MaskFolder&) = delete;
  MaskFolder& operator=(const MaskFolder&) = delete;

  design::Design design(const std::string& zones) const {
    return design::parse_design(zoned(zones), (path_ / "d.toml").string());
  }
  std::string complaint_of(const std::string& zones) const {
    return refusal_of([&] { design::part_of_design(design(zones), nullptr); });
  }

 private:
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / ("retrace_masks_" + std::to_string(::getpid()));
};

TEST(ZonedDesign, MasksChooseTheElementsUnderTheirDarkPixels) {
  const MaskFolder folder;
  const auto zones = [&](const std::string& text) {
    return design::part_of_design(folder.design(text), nullptr).zones;
  };
  const std::string rest = "[[zone]]\nrest = true\nrotation_deg = 180\n";
  const auto left = zones("[[zone]]\nmask = \"left.pgm\"\n" + rest);
  const auto right = zones("[[zone]]\nmask = \"left.pgm\"\n[[zone]]\nmask = \"right.pgm\"\n");
  // The masks select whole columns of elements. The column in the center of the part belongs to the right half.
  EXPECT_NEAR(left[0].area_mm2, 100.0, 10.0);
  EXPECT_NEAR(left[0].area_mm2 + left[1].area_mm2, 200.0, 1e-9);
  EXPECT_EQ(right[0].full, left[0].full);
  EXPECT_EQ(right[1].full, left[1].full);
  const auto above = zones("[[zone]]\nmask = \"above.pgm\"\n" + rest);
  EXPECT_NEAR(above[0].area_mm2, 100.0, 10.0);
  const geometry::Part part = design::part_of_design(folder.design("[[zone]]\nmask = \"above.pgm\"\n" + rest), nullptr);
  const geometry::PatchCell& last = part.patches[0].cells[part.zones[0].cells - 1];
  EXPECT_GT(0.5 * (last.lower.y() + last.upper.y()), 5.0);
}

TEST(ZonedDesign, MasksThatDoNotServeAreRefused) {
  const MaskFolder folder;
  const auto refused = [&](const std::string& zones) { return folder.complaint_of(zones); };
  const std::string left = "[[zone]]\nmask = \"left.pgm\"\n";
  EXPECT_EQ(refused(left), "TMP/d.toml:9: zone[1]");
  EXPECT_EQ(refused(left + left), "TMP/d.toml:11: zone[2]");
  EXPECT_EQ(refused("[[zone]]\nmask = \"light.pgm\"\n"), "TMP/d.toml:10: zone[1].mask");
  EXPECT_EQ(refused("[[zone]]\nmask = \"short.pgm\"\n"), "TMP/d.toml:10: zone[1].mask");
  EXPECT_EQ(refused("[[zone]]\nmask = \"negative.pgm\"\n"), "TMP/d.toml:10: zone[1].mask");
  EXPECT_EQ(refused("[[zone]]\nmask = \"corner.pgm\"\n[[zone]]\nrest = true\n"), "TMP/d.toml:9: zone[1]");
  EXPECT_EQ(refused("[[zone]]\nmask = \"none.pgm\"\n"), "TMP/d.toml:10: zone[1].mask");
  EXPECT_EQ(refusal_of([&] { design::require_no_files(folder.design(left), "which nobody reads"); }),
            "TMP/d.toml:10: zone[1].mask");
}

TEST(ZonedDesign, QuestionsOfOneKindOfElementAreRefused) {
  const design::Design design = read(kHalves);
  RreSettings footprint;
  footprint.derivatives = true;
  EXPECT_EQ(refusal_of([&] { RreStudy({design}, footprint); }), "d.toml:9: zone");
}

TEST(ZonedDesign, StudiesVaryWhatIsAllOverThePart) {
  const auto swept = [](const std::string& quantity) {
    const Sweep sweep =
        read_sweep(parse_study("design = \"d.toml\"\n[[parameter]]\nkey = \"body.thickness_mm\"\nvalues = [2, 3]\n"
                               "[[quantity]]\nkind = \"" +
                                   quantity + "\"\n[analysis]\nengine = \"exact\"\n",
                               "study.toml", {}, 1, {{"d.toml", zoned(kHalves)}}));
    compute::ResultStore store("", sweep.layout(), compute::IfExists::refuse);
    EXPECT_TRUE(run_sweep(sweep, store, nullptr, nullptr));
    return collect(sweep, store, true).points;
  };
  const auto shares = swept("rre");
  for (std::size_t k = 0; k < 2; ++k) {
    const design::Design design =
        design::with(read(kHalves), std::vector<std::string>{k == 0 ? "body.thickness_mm=2" : "body.thickness_mm=3"});
    RreSettings request;
    request.engine = raytrace::Engine::exact;
    ASSERT_FALSE(shares.at(k).failed) << shares[k].reason;
    EXPECT_EQ(shares[k].outputs.at(0).value, RreStudy({design}, request).run().points.at(0).rre);
  }
  EXPECT_EQ(swept("entrance_area_mm2").at(0).outputs.at(0).value, 200.0);
  EXPECT_EQ(recorded_place_of(swept("tir_limit_deg").at(0).reason), "d.toml:9: zone");
}

RreResult rre(const design::Design& design, raytrace::Engine engine, double incidence_deg,
              std::optional<std::uint64_t> rays = {}) {
  RreSettings request;
  request.incidence_deg = {incidence_deg};
  request.azimuth_deg = {30.0};
  request.engine = engine;
  request.rays = rays;
  if (engine == raytrace::Engine::exact) request.cutoff = 1e-5;
  return RreStudy({design}, request).run();
}

// The border between the zones cuts no prism, and light along the normal stays within its prism. The RRE must therefore
// equal that of a part without zones.
TEST(ZonedDesign, PrismsTurnedInAZoneReturnWhatTheyDoAlone) {
  const std::string lengths = "x_length_mm = 8; y_length_mm = 4";
  const design::Design plain = design::parse_design(design_of(kRtp, lengths), "d.toml");
  const design::Design turned =
      read("[[zone]]\narea_fraction = 0.5\n[[zone]]\narea_fraction = 0.5\nrotation_deg = 90\n", kRtp, lengths);
  EXPECT_NEAR(rre(turned, raytrace::Engine::exact, 0.0).points[0].rre,
              rre(plain, raytrace::Engine::exact, 0.0).points[0].rre, 1e-9);
  const Inspection inspection = inspect(turned, materials::MaterialLibrary::shipped());
  EXPECT_EQ(inspection.elements_full, 32);
  EXPECT_EQ(inspection.zones->crossings[0].fraction, 0.0);
  // Light leaves a prism on the other side of the roof edge, at the same distance from it. It has moved by twice this
  // distance, and the mean of this movement is half of the base.
  for (const ZoneReport& zone : inspection.zones->zones) EXPECT_NEAR(zone.lateral_shift_mm.value(), 0.5, 0.01);
}

// A part has two zones of equal size with different cube corners, and light is at oblique incidence. The exact engine
// and Embree agree on its RRE. This RRE is nearly the mean of the RREs of two parts, each with the cube corners of one
// zone. The difference arises at the borders.
TEST(ZonedDesign, TheSumOfZonesIsThePartAsFarAsTheyAreWide) {
  const std::string set = "set = [\"element.cant_deg=8\", \"element.cant_azimuth_deg=40\"]\n";
  const std::string one = "[[zone]]\narea_fraction = 1\n";
  const design::Design part =
      read("[[zone]]\narea_fraction = 0.5\nrotation_deg = 20\n[[zone]]\narea_fraction = 0.5\n" + set);
  const RrePoint beams = rre(part, raytrace::Engine::exact, 15.0).points[0];
  const RrePoint rays = rre(part, raytrace::Engine::embree, 15.0, 400'000).points[0];
  const double exact = beams.rre;
  EXPECT_GT(rays.rre, exact - 4.0 * rays.std_error);
  EXPECT_LT(rays.rre,
            exact + beams.ledger.power[static_cast<std::size_t>(raytrace::Account::truncated)] + 4.0 * rays.std_error);
  const std::string half = "x_length_mm = 10; y_length_mm = 10";
  const double left =
      rre(read(one + "rotation_deg = 20\n", kHexagonal, half), raytrace::Engine::exact, 15.0).points[0].rre;
  const double right = rre(read(one + set, kHexagonal, half), raytrace::Engine::exact, 15.0).points[0].rre;
  EXPECT_NEAR(exact, 0.5 * (left + right), 0.05 * exact);
  EXPECT_GT(std::abs(left - right), 0.05 * exact);
}

// If all columns have equal elements, the part equals the array. In the other designs, every second column is rotated
// by 180 degrees. A rotation of a part with an odd number of columns by 180 degrees about its center then exchanges
// rotated and unrotated columns.
TEST(ZonedDesign, ColumnsInTurnAreTheArrayAndTurnWithIt) {
  const std::string lengths = "x_length_mm = 20; y_length_mm = 20";
  const std::string canted = "; cant_deg = 8; cant_azimuth_deg = 40";
  const std::string odd = "[[zone]]\ncolumns = 1\nevery = 2\n";
  const std::string rest = "[[zone]]\nrest = true\n";
  const std::string turn = "rotation_deg = 180\n";
  const design::Design alike = read(odd + rest, kHexagonal, lengths);
  const design::Design plain = design::parse_design(design_of(kHexagonal, lengths), "d.toml");
  EXPECT_NEAR(rre(alike, raytrace::Engine::exact, 12.0).points[0].rre,
              rre(plain, raytrace::Engine::exact, 12.0).points[0].rre, 1e-4);
  const auto at = [](const design::Design& design, double incidence_deg) {
    return rre(design, raytrace::Engine::embree, incidence_deg, 200'000).points[0];
  };
  const design::Design one_way = design::parse_design(design_of(kHexagonal + canted, lengths), "d.toml");
  EXPECT_GT(std::abs(at(one_way, 25.0).rre - at(one_way, -25.0).rre), 0.1);
  const RrePoint rest_turned = at(read(odd + rest + turn, kHexagonal + canted, lengths), 25.0);
  const RrePoint odd_turned = at(read(odd + turn + rest, kHexagonal + canted, lengths), -25.0);
  EXPECT_NEAR(rest_turned.rre, odd_turned.rre, 4.0 * std::hypot(rest_turned.std_error, odd_turned.std_error));
}

// In triangular arrays, light passes from cell to cell. A fraction of the light passes through cells of two zones. This
// fraction is larger for narrow zones.
TEST(ZonedDesign, TellHowMuchLightMeetsTwoOfThem) {
  const auto share = [](const std::string& zones) {
    return inspect(read(zones, kTriangular), materials::MaterialLibrary::shipped()).zones->crossings[1].fraction;
  };
  const double wide = share(kHalves);
  const std::string fifth = "[[zone]]\narea_fraction = 0.2\n";
  const double narrow = share(fifth + fifth + fifth + fifth + fifth);
  EXPECT_GT(wide, 0.0);
  EXPECT_GT(narrow, 2.0 * wide);
  EXPECT_LT(narrow, 0.5);
}

TEST(ZonedDesign, AreInspectedAndExported) {
  const design::Design design = read(
      "[[zone]]\npolygon_mm = [[0, 0], [20, 0], [0, 10]]\nrotation_deg = 10\n"
      "[[zone]]\npolygon_mm = [[20, 0], [20, 10], [0, 10]]\n"
      "set = [\"element.kind='rtp'\", \"element.base_mm=1\", \"element.width_mm=0.8\", \"array.x_gap_mm=0.2\"]\n");
  const Inspection inspection = inspect(design, materials::MaterialLibrary::shipped());
  EXPECT_EQ(inspection.boundary, "closed, free of self-intersections");
  const auto json = nlohmann::json::parse(inspect_json(inspection));
  ASSERT_EQ(json["zones"].size(), 2U);
  EXPECT_EQ(json["zones"][0]["area_mm2"], 100.0);
  EXPECT_EQ(json["elements_full"],
            json["zones"][0]["elements_full"].get<int>() + json["zones"][1]["elements_full"].get<int>());
  EXPECT_EQ(json["design"]["zone"][1]["set"].size(), 4U);
  const std::string text = inspect_text(inspection);
  EXPECT_NE(text.find("  zone 1              50.000 %, "), std::string::npos) << text;
  EXPECT_NE(text.find("; rotated by 10 degrees\n"), std::string::npos) << text;
  EXPECT_NE(text.find("; element.kind='rtp'; "), std::string::npos) << text;
  const Solid solid = make_solid(design, {});
  EXPECT_TRUE(solid.is_manifold);
  const geometry::Part part = design::part_of_design(design, nullptr);
  EXPECT_NEAR(solid.volume_mm3, 200.0 * part.thickness_mm, 0.5 * 200.0 * part.element_depth_mm);
  EXPECT_EQ(refusal_of([&] { make_solid(design, {"mould", {}}); }), "d.toml:9: zone");
}

}  // namespace
}  // namespace retrace::studies::zones_test
