// Tests of TM-25 ray files: every item is read from its position, and wrong files are refused with the position of the
// byte.
#include "studies/rays/io/tm25.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include "tests/studies/rays/tm25_bytes.h"
#include "tests/support/refusals.h"

namespace retrace::testing::tm25_test {
namespace {

using namespace studies;
using tm25_bytes::File;

constexpr std::size_t kTables = 36288;  // start of the spectral tables

Tm25Source source_of(const std::string& bytes) {
  return {{std::make_unique<std::istringstream>(bytes), bytes.size()}, "led.tm25ray"};
}

std::vector<SetRay> rays_of(Tm25Source& source) {
  std::vector<SetRay> all;
  std::vector<SetRay> some;
  while (source.read(2, some)) all.insert(all.end(), some.begin(), some.end());
  return all;
}

/// Returns a file with three rays that have radiant flux only.
File plain() {
  File file;
  file.radiant = 6.0F;
  file.values = {{1, 2, 3, 0, 0, -1, 1}, {4, 5, 6, 0, 0.6F, 0.8F, 2}, {7, 8, 9, 1, 0, 0, 3}};
  return file;
}

/// Returns a file with one ray and with everything that a set of spectra may contain.
File full() {
  File file;
  file.radiant = 2.0F;
  file.spectral_identifier = 4;
  file.flags = {1, 1, 1, 0, 0, 1, 0, 1};
  file.tables = {{{400.0F, 1.0F}}, {{500.0F, 0.0F}, {600.0F, 2.0F}, {700.0F, 0.0F}}};
  file.items = {U"phase"};
  file.more = U"more";
  file.texts[0] = U"LED \u00b5";
  file.texts[6] = U"350 mA";
  file.date = "2013-09-04T08:30:29+01:00";
  file.values = {{1, 2, 3, 0, 0, 1, 2, 0.5F, 0.25F, -0.125F, 0, 1, 0, 2, 99}};
  return file;
}

TEST(Tm25, PlainRaysAreRead) {
  Tm25Source source = source_of(bytes_of(plain()));
  EXPECT_EQ(source.info().rays, 3U);
  EXPECT_EQ(source.info().radiant_w, 6.0);
  EXPECT_TRUE(source.info().has_radiant);
  EXPECT_FALSE(source.info().has_luminous || source.info().has_stokes || source.info().has_tristimulus);
  EXPECT_EQ(source.fraction_read(), 0.0);
  const std::vector<SetRay> rays = rays_of(source);
  ASSERT_EQ(rays.size(), 3U);
  EXPECT_EQ(rays[1].position_mm, Vec3(4, 5, 6));
  EXPECT_NEAR((rays[1].direction - Vec3(0, 0.6, 0.8)).norm(), 0.0, 1e-7);
  EXPECT_EQ(rays[2].radiant_w, 3.0);
  EXPECT_EQ(source.fraction_read(), 1.0);
  EXPECT_TRUE(source.warnings().empty());
}

TEST(Tm25, EveryItemIsReadWhereItStands) {
  Tm25Source source = source_of(bytes_of(full()));
  const RaySetInfo& info = source.info();
  EXPECT_EQ(info.spectrum, RaySpectrum::table_of_each);
  ASSERT_EQ(info.tables.size(), 2U);
  EXPECT_EQ(info.tables[1].wavelengths_nm, (std::vector<double>{500, 600, 700}));
  EXPECT_EQ(info.tables[1].values, (std::vector<double>{0, 2, 0}));
  EXPECT_EQ(info.text(RayText::light_source), U"LED \u00b5");
  EXPECT_EQ(info.text(RayText::operation), U"350 mA");
  EXPECT_EQ(info.date, "2013-09-04T08:30:29+01:00");
  const std::vector<SetRay> rays = rays_of(source);
  ASSERT_EQ(rays.size(), 1U);
  EXPECT_EQ(rays[0].table, 2U);
  EXPECT_EQ(rays[0].radiant_w, 2.0);
  EXPECT_EQ(rays[0].stokes, (std::array<double, 3>{0.5, 0.25, -0.125}));
  EXPECT_EQ(rays[0].axis, Vec3(0, 1, 0));
  ASSERT_EQ(source.warnings().size(), 1U);
  EXPECT_EQ(facts_of(source.warnings()[0]), "items_omitted at led.tm25ray");
}

TEST(Tm25, LuminousFluxAndTristimulusValuesAreRead) {
  File file;
  file.luminous = 10.0F;
  file.radiant = std::numeric_limits<float>::quiet_NaN();
  file.flags = {1, 1, 0, 0, 1, 0, 1, 0};
  file.values = {{0, 0, 0, 0, 0, 1, 10, 7, 8}};
  Tm25Source source = source_of(bytes_of(file));
  EXPECT_FALSE(source.info().radiant_w);
  const std::vector<SetRay> rays = rays_of(source);
  EXPECT_EQ(rays.at(0).luminous_lm, 10.0);
  EXPECT_EQ(rays.at(0).tristimulus_x, 7.0);
  EXPECT_EQ(rays.at(0).tristimulus_z, 8.0);
}

TEST(Tm25, WavelengthsOfEachRayAreRead) {
  File file;
  file.spectral_identifier = 2;
  file.flags = {1, 1, 1, 1, 0, 0, 0, 0};
  file.values = {{0, 0, 0, 0, 0, 1, 10, 555}};
  Tm25Source source = source_of(bytes_of(file));
  EXPECT_EQ(rays_of(source).at(0).wavelength_nm, 555.0);
}

TEST(Tm25, WhatDoesNotAddUpIsTold) {
  File file = plain();
  file.radiant = 7.0F;
  file.values[1][4] = 0.7F;  // not a unit vector
  Tm25Source source = source_of(bytes_of(file));
  EXPECT_NEAR(rays_of(source).at(1).direction.norm(), 1.0, 1e-15);
  const Warnings told = source.warnings();
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(facts_of(told[0]), "flux_disagrees at led.tm25ray");
  EXPECT_EQ(facts_of(told[1]), "directions_normalised at led.tm25ray");
}

std::string complaint(const std::string& bytes) {
  return refusal_of([&] {
    Tm25Source source = source_of(bytes);
    rays_of(source);
  });
}

template <class Change>
std::string complaint(File file, const Change& change) {
  change(file);
  return complaint(bytes_of(file));
}

TEST(Tm25, WrongHeadersAreRefusedWithTheirByte) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(complaint(plain(), [](File& f) { f.magic = "IES:"; }), "led.tm25ray: byte 0");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.version = 2020; }), "led.tm25ray: byte 4");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.radiant = -1.0F; }), "led.tm25ray: byte 16");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.luminous = INFINITY; }), "led.tm25ray: byte 12");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.values.clear(); }), "led.tm25ray: byte 20");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.rays = 1ULL << 62; }), "led.tm25ray: byte 36288");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.spectral_identifier = 5; }), "led.tm25ray: byte 60");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.spectral_identifier = 1, f.wavelength = 0.55F; }),
            "led.tm25ray: byte 64");
  EXPECT_EQ(complaint(plain(), [&](File& f) { f.spectral_identifier = 1, f.wavelength = nan; }),
            "led.tm25ray: byte 64");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.spectral_identifier = 3; }), "led.tm25ray: byte 76");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.flags[0] = 0; }), "led.tm25ray: byte 256");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.flags[5] = 2; }), "led.tm25ray: byte 276");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.flags[2] = 0; }), "led.tm25ray: byte 264");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.flags[2] = 0, f.flags[4] = f.flags[5] = 1; }), "led.tm25ray: byte 264");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.flags[6] = 1; }), "led.tm25ray: byte 272");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.spectral_identifier = 2; }), "led.tm25ray: byte 268");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.flags[7] = 1; }), "led.tm25ray: byte 284");
}

