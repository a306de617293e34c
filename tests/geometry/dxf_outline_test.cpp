#include "geometry/io/dxf_outline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "core/error.h"
#include "tests/support/refusals.h"

namespace retrace::geometry {
namespace dxf_outline_test {

std::string file(const std::string& entities, const std::string& header = "") {
  return header + "0\nSECTION\n2\nENTITIES\n" + entities + "0\nENDSEC\n0\nEOF\n";
}
std::string header(const std::string& unit) {
  return "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n" + unit + "\n0\nENDSEC\n";
}
std::string line(const std::string& from, const std::string& to, const std::string& layer = "CUT") {
  const auto split = [](const std::string& p) { return p.find(','); };
  return "0\nLINE\n8\n" + layer + "\n10\n" + from.substr(0, split(from)) + "\n20\n" + from.substr(split(from) + 1) +
         "\n11\n" + to.substr(0, split(to)) + "\n21\n" + to.substr(split(to) + 1) + "\n";
}
std::string arc(const std::string& values) {
  std::string text = "0\nARC\n8\nCUT\n";
  const char* codes[] = {"10", "20", "40", "50", "51"};
  std::size_t at = 0;
  for (const char* code : codes) {
    const std::size_t end = std::min(values.find(' ', at), values.size());
    text += std::string(code) + "\n" + values.substr(at, end - at) + "\n";
    at = end + 1;
  }
  return text;
}
std::string circle_at_10_5(const std::string& layer = "CUT") {
  return "0\nCIRCLE\n8\n" + layer + "\n10\n10\n20\n5\n40\n2\n";
}
/// Returns a stadium whose two lines and two arcs are not in order. Each line may run in either direction.
std::string stadium() {
  return line("0,0", "20,0") + line("0,10", "20,10") + arc("20 5 5 270 90") + arc("0 5 5 90 270");
}
constexpr double kStadium = 200.0 + 25.0 * std::numbers::pi;

double area_of(const std::string& text, const DxfSelection& selection = {}) {
  return oriented(parse_dxf_outline(text, "o.dxf", selection)).area_mm2();
}
std::string refusal(const std::string& text, const DxfSelection& selection = {}) {
  return refusal_of([&] { area_of(text, selection); }, "accepted");
}

TEST(DxfOutline, LinesAndArcsAreJoined) {
  EXPECT_NEAR(area_of(file(stadium())), kStadium, 1e-9);
  EXPECT_NEAR(area_of(file(stadium() + circle_at_10_5())), kStadium - 4 * std::numbers::pi, 1e-9);
  EXPECT_EQ(parse_dxf_outline(file(stadium() + circle_at_10_5()), "o.dxf", {}).size(), 2U);
}

TEST(DxfOutline, PolylinesHaveBulges) {
  std::string poly = "0\nLWPOLYLINE\n8\nCUT\n90\n4\n70\n1\n";
  for (const char* corner : {"0 0 0", "20 0 1", "20 10 0", "0 10 1"}) {
    const std::string text = corner;
    const std::size_t a = text.find(' ');
    const std::size_t b = text.find(' ', a + 1);
    poly +=
        "10\n" + text.substr(0, a) + "\n20\n" + text.substr(a + 1, b - a - 1) + "\n42\n" + text.substr(b + 1) + "\n";
  }
  EXPECT_NEAR(area_of(file(poly)), kStadium, 1e-9);
  EXPECT_NEAR(area_of(file(poly, header("1"))), kStadium * 25.4 * 25.4, 1e-6);
  EXPECT_NEAR(area_of(file(poly, header("1")), {"", 0.1}), kStadium * 0.01, 1e-9);
}

TEST(DxfOutline, LayersAreSelected) {
  const std::string text = file("0\nTEXT\n8\nNOTES\n1\nhello\n" + stadium() + circle_at_10_5("HOLES"));
  EXPECT_NEAR(area_of(text, {"CUT", {}}), kStadium, 1e-9);
  EXPECT_EQ(refusal(text), "o.dxf:6");
  EXPECT_EQ(refusal(text, {"OTHER", {}}), "o.dxf");
}

/// Entities on other layers may have any number of vertices, and values that would be refused on the selected layer.
TEST(DxfOutline, LimitsApplyToTheSelectedLayer) {
  std::string large = "0\nLWPOLYLINE\n8\nNOTES\n90\n30000\n70\n0\n";
  for (int k = 0; k < 30000; ++k) large += "10\n" + std::to_string(k) + "\n20\n0\n";
  const std::string far = "0\nLINE\n10\n1e12\n20\nx\n8\nNOTES\n11\n0\n21\n0\n";
  EXPECT_NEAR(area_of(file(large + stadium() + far), {"CUT", {}}), kStadium, 1e-9);
  EXPECT_EQ(refusal(file(far + stadium()), {"NOTES", {}}), "o.dxf:8");
  EXPECT_NE(refusal(file(large + stadium())), "accepted");
}

TEST(DxfOutline, FaultsAreReportedAtTheirLine) {
  EXPECT_EQ(refusal(file(line("0,0", "20,0") + line("20,0", "0,10"))), "o.dxf:18");
  EXPECT_EQ(refusal(file(line("0,0", "20,0") + line("20,0", "0,10") + line("0,10", "0,0.01"))), "o.dxf:30");
  EXPECT_EQ(refusal(file(line("0,0", "20,0") + line("20,0", "0,10") + line("0,10", "0,0") + line("20,0", "30,0"))),
            "o.dxf:42");
  EXPECT_EQ(refusal(file("0\nSPLINE\n8\nCUT\n")), "o.dxf:6");
  EXPECT_EQ(refusal(file("0\nCIRCLE\n8\nCUT\n10\n1\n20\n1\n40\n-2\n")), "o.dxf:6");
  EXPECT_EQ(refusal(file("0\nCIRCLE\n8\nCUT\n10\n1\n40\n2\n")), "o.dxf:6");
  EXPECT_EQ(refusal(file("0\nCIRCLE\n8\nCUT\n10\nx\n20\n1\n40\n2\n")), "o.dxf:10");
  EXPECT_EQ(refusal("zero\nSECTION\n"), "o.dxf:1");
  EXPECT_EQ(refusal("AutoCAD Binary DXF\r\n"), "o.dxf");
  EXPECT_EQ(refusal("0\nEOF\n"), "o.dxf");
  EXPECT_EQ(refusal(file("")), "o.dxf");
  EXPECT_EQ(refusal(file(stadium(), header("3"))), "o.dxf:8");
}

}  // namespace dxf_outline_test
}  // namespace retrace::geometry
