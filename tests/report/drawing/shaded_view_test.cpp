// Tests of shaded views: silhouettes are compared with closed forms, hidden faces are not drawn, and the file is a
// valid picture.
#include "report/drawing/shaded_view.h"

#include <cairo.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>

#include "design/io/design_reader.h"
#include "report/drawing/design_picture.h"
#include "tests/support/designs.h"

namespace retrace::testing::shaded_view_test {
namespace {

using namespace geometry;
using report::shaded_view;
using report::ShadedView;
using report::ViewDirection;

/// Returns the area of the projection of a convex body: the convex hull of its projected corners (Andrew's monotone
/// chain).
double hull_area(const std::vector<Vec3>& corners, const ViewDirection& direction) {
  const Vec3 right = direction.up.cross(direction.from).normalized();
  const Vec3 up = direction.from.cross(right);
  std::vector<Vec2> points;
  for (const Vec3& c : corners) points.emplace_back(c.dot(right), c.dot(up));
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  std::vector<Vec2> hull;
  const auto turn = [](const Vec2& a, const Vec2& b, const Vec2& c) {
    return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
  };
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0.0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  double twice = 0.0;
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const Vec2& a = hull[k];
    const Vec2& b = hull[(k + 1) % hull.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

std::vector<ViewDirection> directions() {
  return {{Vec3(0.3, -0.5, -0.8).normalized(), -Vec3::UnitZ()},
          {Vec3(-0.7, 0.2, 0.4).normalized(), Vec3::UnitZ()},
          {Vec3(0.1, 0.9, -0.2).normalized(), Vec3::UnitX()},
          {Vec3::UnitZ(), Vec3::UnitY()}};
}

double covered_mm2(const ShadedView& view) {
  return view.covered * view.mm_per_pixel * view.mm_per_pixel;
}

TEST(ShadedView, SilhouetteOfAPrismIsItsShadow) {
  const studies::DesignView view = studies::view_of(build_part(single(RtpElement{2.0, 3.0}, 1.5)));
  std::vector<Vec3> corners;
  for (const double y : {0.0, 3.0}) {
    for (const double z : {0.0, 1.5})
      for (const double x : {0.0, 2.0}) corners.emplace_back(x, y, z);
    corners.emplace_back(1.0, y, -1.0);
  }
  for (const ViewDirection& d : directions())
    EXPECT_NEAR(covered_mm2(shaded_view(view.mesh, view.edges, d, 400, 300)) / hull_area(corners, d), 1.0, 2e-3);
}

TEST(ShadedView, SilhouetteOfATriangularCubeIsItsShadow) {
  const studies::DesignView view = studies::view_of(build_part(single(TriangularCube{2.0}, 1.0)));
  const Vec2 shift(0.5, 0.5 * std::sqrt(3.0));
  std::vector<Vec3> corners = {{shift.x(), shift.y(), -1.0 / std::sqrt(2.0)}};
  for (const double z : {0.0, 1.0})
    for (const double deg : {0.0, 120.0, 240.0}) {
      const double a = deg * std::numbers::pi / 180.0;
      corners.emplace_back(shift.x() + std::cos(a), shift.y() + std::sin(a), z);
    }
  for (const ViewDirection& d : directions())
    EXPECT_NEAR(covered_mm2(shaded_view(view.mesh, view.edges, d, 300, 400)) / hull_area(corners, d), 1.0, 2e-3);
}

/// Seen from the light, a part shows only its entrance face, which hides everything behind it.
TEST(ShadedView, NearerFacesHideOthers) {
  const Part part = build_part(finite(HexagonalCube{1.0}, Arrangement::honeycomb, 6.0, 5.0, 0.5));
  const studies::DesignView view = studies::view_of(part);
  const ShadedView seen = shaded_view(view.mesh, view.edges, {Vec3::UnitZ(), Vec3::UnitY()}, 200, 160);
  EXPECT_NEAR(covered_mm2(seen), 30.0, 0.06);
  const report::Colour& middle = seen.colours[80 * 200 + 100];
  for (std::size_t row = 30; row < 130; ++row)
    for (std::size_t column = 40; column < 160; ++column) EXPECT_EQ(seen.colours[row * 200 + column].blue, middle.blue);
  // Seen from behind, the part shows facets of three orientations and the edges between them.
  const ShadedView back = shaded_view(view.mesh, view.edges, {-Vec3::UnitZ(), Vec3::UnitY()}, 200, 160);
  std::vector<double> shades;
  for (std::size_t row = 40; row < 120; ++row)
    for (std::size_t column = 50; column < 150; ++column) shades.push_back(back.colours[row * 200 + column].blue);
  std::sort(shades.begin(), shades.end());
  shades.erase(std::unique(shades.begin(), shades.end()), shades.end());
  EXPECT_GT(shades.size(), 3U);
}

/// The repeated patches of a large part and the partial elements at its border form one surface without gaps: seen from
/// below, no background is visible within the outline.
TEST(ShadedView, PartsOfManyPiecesHaveNoHoles) {
  const Part part = build_part(finite(RtpElement{0.2, 0.2}, Arrangement::offset, 12.1, 10.3, 0.5));
  ASSERT_GT(part.placements.size(), 1U);
  const studies::DesignView view = studies::view_of(part);
  const ShadedView seen = shaded_view(view.mesh, {}, {-Vec3::UnitZ(), Vec3::UnitY()}, 300, 300);
  EXPECT_NEAR(covered_mm2(seen), 12.1 * 10.3, 2e-3 * 12.1 * 10.3);
}

/// A curved entrance face closes the part: from above and from the side, no background is visible.
TEST(ShadedView, CurvedEntrancesHaveNoHoles) {
  const Part part = build_part(finite(RtpElement{1.0, 1.0}, Arrangement::aligned, 6.0, 4.0, 1.0));
  const auto height = [](const Vec2& p) { return 1.0 + 0.2 * std::sin(p.x()) * std::cos(2.0 * p.y()); };
  const studies::DesignView view = studies::view_of(part, height);
  EXPECT_TRUE(view.has_curved_entrance);
  const ShadedView above = shaded_view(view.mesh, {}, {Vec3::UnitZ(), Vec3::UnitY()}, 300, 300);
  EXPECT_NEAR(covered_mm2(above), 24.0, 2e-3 * 24.0);
  double highest = 0.0;
  for (const Vec3& v : view.mesh.vertices) highest = std::max(highest, v.z());
  EXPECT_NEAR(highest, 1.2, 1e-3);
}

struct PngSource {
  const std::string* bytes;
  std::size_t at = 0;
};

TEST(DesignPicture, IsAPicture) {
  const design::Design design = design::parse_design(
      "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\nextent = \"infinite\"\n[body]\n"
      "thickness_mm = 2\n",
      "d.toml");
  const studies::DesignView view = studies::view_of(design);
  EXPECT_EQ(view.remarks.front(), "a few elements of the array");
  const std::string png = report::view_png(view);
  PngSource source{&png};
  cairo_surface_t* const surface = cairo_image_surface_create_from_png_stream(
      [](void* closure, unsigned char* data, unsigned int length) {
        auto& s = *static_cast<PngSource*>(closure);
        if (s.at + length > s.bytes->size()) return CAIRO_STATUS_READ_ERROR;
        std::memcpy(data, s.bytes->data() + s.at, length);
        s.at += length;
        return CAIRO_STATUS_SUCCESS;
      },
      &source);
  ASSERT_EQ(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
  EXPECT_GT(cairo_image_surface_get_width(surface), 1000);
  cairo_surface_destroy(surface);
  EXPECT_EQ(png, report::view_png(view));
}

}  // namespace
}  // namespace retrace::testing::shaded_view_test
