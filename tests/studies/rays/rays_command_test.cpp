// Tests of the command `retrace rays`: its files, which an independent reader reads, and the inputs that it refuses.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <string>

#include "tests/app/program.h"
#include "tests/studies/rays/tm25_bytes.h"

namespace retrace::test::rays_command_test {
namespace {

using retrace::testing::tm25_bytes::File;
using retrace::testing::tm25_bytes::file_of;

const std::string kBricks =
    "[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\narrangement = \"offset\"\nx_length_mm = "
    "6\ny_length_mm = 4\n[body]\nthickness_mm = 1\nmaterial = \"PMMA\"\n";

/// Returns a ray file with 300 rays of a lamp above the center of the part. Each ray has all items that are possible in
/// a set with wavelengths.
File lamp() {
  File file;
  file.radiant = 6.0F;
  file.spectral_identifier = 2;
  file.flags = {1, 1, 1, 1, 0, 1, 0, 0};
  file.date = "2013-09-04T08:30:29+01:00";
  file.texts[0] = U"LED";
  for (int k = 0; k < 300; ++k) {
    const float x = 0.01F * static_cast<float>(k % 17);
    const auto wavelength = 450.0F + static_cast<float>(k % 3) * 80.0F;
    file.values.push_back({1.0F + x, 2.0F, 5.0F, 0, 0, -1, 0.02F, wavelength, 0.5F, 0, 0, 1, 0, 0});
  }
  return file;
}

class Rays : public ::testing::Test {
 protected:
  Rays() {
    folder_.write("bricks.toml", kBricks);
    folder_.write("lamp.tm25ray", bytes_of(lamp()));
    folder_.write("rays.csv", "x_mm,y_mm,z_mm,dx,dy,dz,power_w\n2.2,2.1,5,0,0,-1,1\n");
  }
  TemporaryFolder folder_;
};

TEST_F(Rays, WhatLeavesIsWrittenInTheFormatOfTheSource) {
  const Json json =
      retrace_json(folder_, {"rays", "bricks.toml", "--source=lamp.tm25ray", "-o", "out.tm25ray", "--seed=3"});
  EXPECT_EQ(json["schema"], "retrace.rays/1");
  EXPECT_EQ(json["rays"], 300);
  EXPECT_EQ(json["power_unit"], "W");
  EXPECT_NEAR(json["power"].get<double>(), 6.0, 1e-6);
  EXPECT_EQ(json["source"]["spectral_identifier"], 2);
  EXPECT_EQ(json["wavelengths_nm"], Json::array({450.0, 610.0}));
  double shares = 0.0;
  for (const auto& [account, share] : json["ledger"].items()) shares += share.get<double>();
  EXPECT_NEAR(shares, 1.0, 1e-9);

  const File out = file_of(folder_.read("out.tm25ray"));
  EXPECT_EQ(out.version, 2013);
  EXPECT_EQ(out.spectral_identifier, 2);
  EXPECT_EQ(out.flags, (std::array<std::int32_t, 8>{1, 1, 1, 1, 0, 1, 0, 0}));
  EXPECT_EQ(out.items, std::vector<std::u32string>{U"account"});
  EXPECT_EQ(out.date, "2013-09-04T08:30:29+01:00");
  EXPECT_EQ(out.texts[0], U"LED");
  EXPECT_TRUE(out.more.starts_with(U"account: 0 = retroreflected, 1 = front_specular,"));
  EXPECT_EQ(out.min_wavelength, 450.0F);
  EXPECT_EQ(out.greatest_wavelength, 610.0F);
  EXPECT_EQ(out.rays, json["out"]["rays"].get<std::uint64_t>());
  EXPECT_TRUE(std::isnan(out.luminous));
  constexpr std::array<const char*, 6> kAccounts = {"retroreflected",     "front_specular", "scattered_out",
                                                    "returned_elsewhere", "side_exit",      "transmitted"};
  std::map<std::string, double> power;
  double sum = 0.0;
  for (const std::vector<float>& ray : out.values) {
    ASSERT_EQ(ray.size(), 15U);
    EXPECT_NEAR(ray[3] * ray[3] + ray[4] * ray[4] + ray[5] * ray[5], 1.0F, 1e-6F);
    EXPECT_LE(ray[8] * ray[8] + ray[9] * ray[9] + ray[10] * ray[10], 1.0F + 1e-6F);
    EXPECT_NEAR(ray[3] * ray[11] + ray[4] * ray[12] + ray[5] * ray[13], 0.0F, 1e-6F);
    power[kAccounts.at(static_cast<std::size_t>(ray[14]))] += ray[6];
    sum += ray[6];
  }
  EXPECT_NEAR(out.radiant, sum, 1e-5 * sum);
  for (const auto& [account, watts] : power)
    EXPECT_NEAR(watts / 6.0, json["ledger"][account].get<double>(), 1e-5) << account;
}

TEST_F(Rays, WhatIsWrittenCanBeASource) {
  ASSERT_EQ(retrace(folder_, {"rays", "bricks.toml", "--source=lamp.tm25ray", "-o", "once.tm25ray"}).code, 0);
  const Json again =
      retrace_json(folder_, {"rays", "bricks.toml", "--source=once.tm25ray", "--keep-missed", "-o", "twice.csv"});
  // Rays that have left the part do not hit it again, although the file stores their positions only in single
  // precision.
  EXPECT_EQ(again["ledger"]["missed"], 1.0);
  const Json json = retrace_json(folder_, {"rays", "bricks.toml", "--source=twice.csv"});
  EXPECT_EQ(json["rays"], again["out"]["rays"]);
  EXPECT_NEAR(json["power"].get<double>(), again["power"].get<double>(), 1e-9);
}

TEST_F(Rays, TheSameBytesWithAnyNumberOfThreads) {
  for (const char* format : {"tm25ray", "csv"}) {
    const auto bytes = [&](const std::string& threads) {
      const std::string file = "out_" + threads + "." + format;
      const Outcome outcome =
          retrace(folder_, {"rays", "bricks.toml", "--emitter=lambertian", "--rays=9000", "--disc-mm=3", "--split=0.01",
                            "--stokes", "--keep-missed", "--threads", threads, "-o", file});
      EXPECT_EQ(outcome.code, 0) << outcome.err;
      return folder_.read(file);
    };
    EXPECT_TRUE(bytes("1") == bytes("3"));
  }
}

TEST_F(Rays, LuminousLightHasNoWavelengthsInTm25ButAsAnItem) {
  folder_.write("daylight.toml", kBricks + "[light]\nspectrum = \"D65\"\n");
  const Json json = retrace_json(
      folder_, {"rays", "daylight.toml", "--emitter=collimated", "--rays=500", "--power=40", "-o", "out.tm25ray"});
  EXPECT_EQ(json["power_unit"], "lm");
  const File out = file_of(folder_.read("out.tm25ray"));
  EXPECT_EQ(out.spectral_identifier, 0);
  EXPECT_EQ(out.flags, (std::array<std::int32_t, 8>{1, 1, 0, 0, 1, 0, 0, 0}));
  EXPECT_EQ(out.items, (std::vector<std::u32string>{U"account", U"wavelength_nm"}));
  EXPECT_TRUE(std::isnan(out.radiant));
  EXPECT_GT(out.luminous, 10.0F);
  for (const std::vector<float>& ray : out.values) EXPECT_TRUE(ray[8] > 400.0F && ray[8] < 720.0F) << ray[8];
}

TEST_F(Rays, OneRayOfATable) {
  const Outcome outcome = retrace(folder_, {"rays", "bricks.toml", "--source=rays.csv", "--split=0", "-o", "out.csv"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("retroreflected"), std::string::npos);
  const std::vector<std::string> lines = lines_of(folder_.read("out.csv"));
  EXPECT_EQ(lines.at(0), "ray,account,x_mm,y_mm,z_mm,dx,dy,dz,power_w");
  EXPECT_TRUE(lines.at(1).starts_with("1,"));
}

TEST_F(Rays, WrongInputIsRefusedAndNothingIsWritten) {
  File negative = lamp();
  negative.values[200][6] = -1.0F;
  folder_.write("negative.tm25ray", bytes_of(negative));
  folder_.write("short.tm25ray", bytes_of(lamp()).substr(0, 36000));
  folder_.write("image.tm25ray", "\x89PNG");
  folder_.write("wrong.csv", "x_mm,y_mm,z_mm,dx,dy,dz,power_w\n1,1,1,0,0,-1,1\n1,1,1,0,0,-1,-2\n");
  expect_refused(folder_,
                 {{{}, "--source"},
                  {{"--source=none.csv"}, "none.csv"},
                  {{"--source=."}, "--source"},
                  {{"--source=lamp.ray"}, "--source"},
                  {{"--source=negative.tm25ray"}, "negative.tm25ray"},
                  {{"--source=short.tm25ray"}, "short.tm25ray"},
                  {{"--source=image.tm25ray"}, "image.tm25ray"},
                  {{"--source=wrong.csv"}, "wrong.csv:3: power_w"},
                  {{"--emitter=laser"}, "--emitter"},
                  {{"--emitter=gaussian", "--half-angle-deg=nan"}, "--half-angle-deg"},
                  {{"--emitter=gaussian", "--at-mm=1,2"}, "--at-mm"},
                  {{"--emitter=gaussian", "--split=2"}, "--split"}},
                 {"rays", "bricks.toml"}, {"-o", "out.tm25ray", "--json", "r.json"});
  EXPECT_EQ(refused_at(retrace(folder_, {"rays", "bricks.toml", "--source=rays.csv", "-o", "out.txt"})), "--out");
  EXPECT_EQ(refused_at(retrace(folder_, {"rays", "bricks.toml", "--source=rays.csv", "-o", "rays.csv"})), "--out");
  EXPECT_EQ(retrace(folder_, {"rays", "bricks.toml", "--source=rays.csv", "-o", "no/out.csv"}).code, 3);
}

TEST_F(Rays, AnInterruptKeepsWhatIsTraced) {
  Child child(folder_.path(), {RETRACE_PROGRAM, "rays", "bricks.toml", "--emitter=lambertian", "--rays=1000000000",
                               "-o", "out.tm25ray", "--json", "r.json"});
  while (child.processor_time_s() < 0.5 && !child.has_ended()) continue;
  child.interrupt();
  const Outcome outcome = child.wait(patient(20));
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  const Json json = folder_.json("r.json");
  EXPECT_FALSE(json["complete"].get<bool>());
  EXPECT_EQ(file_of(folder_.read("out.tm25ray")).rays, json["out"]["rays"].get<std::uint64_t>());
}

}  // namespace
}  // namespace retrace::test::rays_command_test
