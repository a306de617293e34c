// Tests of tables of rays: written tables are read again, and wrong tables are refused with line and column.
#include "studies/rays/io/ray_csv.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>

#include <filesystem>
#include <sstream>
#include <string>

#include "core/atomic_file.h"
#include "tests/support/refusals.h"

namespace retrace::testing::ray_csv_test {
namespace {

using namespace studies;

std::vector<SetRay> rays_of(RayCsvSource&& source) {
  std::vector<SetRay> all;
  std::vector<SetRay> some;
  while (source.read(2, some)) all.insert(all.end(), some.begin(), some.end());
  return all;
}

RayCsvSource source_of(const std::string& text) {
  return {{std::make_unique<std::istringstream>(text), text.size()}, "rays.csv"};
}

const std::string kNames = "x_mm,y_mm,z_mm,dx,dy,dz,power_w\n";

TEST(RayCsv, ColumnsMayStandInAnyOrder) {
  const std::vector<SetRay> rays =
      rays_of(source_of("\xEF\xBB\xBF# of a lamp\r\n\r\npower_w, dx,dy,dz, x_mm,y_mm,z_mm, "
                        "wavelength_nm\r\n2,0,3,4,1,2,3,555\r\n# end\r\n"));
  ASSERT_EQ(rays.size(), 1U);
  EXPECT_EQ(rays[0].position_mm, Vec3(1, 2, 3));
  EXPECT_NEAR((rays[0].direction - Vec3(0, 0.6, 0.8)).norm(), 0.0, 1e-15);
  EXPECT_EQ(rays[0].radiant_w, 2.0);
  EXPECT_EQ(rays[0].wavelength_nm, 555.0);
}

TEST(RayCsv, DirectionsMayHaveAnyLength) {
  for (const std::string length : {"1e-320", "1e-200", "1e-155", "1e155", "1e300"}) {
    const std::vector<SetRay> rays = rays_of(source_of(kNames + "1,2,3,0,0,-" + length + ",1\n"));
    ASSERT_EQ(rays.size(), 1U) << length;
    EXPECT_EQ(rays[0].direction, Vec3(0, 0, -1)) << length;
  }
}

TEST(RayCsv, TheLastLineMayEndWithTheFile) {
  EXPECT_EQ(rays_of(source_of(kNames + "0,0,0,0,0,1,1\n0,0,0,0,0,1,2")).at(1).radiant_w, 2.0);
}

TEST(RayCsv, WhatIsWrittenIsReadAgain) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("retrace_ray_csv_" + std::to_string(::getpid()) + ".csv");
  RayCsvSink sink(file);
  RaySinkLayout layout;
  layout.info.has_luminous = layout.info.has_stokes = layout.has_wavelengths = true;
  sink.begin(layout);
  AccountedRay ray;
  ray.position_mm = {0.1, -2.0 / 3.0, 1e-9};
  ray.direction = Vec3(1, 2, 3).normalized();
  ray.radiant_w = 0.25;
  ray.luminous_lm = 100.0 / 3.0;
  ray.wavelength_nm = 600.5;
  ray.stokes = {0.5, 0.0, -0.25};
  ray.axis = ray.direction.unitOrthogonal();
  ray.number = 1ULL << 40;
  ray.account = 4;
  sink.write({&ray, 1});
  sink.finish();
  const std::string text = read_file(file);
  EXPECT_TRUE(
      text.starts_with("ray,account,x_mm,y_mm,z_mm,dx,dy,dz,power_w,luminous_lm,wavelength_nm,s1,s2,s3,axis_x,"
                       "axis_y,axis_z\n1099511627776,side_exit,0.1,"));
  const std::vector<SetRay> rays = rays_of(RayCsvSource(file));
  std::filesystem::remove(file);
  ASSERT_EQ(rays.size(), 1U);
  EXPECT_EQ(rays[0].position_mm, ray.position_mm);
  EXPECT_NEAR((rays[0].direction - ray.direction).norm(), 0.0, 1e-15);
  EXPECT_EQ(rays[0].luminous_lm, ray.luminous_lm);
  EXPECT_EQ(rays[0].stokes, ray.stokes);
  EXPECT_NEAR((rays[0].axis - ray.axis).norm(), 0.0, 1e-15);
}

TEST(RayCsv, WhatIsWrongIsRefusedWithItsPlace) {
  expect_refusals([](const std::string& text) { return refusal_of([&] { rays_of(source_of(text)); }); },
                  {{"", "rays.csv"},
                   {"x_m\n", "rays.csv:1"},
                   {"x_mm,x_mm\n", "rays.csv:1"},
                   {"x_mm,y_mm,z_mm,dx,dy,power_w\n", "rays.csv:1"},
                   {"x_mm,y_mm,z_mm,dx,dy,dz\n", "rays.csv:1"},
                   {"x_mm,y_mm,z_mm,dx,dy,dz,power_w,s1\n", "rays.csv:1"},
                   {kNames + "1,2\n", "rays.csv:2"},
                   {kNames + "\n0,0,0,0,0,1,nan\n", "rays.csv:3: power_w"},
                   {kNames + "0,0,0,0,0,1,-1\n", "rays.csv:2: power_w"},
                   {kNames + "0,1 m,0,0,0,1,1\n", "rays.csv:2: y_mm"},
                   {kNames + "0,0,0,0,0,0,1\n", "rays.csv:2: dx"},
                   {"x_mm,y_mm,z_mm,dx,dy,dz,power_w,wavelength_nm\n0,0,0,0,0,1,1,0.55\n", "rays.csv:2: wavelength_nm"},
                   {kNames + "0,0,0,0,0,1,1\n0,0,0,0,0,1,1e308\n", "rays.csv:3: power_w"},
                   {kNames + "0,0,0,0,0,1,6e149\n0,0,0,0,0,1,3e149\n0,0,0,0,0,1,6e149\n", "rays.csv:4: power_w"}});
  EXPECT_EQ(refusal_of([&] { rays_of(source_of(kNames + std::string(1 << 17, '0'))); }), "rays.csv:2");
}

}  // namespace
}  // namespace retrace::testing::ray_csv_test
