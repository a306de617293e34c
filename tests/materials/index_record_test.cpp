// Tests of records of the refractiveindex.info database. tests/data/refractiveindex/N-BK7.yml is a published record
// (CC0).

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "materials/io/index_record.h"
#include "materials/io/material_library.h"
#include "tests/support/refusals.h"

namespace retrace::materials::index_record_test {
namespace {

Material record(const std::string& data) {
  return parse_index_record("DATA:\n" + data, "glass.yml");
}

Material formula(int number, const std::string& coefficients) {
  return record("  - type: formula " + std::to_string(number) +
                "\n    wavelength_range: 0.2 3\n    coefficients: " + coefficients + "\n");
}

double index_at(const Material& material, double w_um) {
  return refractive_index(material.dispersion, 1e3 * w_um);
}

std::string complaint(const std::string& text) {
  return refusal_of([&] { parse_index_record(text, "glass.yml"); });
}

TEST(IndexRecord, IsTheGlassThatIsShipped) {
  const Material read = read_index_record(std::string(RETRACE_SOURCE_DIR) + "/tests/data/refractiveindex/N-BK7.yml");
  const MaterialLibrary library = MaterialLibrary::shipped();
  const Material& shipped = library.find("N-BK7");
  EXPECT_EQ(read.name, "N-BK7");
  EXPECT_EQ(read.valid_from_nm, 300.0);
  EXPECT_EQ(read.valid_to_nm, 2500.0);
  EXPECT_EQ(read.temperature_c, 20.0);
  EXPECT_FALSE(read.relative_to_vacuum);
  EXPECT_TRUE(read.warnings.empty());
  // The record states n_d = 1.5168 and V_d = 64.17.
  const double n_d = index_at(read, 0.58756);
  EXPECT_NEAR(n_d, 1.5168, 1e-5);
  EXPECT_NEAR((n_d - 1.0) / (index_at(read, 0.48613) - index_at(read, 0.65627)), 64.17, 5e-3);
  for (const double wavelength_nm : {400.0, 500.0, 700.0}) {
    EXPECT_NEAR(index_relative_to_air(read, library.air(), wavelength_nm, 60.0),
                index_relative_to_air(shipped, library.air(), wavelength_nm, 60.0), 1e-9);
    EXPECT_NEAR(absorption_per_mm(read, wavelength_nm), absorption_per_mm(shipped, wavelength_nm), 2e-6);
  }
}

TEST(IndexRecord, KnowsTheNineFormulas) {
  for (const double w : {0.4, 0.5876, 1.1}) {
    const double w2 = w * w;
    EXPECT_NEAR(index_at(formula(1, "0.5 1.1 0.1 0.9 9"), w),
                std::sqrt(1.5 + 1.1 * w2 / (w2 - 0.01) + 0.9 * w2 / (w2 - 81.0)), 1e-14);
    EXPECT_NEAR(index_at(formula(2, "0.5 1.1 0.01 0.9 81"), w), index_at(formula(1, "0.5 1.1 0.1 0.9 9"), w), 1e-14);
    EXPECT_NEAR(index_at(formula(3, "2.2 -0.01 2 0.02 -2 0.001 -4"), w),
                std::sqrt(2.2 - 0.01 * w2 + 0.02 / w2 + 0.001 / (w2 * w2)), 1e-14);
    EXPECT_NEAR(index_at(formula(4, "2.1 0.3 1 0.1 2 0.2 2 5 2 0.03 -2"), w),
                std::sqrt(2.1 + 0.3 * w / (w2 - 0.01) + 0.2 * w2 / (w2 - 25.0) + 0.03 / w2), 1e-14);
    EXPECT_NEAR(index_at(formula(5, "1.48 0.004 -2 0.0001 -4"), w), 1.48 + 0.004 / w2 + 0.0001 / (w2 * w2), 1e-14);
    EXPECT_NEAR(index_at(formula(6, "0 0.0579 238 0.00168 57.4"), w),
                1.0 + 0.0579 / (238.0 - 1.0 / w2) + 0.00168 / (57.4 - 1.0 / w2), 1e-14);
    const double l = 1.0 / (w2 - 0.028);
    EXPECT_NEAR(index_at(formula(7, "1.5 0.004 0.0002 -0.003 0.0004 0.00005"), w),
                1.5 + 0.004 * l + 0.0002 * l * l - 0.003 * w2 + 0.0004 * w2 * w2 + 0.00005 * w2 * w2 * w2, 1e-14);
    const double n = index_at(formula(8, "0.2 0.1 0.02 -0.01"), w);
    EXPECT_NEAR((n * n - 1.0) / (n * n + 2.0), 0.2 + 0.1 * w2 / (w2 - 0.02) - 0.01 * w2, 1e-14);
    const double off = w - 0.3;
    EXPECT_NEAR(index_at(formula(9, "2.5 0.015 0.03 0.02 0.3 1.2"), w),
                std::sqrt(2.5 + 0.015 / (w2 - 0.03) + 0.02 * off / (off * off + 1.2)), 1e-14);
  }
  // Missing coefficients are 0. A resonance with the strength 0 causes no pole.
  EXPECT_NEAR(index_at(formula(2, "1.25"), 0.5), 1.5, 1e-15);
  EXPECT_NEAR(index_at(formula(4, "2.25"), 0.5), 1.5, 1e-15);
  EXPECT_NEAR(index_at(formula(2, "1.25 0 0.25"), 0.5), 1.5, 1e-15);
}

TEST(IndexRecord, TablesAreLinearAndEndWhereTheyEnd) {
  const Material material = record("  - type: tabulated nk\n    data: |\n      0.6 1.49 2e-7\n      0.4 1.51 1e-7\n");
  EXPECT_NEAR(index_at(material, 0.45), 1.505, 1e-15);
  EXPECT_NEAR(absorption_per_mm(material, 400.0), 4.0 * std::numbers::pi * 1e-7 / 400e-6, 1e-12);
  EXPECT_EQ(refusal_of([&] { index_at(material, 0.61); }), "refused");
}

TEST(IndexRecord, ConditionsAreHeard) {
  const std::string data = "DATA:\n  - type: formula 5\n    wavelength_range: 0.3 1\n    coefficients: 1.5\n";
  EXPECT_TRUE(parse_index_record(data + "CONDITIONS:\n  n_is_absolute: true\n", "a.yml").relative_to_vacuum);
  EXPECT_FALSE(parse_index_record(data, "a.yml").relative_to_vacuum);
  EXPECT_NEAR(parse_index_record(data + "CONDITIONS:\n  temperature: 313.15\n", "a.yml").temperature_c, 40.0, 1e-9);
}

TEST(IndexRecord, WhatIsWrongIsToldWithItsLine) {
  EXPECT_EQ(complaint(""), "glass.yml: DATA");
  EXPECT_EQ(complaint("DATA: []"), "glass.yml: DATA");
  EXPECT_EQ(complaint("DATA: ["), "glass.yml:1");
  EXPECT_EQ(complaint("DATA:\n  - type: tabulated k\n    data: 0.5 1e-7\n"), "glass.yml:2: DATA");
  const std::string formula = "DATA:\n  - type: formula 2\n    wavelength_range: 0.3 1\n    coefficients: 0 1 x\n";
  EXPECT_EQ(complaint(formula), "glass.yml:4: coefficients");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = formula;
    return complaint(text.replace(text.find(from), from.size(), to));
  };
  EXPECT_EQ(with("formula 2", "formula 10"), "glass.yml:2: type");
  EXPECT_EQ(with("formula 2", "polynomial"), "glass.yml:2: type");
  EXPECT_EQ(with("0.3 1", "1 0.3"), "glass.yml:3: wavelength_range");
  EXPECT_EQ(with("coefficients", "factors"), "glass.yml:2: coefficients");
  const auto table = [&](const std::string& data) {
    return complaint("DATA:\n  - type: tabulated n\n    data: |\n      " + data + "\n");
  };
  expect_refusals(table, {{"0.4 1.5 0.5", "glass.yml:4: data"},
                          {"0.4 1.5\n      0.5\n      1.5 0.6\n      1.5", "glass.yml:5: data"},
                          {"0.4 1.5 0.4 1.6", "glass.yml:4: data"},
                          {"-0.4 1.5", "glass.yml:4: data"},
                          {"0.5 1.5\n      0.4 nan", "glass.yml:5: data"},
                          {"0.4 -1.5", "glass.yml:4: data"},
                          {"", "glass.yml:3: data"}});
  EXPECT_EQ(table("0.4 1.5\n      0.4 1.5\n      0.6 1.4"), "") << "equal rows count one time";
}

// A formula is complete only for certain numbers of coefficients, because each of its terms needs all its coefficients.
// All other numbers are refused. The expected numbers are derived from the formulas of the database.
TEST(IndexRecord, CutTermsAreRefused) {
  const auto is_whole = [](int number, int count) {
    switch (number) {
      case 4: return count == 1 || count == 5 || (count >= 9 && count % 2 == 1);
      case 7: return count <= 6;
      case 8: return count == 1 || count == 3 || count == 4;
      case 9: return count == 1 || count == 3 || count == 6;
      default: return count % 2 == 1;
    }
  };
  for (int number = 1; number <= 9; ++number) {
    std::string coefficients;
    for (int count = 1; count <= 17; ++count) {
      coefficients += (count > 1 ? " " : "") + std::to_string(0.01 * count);
      SCOPED_TRACE("formula " + std::to_string(number) + ": " + coefficients);
      const auto read = [&] { formula(number, coefficients); };
      // Only the message for 8 coefficients is recorded.
      EXPECT_EQ(count == 8 ? refusal_of(read) : unrecorded_refusal_of(read),
                is_whole(number, count) ? "" : "glass.yml:4: coefficients");
    }
  }
}

const std::string kHead = "DATA:\n  - type: formula 5\n    wavelength_range: 0.3 1\n    coefficients: 1.5\n";

/// Returns a material with n = 1.5 from a record with these rows of k. The first row is in line 7 of the record.
Material with_k(const std::vector<std::string>& rows) {
  std::string text = kHead + "  - type: tabulated k\n    data: |\n";
  for (const std::string& row : rows) text += "        " + row + "\n";
  return parse_index_record(text, "glass.yml");
}

// A row of k that cannot be used affects neither the index nor the other rows. A warning reports the line of this row.
TEST(IndexRecord, BlemishesOfTheExtinctionAreWarnedOf) {
  const std::vector<std::string> good = {"0.40 1e-8", "0.60 3e-8", "0.70 1e-8"};
  const Material right = with_k(good);
  ASSERT_TRUE(right.warnings.empty());
  for (const std::string bad :
       {"0.50 -999", "0.50 -1e-3", "0.50 nan", "0.50 -", "0.50", "-0.50 1e-8", "0 1e-8", "0.40 2e-8 0.45", "x 1e-8"}) {
    for (std::size_t at = 0; at <= good.size(); ++at) {
      std::vector<std::string> rows = good;
      rows.insert(rows.begin() + static_cast<std::ptrdiff_t>(at), bad);
      SCOPED_TRACE(bad + " as row " + std::to_string(at));
      const Material material = with_k(rows);
      EXPECT_EQ(index_at(material, 0.5), 1.5);
      ASSERT_GE(material.warnings.size(), 1U);
      EXPECT_EQ(facts_of(material.warnings.front()),
                "absorption_sample_ignored at glass.yml:" + std::to_string(7 + at) + ": data");
      for (const double wavelength_nm : {500.0, 600.0, 700.0})
        EXPECT_EQ(absorption_per_mm(material, wavelength_nm), absorption_per_mm(right, wavelength_nm));
    }
  }
  for (const std::string& row : good) {  // duplicates each row, at every position
    for (std::size_t at = 0; at <= good.size(); ++at) {
      std::vector<std::string> rows = good;
      rows.insert(rows.begin() + static_cast<std::ptrdiff_t>(at), row);
      const Material material = with_k(rows);
      EXPECT_TRUE(material.warnings.empty());
      for (const double wavelength_nm : {400.0, 500.0, 650.0})
        EXPECT_EQ(absorption_per_mm(material, wavelength_nm), absorption_per_mm(right, wavelength_nm));
    }
  }
}

TEST(IndexRecord, NoiseBelowZeroCountsAsZero) {
  const Material material = with_k({"0.40 1e-8", "0.50 -8e-10", "0.70 1e-8"});
  EXPECT_EQ(index_at(material, 0.5), 1.5);
  EXPECT_EQ(absorption_per_mm(material, 500.0), 0.0);
  EXPECT_NEAR(absorption_per_mm(material, 400.0), 4.0 * std::numbers::pi * 1e-8 / 400e-6, 1e-15);
  ASSERT_EQ(material.warnings.size(), 1U);
  EXPECT_EQ(facts_of(material.warnings.front()), "absorption_sample_ignored at glass.yml:8: data");
  const Material two = with_k({"0.40 -1e-9", "0.50 -8e-10", "0.70 1e-8"});
  ASSERT_EQ(two.warnings.size(), 1U);
  EXPECT_EQ(facts_of(two.warnings.front()), "absorption_sample_ignored at glass.yml:7: data");
}

TEST(IndexRecord, ContradictoryRowsOfTheExtinctionAreLeftOut) {
  const Material material = with_k({"0.40 1e-8", "0.50 2e-8", "0.50 7e-8", "0.70 1e-8"});
  ASSERT_EQ(material.warnings.size(), 1U);
  EXPECT_EQ(facts_of(material.warnings.front()), "absorption_sample_ignored at glass.yml:8: data");
  EXPECT_EQ(absorption_per_mm(material, 500.0), absorption_per_mm(with_k({"0.40 1e-8", "0.70 1e-8"}), 500.0));
}

// In a table of n and k, the index does not depend on the values of k. Tables of k that cannot be read are left out.
TEST(IndexRecord, ExtinctionNeverRefusesTheIndex) {
  const Material nk = record("  - type: tabulated nk\n    data: |\n      0.4 1.5 1e-8\n      0.6 1.4 -999\n");
  EXPECT_NEAR(index_at(nk, 0.5), 1.45, 1e-15);
  EXPECT_EQ(nk.warnings.size(), 1U);
  for (const std::string table : {"    rows: 0.5 1e-8\n", "    data: [0.5, 1e-8]\n", "    data: ''\n"}) {
    const Material material = parse_index_record(kHead + "  - type: tabulated k\n" + table, "glass.yml");
    EXPECT_EQ(index_at(material, 0.5), 1.5);
    EXPECT_EQ(material.warnings.size(), 1U) << table;
    EXPECT_EQ(absorption_per_mm(material, 500.0), 0.0);
  }
  const std::string k = "  - type: tabulated k\n    data: 0.5 1e-8\n";
  const Material twice = parse_index_record(kHead + k + k, "glass.yml");
  ASSERT_EQ(twice.warnings.size(), 1U);
  EXPECT_EQ(facts_of(twice.warnings.front()), "absorption_table_ignored at glass.yml:7: type");
  const Material nothing = with_k({"0.5 -999"});
  EXPECT_EQ(nothing.warnings.size(), 2U) << "one for the sample, one that no absorption is left";
}

TEST(IndexRecord, StatedNdIsChecked) {
  for (const std::string table : {"PROPERTIES", "SPECS"}) {
    const auto warnings = [&](const std::string& nd) {
      return parse_index_record(kHead + table + ":\n  nd: " + nd + "\n", "glass.yml").warnings;
    };
    EXPECT_TRUE(warnings("1.5009").empty());
    ASSERT_EQ(warnings("1.5168").size(), 1U);
    EXPECT_EQ(facts_of(warnings("1.5168").front()), "index_disagrees at glass.yml:6: nd");
  }
}

}  // namespace
}  // namespace retrace::materials::index_record_test
