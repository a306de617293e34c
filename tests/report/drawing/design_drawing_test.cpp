// Tests of plan and section of designs: faces, lines, lengths and texts are compared with the design.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "design/design_part.h"
#include "design/io/design_reader.h"
#include "design/part_of_design.h"
#include "geometry/elements/facet_planes.h"
#include "report/drawing/design_sheets.h"
#include "report/drawing/svg_sheet.h"
#include "tests/report/drawing/svg_reader.h"

namespace retrace::testing::design_drawing_test {
namespace {

using namespace geometry;
using namespace studies;

constexpr const char* kBody = "[body]\nthickness_mm = 1.2\n";

std::string prisms(const std::string& array, const std::string& rest = "") {
  return "title = \"T\"\n[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\n" + array + kBody + rest;
}

std::string cubes(const char* kind, const std::string& array) {
  return std::string("title = \"T\"\n[element]\nkind = \"") + kind + "\"\naperture_mm = 2\n[array]\n" + array + kBody;
}

constexpr const char* kGaps =
    "arrangement = \"offset\"\nshifted_rows = \"odd\"\nx_length_mm = 6\ny_length_mm = 4\nx_gap_mm = 0.08\n"
    "y_gap_mm = 0.05\nx_offset_mm = 0.3\ny_offset_mm = 0.25\n";
constexpr const char* kPlain = "x_length_mm = 6\ny_length_mm = 4\n";
constexpr const char* kChecker = "arrangement = \"checker\"\nx_length_mm = 3\ny_length_mm = 2\n";
constexpr const char* kOffsets = "x_length_mm = 12\ny_length_mm = 9\nx_offset_mm = 0.7\n";

std::vector<std::string> finite_designs() {
  return {prisms(kGaps),
          prisms(kPlain),
          prisms(kChecker),
          prisms("arrangement = \"single\"\n"),
          cubes("hexagonal_icc", kOffsets),
          cubes("triangular_icc", kOffsets),
          cubes("hexagonal_icc", "arrangement = \"single\"\n"),
          cubes("triangular_icc", "arrangement = \"single\"\n")};
}

std::vector<std::string> all_designs() {
  std::vector<std::string> designs = finite_designs();
  designs.push_back(prisms("arrangement = \"offset\"\nextent = \"infinite\"\n"));
  designs.push_back(prisms("arrangement = \"checker\"\nextent = \"infinite\"\n"));
  designs.push_back(cubes("hexagonal_icc", "extent = \"infinite\"\n"));
  designs.push_back(cubes("triangular_icc", "extent = \"infinite\"\n"));
  designs.push_back(prisms(kPlain, "[surface]\nrim_radius_um = 20\nroot_chamfer_um = 15\n"));
  designs.push_back(prisms("x_length_mm = 60\ny_length_mm = 90\n"));
  return designs;
}

struct Drawn {
  design::Design design;
  Part part;
  DesignDrawing drawing;
};

Drawn drawn(const std::string& text) {
  Drawn d{design::parse_design(text, "d.toml"), {}, {}};
  d.part = design::part_of(d.design);
  d.drawing = draw_design(d.design, d.part);
  return d;
}

double value_of(const std::vector<Dimension>& dimensions, const std::string& name) {
  for (const Dimension& d : dimensions)
    if (d.name == name) return d.value_mm;
  return NAN;
}

/// Returns the value of a dimension, which is searched in all panels of the plan.
double plan_value(const DesignDrawing& drawing, const std::string& name) {
  for (const PlanPanel& panel : drawing.plan)
    if (const double value = value_of(panel.dimensions, name); std::isfinite(value)) return value;
  return NAN;
}

/// The faces in the plan add up to the area of the part. The area of a drawn facet is the projection of the facet onto
/// the plan.
TEST(DesignDrawing, FacesCoverThePart) {
  for (const std::string& text : finite_designs()) {
    const Drawn d = drawn(text);
    double all = 0.0;
    double facets = 0.0;
    for (const PlanFace& face : d.drawing.plan.front().view.faces) {
      all += area(face.outline_mm);
      if (face.role == FacetRole::retro_facet) facets += area(face.outline_mm);
    }
    EXPECT_NEAR(all, d.part.entrance_area_mm2, 1e-9 * all) << text;
    // The facets of prisms are inclined by 45 degrees, and those of cube corners by acos(1 / sqrt 3).
    const bool is_cube = text.find("icc") != std::string::npos;
    EXPECT_NEAR(facets * (is_cube ? std::numbers::sqrt3 : std::numbers::sqrt2), d.part.retro_facet_area_mm2, 1e-9 * all)
        << text;
  }
}

TEST(DesignDrawing, LinesOfPrismsLieWhereTheyAre) {
  const Drawn d = drawn(prisms(kPlain));
  const PlanView& view = d.drawing.plan.front().view;
  ASSERT_EQ(view.roots_mm.size(), 12U * 8U);
  for (const auto& [a, b] : view.roots_mm) {
    EXPECT_NEAR(a.x(), b.x(), 1e-12);
    EXPECT_NEAR(std::remainder(a.x() - 0.25, 0.5), 0.0, 1e-12);
    EXPECT_NEAR(std::abs(b.y() - a.y()), 0.5, 1e-12);
  }
  double upright = 0.0;
  for (const auto& [a, b] : view.rims_mm) {
    const double off = std::min(std::abs(std::remainder(a.x(), 0.5)) + std::abs(a.x() - b.x()),
                                std::abs(std::remainder(a.y(), 0.5)) + std::abs(a.y() - b.y()));
    EXPECT_NEAR(off, 0.0, 1e-12);
    upright += std::abs(b.y() - a.y());
  }
  EXPECT_NEAR(upright, 13.0 * 4.0, 1e-9) << "each rim is drawn once";
}

TEST(DesignDrawing, LinesOfACubeMeetAtItsApex) {
  const Drawn d = drawn(cubes("hexagonal_icc", "arrangement = \"single\"\n"));
  const PlanView& view = d.drawing.plan.front().view;
  const Vec2 apex(1.0, 0.5 * std::numbers::sqrt3);
  ASSERT_EQ(view.roots_mm.size(), 3U);
  for (const auto& [a, b] : view.roots_mm) {
    EXPECT_NEAR(std::min((a - apex).norm(), (b - apex).norm()), 0.0, 1e-12);
    EXPECT_NEAR((a - b).norm(), 1.0, 1e-12);
  }
  ASSERT_EQ(view.rims_mm.size(), 6U);
  for (const auto& [a, b] : view.rims_mm) EXPECT_NEAR((0.5 * (a + b) - apex).norm(), 0.5 * std::numbers::sqrt3, 1e-12);
}

TEST(DesignDrawing, HasTheLengthsOfTheDesign) {
  const Drawn d = drawn(prisms(kGaps));
  ASSERT_EQ(d.drawing.plan.size(), 2U);
  const std::vector<std::pair<const char*, double>> expected = {
      {"base", 0.5},
      {"width", 0.5},
      {"x gap", 0.08},
      {"y gap", 0.05},
      {"shift", 0.25},
      {"x pitch", 0.58},
      {"y pitch", 0.55},
      {"x length", 6.0},
      // 9 x 6 elements are centred on the part. The margins are (6 - 9 * 0.58 + 0.08) / 2 and (4 - 6 * 0.55 + 0.05) /
      // 2.
      {"y length", 4.0},
      {"x margin", 0.43},
      {"y margin", 0.375}};
  for (const auto& [name, value] : expected) EXPECT_NEAR(plan_value(d.drawing, name), value, 1e-12) << name;
  EXPECT_NEAR(value_of(d.drawing.section->dimensions, "depth"), 0.25, 1e-12);
  EXPECT_NEAR(value_of(d.drawing.section->dimensions, "thickness"), 1.2, 1e-12);
  EXPECT_NEAR(d.drawing.section->angle->deg, 90.0, 1e-9);
}

TEST(DesignDrawing, HasTheLengthsOfCubeCorners) {
  const double root3 = std::numbers::sqrt3;
  const Drawn hexagons = drawn(cubes("hexagonal_icc", kOffsets));
  EXPECT_NEAR(plan_value(hexagons.drawing, "aperture"), 2.0, 1e-12);
  EXPECT_NEAR(plan_value(hexagons.drawing, "across flats"), root3, 1e-12);
  EXPECT_NEAR(plan_value(hexagons.drawing, "column pitch"), 1.5, 1e-12);
  EXPECT_NEAR(plan_value(hexagons.drawing, "x margin"), 0.7, 1e-12);
  EXPECT_NEAR(value_of(hexagons.drawing.section->dimensions, "depth"), std::numbers::sqrt2, 1e-12);
  const Drawn triangles = drawn(cubes("triangular_icc", "extent = \"infinite\"\n"));
  EXPECT_NEAR(plan_value(triangles.drawing, "side"), root3, 1e-12);
  EXPECT_NEAR(plan_value(triangles.drawing, "x period"), 3.0, 1e-12);
  EXPECT_NEAR(plan_value(triangles.drawing, "y period"), root3, 1e-12);
  EXPECT_NEAR(triangles.drawing.section->angle->deg, 90.0, 1e-9) << "an edge stands upright on the facet across";
}

TEST(DesignDrawing, AnglesHoldTheirErrors) {
  const Drawn d = drawn(prisms(kPlain, "[surface]\ndihedral_error_arcmin = 6\nfacet_tilt_arcmin = [3, 9]\n"));
  EXPECT_NEAR(d.drawing.section->angle->deg, 90.3, 1e-9);
}

double area_of(const std::vector<Vec2>& outline) {
  double twice = 0.0;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec2& a = outline[k];
    const Vec2& b = outline[(k + 1) % outline.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

TEST(DesignDrawing, SectionsHaveTheirAreas) {
  // The section consists of a rectangle and a right triangle below it.
  const Drawn prism = drawn(prisms("arrangement = \"single\"\n"));
  EXPECT_NEAR(area_of(prism.drawing.section->view.outline_mm), 0.5 * 1.2 + 0.25 * 0.25, 1e-6);
  // With d = aperture / sqrt 8, the section rises from the apex at -2 d to 0 on one side. On the other side, it rises
  // along the dihedral edge to -d.
  const Drawn cube = drawn(cubes("hexagonal_icc", "arrangement = \"single\"\n"));
  const double d = 1.0 / std::numbers::sqrt2;
  EXPECT_NEAR(area_of(cube.drawing.section->view.outline_mm), 2.0 * 1.2 + d + 1.5 * d, 1e-6);
  // In an offset row, half of a shifted element is cut off at the left end.
  const Drawn brick =
      drawn(prisms("arrangement = \"offset\"\nshifted_rows = \"odd\"\nx_length_mm = 1\ny_length_mm = 1\n"));
  const auto row = section_view(brick.part, 0.25, 0.0, 1.0);
  ASSERT_TRUE(row);
  EXPECT_NEAR(area_of(row->outline_mm), 1.2 + 2.0 * 0.25 * 0.25, 1e-6);
}

// The area of the section is the integral of the height of the entrance face, a parabola in x, plus the area of the
// triangular prisms.
TEST(DesignDrawing, SectionsEndAtACurvedEntranceFace) {
  const design::Design design = design::parse_design(prisms("x_length_mm = 6\ny_length_mm = 4\n"), "d.toml");
  const Part part = design::part_of(design);
  const auto height = [](const Vec2& p) { return 1.5 - 0.05 * std::pow(p.x() - 3.0, 2.0); };
  const DesignDrawing drawing = draw_curved_design(design, part, height);
  ASSERT_TRUE(drawing.section);
  const SectionView& view = drawing.section->view;
  EXPECT_FALSE(drawing.section->is_continued);
  EXPECT_NEAR(area_of(view.outline_mm), 6.0 * 1.5 - 0.05 * 2.0 * 9.0 + 12.0 * 0.25 * 0.25, 1e-4);
  EXPECT_NEAR(value_of(drawing.section->dimensions, "height at edge"), 1.05, 1e-5);
  EXPECT_NEAR(value_of(drawing.section->dimensions, "highest point"), 1.5, 1e-9);
  EXPECT_EQ(drawing.plan.front().section_y_mm, view.y_mm);
  EXPECT_FALSE(report::section_svg(drawing).empty());
}

TEST(DesignDrawing, MasksAreShown) {
  // The table of planes acts as a mask here: elements that are not in the table are flat.
  design::Design design = design::parse_design(prisms("x_length_mm = 2\ny_length_mm = 1\n"), "d.toml");
  ElementPlanes element;
  element.centre_mm = {1.25, 0.75};
  element.planes = {HeightPlane{-0.25, {-1.0, 0.0}}, HeightPlane{-0.25, {1.0, 0.0}}};
  const FacetPlanes planes({element}, 0.5);
  std::get<design::ElementArray>(design.shape).facet_planes = design::FacetPlanesFile{};
  const Part part = build_part(design.part(), planes);
  const DesignDrawing drawing = draw_design(design, part);
  std::size_t facets = 0;
  for (const PlanFace& face : drawing.plan.front().view.faces) facets += face.role == FacetRole::retro_facet ? 1 : 0;
  EXPECT_EQ(facets, 2U);
  for (const Dimension& d : drawing.plan.back().dimensions)
    if (d.name == "base") {
      EXPECT_NEAR(d.from_mm.x(), 1.0, 1e-9) << "measured where an element is";
    }
}

/// Returns the texts of a drawing, including those with numbers.
std::multiset<std::string> texts_of(const std::string& svg) {
  std::multiset<std::string> texts;
  for (const SvgElement& element : svg_elements(svg))
    if (element.name == "text") texts.insert(element.text);
  return texts;
}

TEST(DesignSheets, TextsAreTheLengths) {
  const Drawn d = drawn(prisms(kGaps));
  const std::multiset<std::string> plan = texts_of(report::plan_svg(d.drawing));
  for (const char* text : {"base 0.5", "width 0.5", "x gap 0.08", "y gap 0.05", "shift 0.25", "x pitch 0.58",
                           "y pitch 0.55", "x length 6", "y length 4", "x margin 0.43", "y margin 0.375", "Detail A"})
    EXPECT_EQ(plan.count(text), 1U) << text;
  const std::multiset<std::string> section = texts_of(report::section_svg(d.drawing));
  for (const char* text : {"depth 0.25", "thickness 1.2", "base 0.5", "90°"})
    EXPECT_EQ(section.count(text), 1U) << text;
}

/// The coordinates of lines in the drawing are converted back to mm and compared with the geometry.
TEST(DesignSheets, LinesLieWhereTheGeometrySays) {
  const Drawn d = drawn(prisms(kPlain));
  const std::vector<SvgElement> elements = svg_elements(report::plan_svg(d.drawing));
  const auto group = std::find_if(elements.begin(), elements.end(), [](const SvgElement& e) {
    return e.name == "g" && e.attributes.contains("id") && e.attributes.at("id") == "plan-0";
  });
  ASSERT_NE(group, elements.end());
  const double units = std::stod(group->attributes.at("data-units-per-mm"));
  const double x = std::stod(group->attributes.at("data-x-mm"));
  const double y = std::stod(group->attributes.at("data-y-mm"));
  std::size_t roots = 0;
  for (const SvgElement& element : elements) {
    if (element.group != "plan-0" || element.name != "path") continue;
    const std::string& style = element.attributes.at("class");
    if (style != "root" && style != "outline") continue;
    for (const SvgPoint& p : svg_points(element)) {
      const Vec2 at(x + p.x / units, y - p.y / units);
      if (style == "root") {
        EXPECT_NEAR(std::remainder(at.x() - 0.25, 0.5), 0.0, 1e-3 / units);
        EXPECT_NEAR(std::remainder(at.y(), 0.5), 0.0, 1e-3 / units);
        ++roots;
      } else {
        EXPECT_NEAR(std::min(std::abs(at.x()), std::abs(at.x() - 6.0)), 0.0, 1e-3 / units);
        EXPECT_NEAR(std::min(std::abs(at.y()), std::abs(at.y() - 4.0)), 0.0, 1e-3 / units);
      }
    }
  }
  EXPECT_EQ(roots, 2U * 96U);
}

struct TextBox {
  std::string text;
  double left, top, right, bottom;
};

std::vector<TextBox> value_boxes(const std::string& svg, const std::string& group) {
  std::vector<TextBox> boxes;
  for (const SvgElement& e : svg_elements(svg)) {
    if (e.name != "text" || e.group != group) continue;
    const double x = std::stod(e.attributes.at("x"));
    const double y = std::stod(e.attributes.at("y"));
    const double half = 0.5 * report::sheet_text_width(e.text, report::kSheetTextSize);
    constexpr double rise = 0.75 * report::kSheetTextSize;
    if (e.attributes.contains("transform"))
      boxes.push_back({e.text, x - rise, y - half, x, y + half});
    else
      boxes.push_back({e.text, x - half, y - rise, x + half, y});
  }
  return boxes;
}

/// For every kind of design, the drawing is well-formed, texts do not overlap, nothing is outside of the sheet, and a
/// second drawing has the same bytes.
TEST(DesignSheets, AreLegible) {
  for (const std::string& text : all_designs()) {
    const Drawn d = drawn(text);
    ASSERT_TRUE(d.drawing.section) << text;
    for (const std::string& svg : {report::plan_svg(d.drawing), report::section_svg(d.drawing)}) {
      ASSERT_FALSE(svg_elements(svg).empty()) << "not well-formed";
      EXPECT_EQ(svg.find("nan"), std::string::npos);
      // Notes contain the word "infinite".
      for (std::size_t at = 0; (at = svg.find("inf", at)) != std::string::npos; ++at)
        EXPECT_EQ(svg.compare(at, 8, "infinite"), 0) << svg.substr(at, 20);
      for (const char* group : {"plan-0", "plan-1", "section-0"}) {
        const std::vector<TextBox> boxes = value_boxes(svg, group);
        for (std::size_t i = 0; i < boxes.size(); ++i)
          for (std::size_t j = i + 1; j < boxes.size(); ++j) {
            const TextBox& a = boxes[i];
            const TextBox& b = boxes[j];
            EXPECT_FALSE(a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom)
                << a.text << " and " << b.text << " of\n"
                << text;
          }
      }
    }
    EXPECT_EQ(report::plan_svg(d.drawing), report::plan_svg(drawn(text).drawing));
  }
}

/// Zones have numbers, colours and a legend, and the faces of each zone have its area.
TEST(DesignSheets, ZonesAreNumberedAndColoured) {
  const std::string base = cubes("hexagonal_icc", "x_length_mm = 24\ny_length_mm = 12\n");
  for (const std::string zones :
       {"[[zone]]\narea_fraction = 0.25\n[[zone]]\narea_fraction = 0.75\nrotation_deg = 180\n",
        "[[zone]]\nrows = [1]\nevery = 2\n[[zone]]\nrest = true\nrotation_deg = 180\n"}) {
    SCOPED_TRACE(zones);
    const design::Design design = design::parse_design(base + zones, "d.toml");
    const Part part = design::part_of_design(design, nullptr);
    const DesignDrawing drawing = draw_design(design, part);
    const PlanPanel& panel = drawing.plan.front();
    ASSERT_EQ(panel.zones.size(), 2U);
    std::array<double, 2> areas{};
    for (const PlanFace& face : panel.view.faces) {
      ASSERT_TRUE(face.zone);
      areas[*face.zone] += area(face.outline_mm);
    }
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(areas[k], part.zones[k].area_mm2, 1e-6 * areas[k]);
      EXPECT_EQ(panel.zones[k].labels_mm.size(), 1U);
    }
    const std::string svg = report::plan_svg(drawing);
    const std::multiset<std::string> texts = texts_of(svg);
    for (const char* number : {"1", "2"}) EXPECT_EQ(texts.count(number), 1U);
    std::size_t swatches = 0;
    std::set<std::string> colours;
    for (const SvgElement& e : svg_elements(svg)) {
      if (e.name != "path") continue;
      const std::string& style = e.attributes.at("class");
      if (style.starts_with("zone swatch")) ++swatches;
      if (const auto at = style.find("zone z"); at != std::string::npos) colours.insert(style.substr(at));
    }
    EXPECT_EQ(swatches, 2U);
    EXPECT_EQ(colours, (std::set<std::string>{"zone z0", "zone z1"}));
  }
}

TEST(DesignSheets, LargeArraysAreDrawnWithoutTheirElements) {
  const Drawn d = drawn(prisms("x_length_mm = 60\ny_length_mm = 90\n"));
  ASSERT_EQ(d.drawing.plan.size(), 2U);
  EXPECT_TRUE(d.drawing.plan[0].omits_faces);
  EXPECT_FALSE(d.drawing.plan[1].view.faces.empty());
  EXPECT_LT(report::plan_svg(d.drawing).size(), 30'000U);
}

TEST(DesignSheets, TextsAreEscaped) {
  Drawn d = drawn(prisms(kPlain));
  d.drawing.title = "a < b & \"c\"";
  const std::multiset<std::string> texts = texts_of(report::plan_svg(d.drawing));
  EXPECT_EQ(texts.count(d.drawing.title), 1U);
}

}  // namespace
}  // namespace retrace::testing::design_drawing_test
