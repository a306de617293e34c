#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "core/atomic_file.h"
#include "fabrication/machine/edge_cut.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/machine/setup.h"

// Tests how one unit of each quantity of the set-up, such as the tilt of an axis, changes the plane of a cut. The
// results are compared with closed forms and with the kinematics.

namespace retrace::fabrication::setup_test {
namespace {

using geometry::Vec3;

Machine machine(const std::string& name) {
  return parse_machine(read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml"), name);
}

/// Returns a plunge of facet 1 or 2 of a prism of 90 degrees whose root is at `root_mm`.
EdgeCut plunge_of_facet(const Machine& m, int facet, const Vec3& root_mm) {
  EdgeCut cut;
  cut.at = inverse(m, root_mm, {45.0, facet == 1 ? 0.0 : 180.0});
  return cut;
}
Vec3 normal_of_facet(int facet) {
  return Vec3(0, facet == 1 ? -1 : 1, 1).normalized();
}

struct Effect {
  double distance_nm = 0.0;
  double up_arcsec = 0.0;     ///< rotation of the facet about its root; positive if it closes the groove
  double along_arcsec = 0.0;  ///< rise of the facet along the root
};

/// Returns the effect of one unit of a quantity on a facet whose root is at `root_mm`.
Effect effect_on(int facet, const std::string& key, const Vec3& root_mm = Vec3::Zero()) {
  const Machine m = machine("ideal");
  const EdgeCut cut = plunge_of_facet(m, facet, root_mm);
  const Vec3 normal = normal_of_facet(facet);
  const Vec3 up = Vec3(0, facet == 1 ? 1 : -1, 1).normalized();
  const CutPlane plane = cut_plane(m, cut, normal);
  const PlaneChange change = plane_change(m, cut, *setup_quantity(Tilt::table, key), normal);
  const double at_root = change.height_mm(plane, root_mm, normal);
  const double per_arcsec = std::numbers::pi / 648000.0;
  return {1e6 * at_root, (change.height_mm(plane, root_mm + up, normal) - at_root) / per_arcsec,
          (change.height_mm(plane, root_mm + Vec3::UnitX(), normal) - at_root) / per_arcsec};
}

void expect_effect(int facet, const std::string& key, const Effect& expected) {
  SCOPED_TRACE(fmt::format("{} on facet {}", key, facet));
  const Effect effect = effect_on(facet, key);
  EXPECT_NEAR(effect.distance_nm, expected.distance_nm, 1e-9);
  EXPECT_NEAR(effect.up_arcsec, expected.up_arcsec, 1e-9);
  EXPECT_NEAR(effect.along_arcsec, expected.along_arcsec, 1e-9);
}

/// Checks the table in docs/theory/kinematics.md for a prism of 90 degrees at the origin.
TEST(Setup, EffectsOnAPrismInClosedForm) {
  const double s = std::numbers::sqrt2 / 2.0;
  expect_effect(1, "c_y_um", {0, 0, 0});
  expect_effect(2, "c_y_um", {2000 * s, 0, 0});  // 1,414 nm, without a tilt
  for (const int facet : {1, 2}) {
    const double side = facet == 1 ? 1.0 : -1.0;
    expect_effect(facet, "a_z_um", {1000 * s, 0, 0});  // 707 nm
    expect_effect(facet, "a_y_um", {1000 * (1.0 - s), 0, 0});
    expect_effect(facet, "tool_y_um", {-1000, 0, 0});
    for (const char* const nothing :
         {"c_x_um", "tool_x_um", "tool_z_um", "tool_rotation_x_arcsec", "tool_rotation_y_arcsec", "y_lean_x_arcsec",
          "y_lean_z_arcsec", "z_lean_x_arcsec"})
      expect_effect(facet, nothing, {0, 0, 0});
    // At C = 0, the facet is not affected by the lean of C. At 180 degrees, it is rotated by twice the lean. The
    // rotation about X closes the groove.
    const double twice = facet == 1 ? 0.0 : 2.0;
    expect_effect(facet, "c_lean_y_arcsec", {0, twice, 0});
    expect_effect(facet, "c_lean_x_arcsec", {0, 0, -twice * s});
    expect_effect(facet, "a_lean_y_arcsec", {0, 0, side * (1.0 - s)});
    expect_effect(facet, "a_lean_z_arcsec", {0, 0, side * s});
    expect_effect(facet, "tool_rotation_z_arcsec", {0, 0, -side});
  }
}

/// Returns a machine with errors in all quantities, with or without a head.
Machine any_machine(bool has_head) {
  Machine m = machine(has_head ? "ideal-dmc" : "paper");
  std::vector<double> amounts;
  for (const SetupQuantity& quantity : setup_quantities(m.tilt))
    amounts.push_back((quantity.is_angle() ? 2000.0 : 5000.0) * 1e-6 * *rc::gen::inRange(-1000000, 1000001));
  m.a.sign.value = *rc::gen::element(1.0, -1.0);
  m.c.sign.value = *rc::gen::element(1.0, -1.0);
  return with_errors(std::move(m), amounts);
}

double within(double size) {
  return size * 1e-6 * *rc::gen::inRange(-1000000, 1000001);
}

/// Returns a random cut of the machine: its end point, its direction and its edge.
EdgeCut any_cut(const Machine& m) {
  EdgeCut cut;
  const double tilt_deg = 50.0 + within(40.0);
  cut.at.x_mm = within(30.0);
  cut.at.y_mm = within(30.0);
  cut.at.z_mm = within(10.0);
  cut.at.c_deg = within(360.0);
  (m.tilt == Tilt::table ? cut.at.a_deg : cut.at.b_deg) = tilt_deg;
  cut.travel_mm = Vec3(within(0.2), within(0.5), -1.0);
  cut.tip_mm = Vec3(within(0.01), within(0.01), within(0.01));
  cut.edge_rise = Angle::from_deg(m.tilt == Tilt::table ? 0.0 : 20.0 + within(15.0));
  return cut;
}

/// The closed forms must be the derivatives of the kinematics for all axis positions and all tilts of the axes.
RC_GTEST_PROP(Setup, ChangesArePlanesOfMachinesThatDiffer, ()) {
  const Machine m = any_machine(*rc::gen::arbitrary<bool>());
  const EdgeCut cut = any_cut(m);
  const Vec3 outward = machine_from_workpiece(m, rotary_pose(m, cut.at)).inverse().direction(plunged_normal(m));
  const CutPlane plane = cut_plane(m, cut, outward);
  for (const SetupQuantity& quantity : setup_quantities(m.tilt)) {
    const PlaneChange change = plane_change(m, cut, quantity, outward);
    // Central differences over 20 um or 20 arcsec. Their error is of third order.
    constexpr double kStep = 10.0;
    const CutPlane more = cut_plane(with_error(m, quantity, kStep), cut, outward);
    const CutPlane less = cut_plane(with_error(m, quantity, -kStep), cut, outward);
    RC_ASSERT(((more.point_mm - less.point_mm) / (2.0 * kStep) - change.point_mm).norm() < 2e-10);
    RC_ASSERT(((more.normal - less.normal) / (2.0 * kStep) - change.normal).norm() < 2e-11);
    const Vec3 over = plane.point_mm + Vec3(within(1.0), within(1.0), within(1.0));
    const double height = (more.height_mm(over, outward) - less.height_mm(over, outward)) / (2.0 * kStep);
    // The height over a plane is proportional to one over the cosine of the angle between the normal and the direction.
    // The third derivative, which determines the error of the differences, is proportional to the fourth power of this
    // factor.
    const double facing = std::pow(plane.normal.dot(outward), 2);
    RC_ASSERT(std::abs(height - change.height_mm(plane, over, outward)) < 2e-10 / facing * (1.0 + 1e-2 / facing));
  }
}

/// A common displacement of axes and tool has the same effect as a displacement of the blank, so cuts cannot
/// distinguish them. The axis C is a line. If it is vertical, the Z coordinate of its point has no effect.
RC_GTEST_PROP(Setup, ShiftsOfAllAreThatOfTheBlank, ()) {
  Machine m = any_machine(false);
  const bool is_along_z = *rc::gen::arbitrary<bool>();
  if (is_along_z) m.c.direction.value = Vec3::UnitZ();
  const EdgeCut cut = any_cut(m);
  const std::vector<const char*> keys = is_along_z ? std::vector<const char*>{"a_z_um", "tool_z_um"}
                                                   : std::vector<const char*>{"c_y_um", "a_y_um", "tool_y_um"};
  Vec3 shift = Vec3::Zero();
  for (const char* const key : keys)
    shift += plane_change(m, cut, *setup_quantity(m.tilt, key), Vec3::UnitZ()).point_mm;
  RC_ASSERT((shift - 1e-3 * Vec3::Unit(is_along_z ? 2 : 1)).norm() < 1e-12);
}

TEST(Setup, KeysAreDistinctAndFound) {
  for (const Tilt tilt : {Tilt::table, Tilt::head}) {
    std::set<std::string_view> keys;
    for (const SetupQuantity& quantity : setup_quantities(tilt)) {
      EXPECT_TRUE(keys.insert(quantity.key).second) << quantity.key;
      EXPECT_EQ(setup_quantity(tilt, quantity.key)->description, quantity.description);
      EXPECT_TRUE(quantity.key.ends_with(quantity.unit())) << quantity.key;
    }
    EXPECT_EQ(keys.size(), 17U);
  }
  EXPECT_EQ(setup_quantity(Tilt::head, "a_z_um"), nullptr);
}

}  // namespace
}  // namespace retrace::fabrication::setup_test