TEST(Tm25, WrongTablesAreRefusedWithTheirByte) {
  EXPECT_EQ(complaint(full(), [](File& f) { f.tables[0][0].first = 0.4F; }), "led.tm25ray: byte 36292");
  EXPECT_EQ(complaint(full(), [](File& f) { f.tables[0][0].second = -1.0F; }), "led.tm25ray: byte 36296");
  EXPECT_EQ(complaint(full(), [](File& f) { f.tables[0][0].second = 0.0F; }), "led.tm25ray: byte 36288");
  EXPECT_EQ(complaint(full(), [](File& f) { f.tables[1][1].first = 500.0F; }), "led.tm25ray: byte 36312");
  std::string bytes = bytes_of(full());
  const std::int32_t huge = INT32_MAX;
  std::memcpy(bytes.data() + kTables, &huge, 4);
  EXPECT_EQ(complaint(bytes), "led.tm25ray: byte 36292");
}

TEST(Tm25, WrongRaysAreRefusedWithTheirByte) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(complaint(plain(), [&](File& f) { f.values[1][2] = nan; }), "led.tm25ray: byte 36324");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.values[2][3] = INFINITY; }), "led.tm25ray: byte 36356");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.values[2][3] = 0.0F; }), "led.tm25ray: byte 36356");
  EXPECT_EQ(complaint(plain(), [](File& f) { f.values[2][6] = -3.0F; }), "led.tm25ray: byte 36368");
  EXPECT_EQ(complaint(full(), [](File& f) { f.values[0][7] = 1.0F; }), "led.tm25ray: byte 36924");
  EXPECT_EQ(complaint(full(), [](File& f) { f.values[0][11] = 0.0F, f.values[0][12] = 1.0F; }),
            "led.tm25ray: byte 36924");
  for (const float index : {0.0F, 3.0F, 1.5F})
    EXPECT_EQ(complaint(full(), [&](File& f) { f.values[0][13] = index; }), "led.tm25ray: byte 36948");
}

TEST(Tm25, ATruncatedFileIsRefusedWhereverItEnds) {
  const std::string bytes = bytes_of(full());
  for (std::size_t size = 0; size < bytes.size(); size += size < 400 ? 1 : 97) {
    const std::string place = unrecorded_refusal_of([&] {
      Tm25Source source = source_of(bytes.substr(0, size));
      rays_of(source);
    });
    EXPECT_TRUE(place.starts_with("led.tm25ray")) << place;
  }
  EXPECT_EQ(complaint(bytes + "more"), "led.tm25ray: byte 36896");
}

}  // namespace
}  // namespace retrace::testing::tm25_test
