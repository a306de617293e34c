#include "design/io/design_reader.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "design/io/init_templates.h"
#include "tests/studies/design_texts.h"
#include "tests/support/refusals.h"

namespace retrace::studies::design_reader_test {
namespace {

namespace fs = std::filesystem;
using geometry::AngleErrors;
using geometry::Arrangement;
using geometry::Extent;
using geometry::PartialElements;
using geometry::RowParity;
using geometry::RtpElement;

TEST(DesignReader, MinimalDesignHasTheDefaults) {
  const design::Design design = design::parse_design(joined(kLines), "d.toml", {});
  const auto& rtp = std::get<RtpElement>(design.part().element);
  EXPECT_EQ(design.source, "d.toml");
  EXPECT_EQ(design.title, "");
  EXPECT_EQ(rtp.base_mm, 0.5);
  EXPECT_EQ(rtp.width_mm, 0.5);
  EXPECT_EQ(rtp.apex_angle_deg, 90.0);
  EXPECT_EQ(design.part().array.arrangement, Arrangement::offset);
  EXPECT_EQ(design.part().array.extent, Extent::finite);
  EXPECT_EQ(design.part().array.shifted_rows, RowParity::even);
  EXPECT_EQ(design.part().array.partial_elements, PartialElements::cut);
  EXPECT_EQ(design.part().array.x_length_mm, 10.0);
  EXPECT_EQ(design.part().array.y_length_mm, 10.0);
  EXPECT_EQ(design.part().array.x_gap_mm, 0.0);
  EXPECT_EQ(design.part().array.y_offset_mm, 0.0);
  EXPECT_EQ(design.part().array.overlap_percent, 50.0);
  EXPECT_EQ(design.part().angle_errors, AngleErrors{});
  EXPECT_EQ(design.part().thickness_mm, 2.0);
  EXPECT_EQ(design.substance.material, "PMMA");
  EXPECT_FALSE(design.substance.refractive_index);
  EXPECT_EQ(design.substance.absorption_per_mm, design::Absorption());
  EXPECT_EQ(design.light.wavelength_nm(), 587.56);
  EXPECT_EQ(design.light.polarisation.values(), raytrace::kUnpolarised.values());
  EXPECT_EQ(design.detector.acceptance_half_angle_deg, std::vector<double>{0.5});
  EXPECT_FALSE(design.idealisation.mirror_facets);
  EXPECT_FALSE(design.idealisation.lossless_entrance);
}

TEST(DesignReader, EveryServedKeyArrives) {
  const design::Design design = design::parse_design(R"(schema = "retrace.design/1"
title = "all"
[element]
kind = "rtp"
base_mm = 1
width_mm = 2
apex_angle_deg = 91.5
[array]
arrangement = "offset"
extent = "finite"
shifted_rows = "odd"
partial_elements = "omit"
x_length_mm = 20
y_length_mm = 30
x_gap_mm = 0.1
y_gap_mm = 0.2
x_offset_mm = 1
y_offset_mm = 2
overlap_percent = 25
[body]
thickness_mm = 3
material = "PC"
refractive_index = 1.58
absorption_per_mm = 0.001
back_index = 1
facet_coating = "none"
[light]
wavelength_nm = 633
polarisation = "linear"
polarisation_angle_deg = 30
[detector]
acceptance_half_angle_deg = [1, 0.2, 0.5, 0.2]
[surface]
model = "smooth"
roughness_sq_nm = 0
walls = "smooth"
dihedral_error_arcmin = -0.5
facet_tilt_arcmin = [1, 2.5]
[idealisation]
facets = "mirror"
entrance = "lossless"
)",
                                                     "d.toml", {});
  EXPECT_EQ(design.title, "all");
  EXPECT_EQ(std::get<RtpElement>(design.part().element).apex_angle_deg, 91.5);
  EXPECT_EQ(design.part().array.shifted_rows, RowParity::odd);
  EXPECT_EQ(design.part().array.partial_elements, PartialElements::omit);
  EXPECT_EQ(design.part().array.y_length_mm, 30.0);
  EXPECT_EQ(design.part().array.x_gap_mm, 0.1);
  EXPECT_EQ(design.part().array.y_gap_mm, 0.2);
  EXPECT_EQ(design.part().array.x_offset_mm, 1.0);
  EXPECT_EQ(design.part().array.y_offset_mm, 2.0);
  EXPECT_EQ(design.part().array.overlap_percent, 25.0);
  EXPECT_EQ(design.substance.material, "PC");
  EXPECT_EQ(design.where("body.material").line, 22);
  EXPECT_EQ(design.where("body.material").key, "body.material");
  EXPECT_EQ(design.substance.refractive_index, 1.58);
  EXPECT_EQ(design.substance.absorption_per_mm, design::Absorption(0.001));
  EXPECT_EQ(design.light.wavelength_nm(), 633.0);
  EXPECT_NEAR(design.light.polarisation.q, 0.5, 1e-15);
  EXPECT_EQ(design.part().angle_errors, (AngleErrors{{-0.5, 0.0, 0.0}, {1.0, 2.5, 0.0}}));
  EXPECT_EQ(design.detector.acceptance_half_angle_deg, (std::vector<double>{0.2, 0.5, 1.0}));
  EXPECT_TRUE(design.idealisation.mirror_facets);
  EXPECT_TRUE(design.idealisation.lossless_entrance);
}

TEST(DesignReader, NumbersOutOfRangeAreRefused) {
  expect_refusals([](const std::string& given) { return complaint(given); },
                  {{with_line(3, "base_mm = -3"), "d.toml:3: element.base_mm"},
                   {with_line(3, "base_mm = 0"), "d.toml:3: element.base_mm"},
                   {with_line(3, "base_mm = 0.0"), "d.toml:3: element.base_mm"},
                   {with_line(3, "base_mm = inf"), "d.toml:3: element.base_mm"},
                   {with_line(3, "base_mm = nan"), "d.toml:3: element.base_mm"},
                   {with_line(3, "base_mm = 1e7"), "d.toml:3: element.base_mm"},
                   {with_line(3, "base_mm = 1e-7"), "d.toml:3: element.base_mm"},
                   {with_line(7, "x_length_mm = -inf"), "d.toml:7: array.x_length_mm"},
                   {with_line(10, "thickness_mm = 0"), "d.toml:10: body.thickness_mm"},
                   {with_line(11, "refractive_index = 0.9"), "d.toml:11: body.refractive_index"},
                   {with_line(11, "absorption_per_mm = -1"), "d.toml:11: body.absorption_per_mm"},
                   {with_line(11, "light.wavelength_nm = 0"), "d.toml:11: body.light"},
                   {with_line(11, "[light]\nwavelength_nm = 0"), "d.toml:12: light.wavelength_nm"}});
}

TEST(DesignReader, WholeNumbersOfAnySizeAreNumbers) {
  EXPECT_EQ(complaint(with_line(3, "base_mm = 9223372036854775807")), "d.toml:3: element.base_mm");
}

TEST(DesignReader, ApexAngleIsFrom60To120) {
  EXPECT_EQ(complaint(with_line(4, "width_mm = 0.5\napex_angle_deg = 59.9")), "d.toml:5: element.apex_angle_deg");
  EXPECT_EQ(complaint(with_line(4, "width_mm = 0.5\napex_angle_deg = 121")), "d.toml:5: element.apex_angle_deg");
  EXPECT_EQ(std::get<RtpElement>(set({"element.apex_angle_deg=60"}).part().element).apex_angle_deg, 60.0);
  EXPECT_EQ(std::get<RtpElement>(set({"element.apex_angle_deg=120"}).part().element).apex_angle_deg, 120.0);
}

TEST(DesignReader, AcceptanceIsANumberOrAListWithin90Degrees) {
  const auto refused = [](const std::string& value) {
    return complaint(with_line(11, "[detector]\nacceptance_half_angle_deg = " + value));
  };
  const std::string where = "d.toml:12: detector.acceptance_half_angle_deg";
  expect_refusals(refused, {{"0", where},
                            {"90.5", where},
                            {"[0.5, -1]", where},
                            {"[0.5,\n\"x\"]", "d.toml:13: detector.acceptance_half_angle_deg"},
                            {"[]", where},
                            {"\"a\"", where},
                            {"90", ""}});
}

TEST(DesignReader, WrongTypesAreRefused) {
  expect_refusals([](const std::string& given) { return complaint(given); },
                  {{with_line(3, "base_mm = \"0.5\""), "d.toml:3: element.base_mm"},
                   {with_line(3, "base_mm = true"), "d.toml:3: element.base_mm"},
                   {with_line(3, "base_mm = [1]"), "d.toml:3: element.base_mm"},
                   {with_line(3, "base_mm = {a = 1}"), "d.toml:3: element.base_mm"},
                   {with_line(3, "base_mm = 2020-01-01"), "d.toml:3: element.base_mm"},
                   {with_line(2, "kind = 5"), "d.toml:2: element.kind"},
                   {"title = 1\n" + joined(kLines), "d.toml:1: title"},
                   {"element = 3\n", "d.toml:1: element"},
                   {"[[element]]\nkind = \"rtp\"\n", "d.toml:1: element"}});
}

TEST(DesignReader, UnknownKeysAreNamedWithASuggestion) {
  EXPECT_EQ(complaint(with_line(3, "bse_mm = 0.5")), "d.toml:3: element.bse_mm");
  EXPECT_EQ(complaint(with_line(10, "thickness = 2")), "d.toml:10: body.thickness");
  EXPECT_EQ(complaint(with_line(11, "colour = \"red\"")), "d.toml:11: body.colour");
  EXPECT_EQ(complaint(with_line(11, "[boddy]\nx = 1")), "d.toml:11: boddy");
  EXPECT_EQ(complaint("titel = \"x\"\n" + joined(kLines)), "d.toml:1: titel");
  EXPECT_EQ(complaint("thickness_mm = 2\n" + joined(kLines)), "d.toml:1: thickness_mm");
}

TEST(DesignReader, TheFirstUnknownKeyOfTheFileIsReported) {
  const std::string text = "[light]\nzz = 1\naa = 2\n[array]\nbb = 3\n";
  EXPECT_EQ(complaint(text), "d.toml:2: light.zz");
  EXPECT_EQ(complaint(text, {"array.aa=1"}), "d.toml:2: light.zz");
}

TEST(DesignReader, MissingKeysAreReportedAtTheirTable) {
  expect_refusals([](const std::string& given) { return complaint(given); },
                  {{with_line(3, ""), "d.toml:1: element.base_mm"},
                   {with_line(2, ""), "d.toml:1: element.kind"},
                   {with_line(8, ""), "d.toml:5: array.y_length_mm"},
                   {with_line(10, ""), "d.toml:9: body.thickness_mm"},
                   {"[element]\nkind = \"hexagonal_icc\"\n", "d.toml:1: element.aperture_mm"},
                   {"", "d.toml: element.kind"}});
  EXPECT_EQ(complaint("", {"element.kind=rtp"}), "d.toml: element.base_mm");
}

TEST(DesignReader, WordsAreCheckedWithASuggestion) {
  EXPECT_EQ(complaint(with_line(2, "kind = \"rpt\"")), "d.toml:2: element.kind");
  EXPECT_EQ(complaint(with_line(2, "kind = \"hexagonal\"")), "d.toml:2: element.kind");
  EXPECT_EQ(complaint(with_line(6, "arrangement = \"ofset\"")), "d.toml:6: array.arrangement");
  EXPECT_EQ(set_complaint({"array.shifted_rows=uneven"}), "--set array.shifted_rows=uneven: array.shifted_rows");
  EXPECT_EQ(set_complaint({"idealisation.facets=miror"}), "--set idealisation.facets=miror: idealisation.facets");
  EXPECT_EQ(complaint("schema = \"retrace.design/2\"\nnew_key = 1\n"), "d.toml:1: schema");
  EXPECT_EQ(complaint(with_line(11, "material = \"\"")), "d.toml:11: body.material");
}

TEST(DesignReader, WhatThisVersionCannotDoIsRefusedPlainly) {
  const auto refused = [](const std::string& set) { return set_complaint({set}); };
  expect_refusals(refused, {{"array.mask_threshold=0.7", "--set array.mask_threshold=0.7: array.mask_threshold"},
                            {"body.back_index=0.9", "--set body.back_index=0.9: body.back_index"},
                            {"body.back_index=1.33", ""},
                            {"body.facet_coating=aluminium", ""},
                            {"body.facet_coating=silver", "--set body.facet_coating=silver: body.facet_coating"}});
  EXPECT_EQ(complaint(with_line(11, "[part]\nmesh = \"a.stl\"")), "d.toml:1: element");
  EXPECT_EQ(refused("surface.roughness_sq_nm=rough"), "--set surface.roughness_sq_nm=rough: surface.roughness_sq_nm");
}

TEST(DesignReader, TextThatIsNotTomlIsRefusedWithItsLine) {
  expect_refusals([](const std::string& given) { return complaint(given); },
                  {{"[element]\nkind = \n", "d.toml:2"},
                   {"[\n", "d.toml:1"},
                   {"[element]\nkind = \"a\nb\"\n", "d.toml:2"},
                   {"[element]\n[element]\n", "d.toml:2"},
                   {"a = 1e999\n", "d.toml:1"},
                   {"title = \"\xff\"\n", "d.toml:1"}});
  EXPECT_NE(complaint(std::string("a = \0 1\n", 8)), "");
}

TEST(DesignReader, TextOfAbsurdLengthOrDepthIsRefused) {
  EXPECT_EQ(complaint(std::string(1'048'577, '\n')), "d.toml");
  std::string deep;
  for (int i = 0; i < 8100; ++i) deep += "a.";
  EXPECT_EQ(complaint(deep + "a=1\n"), "d.toml:1: a");
  EXPECT_NE(complaint("x = " + std::string(16000, '[')), "");
}

TEST(DesignReader, MessagesShowControlCharactersEscapedAndStayShort) {
  EXPECT_EQ(complaint(with_line(2, "kind = \"a\\nb\\u001bc\\u0085\"")), "d.toml:2: element.kind");
  EXPECT_LT(complaint(with_line(2, "kind = \"" + std::string(5000, 'x') + "\"")).size(), 250U);
  // The message also lists the allowed keys.
  EXPECT_LT(complaint(with_line(3, std::string(5000, 'x') + " = 1")).size(), 300U);
}

TEST(DesignReader, OverridesTakePrecedenceAndTheLastOneWins) {
  const design::Design design = set({"element.base_mm=0.3", "array.arrangement=aligned", "title=\"two words\"",
                                     "array.x_length_mm = 12", "element.base_mm=0.4"});
  EXPECT_EQ(std::get<RtpElement>(design.part().element).base_mm, 0.4);
  EXPECT_EQ(design.part().array.arrangement, Arrangement::aligned);
  EXPECT_EQ(design.part().array.x_length_mm, 12.0);
  EXPECT_EQ(design.title, "two words");
  EXPECT_EQ(set({"array.arrangement=\"aligned\""}).part().array.arrangement, Arrangement::aligned);
  EXPECT_EQ(set({"title=Part #3 \"new\" \\ old"}).title, "Part #3 \"new\" \\ old");
  EXPECT_EQ(set({"detector.acceptance_half_angle_deg=[1,2]"}).detector.acceptance_half_angle_deg,
            (std::vector<double>{1, 2}));
  EXPECT_EQ(set({"body={material=\"PC\"}"}).part().thickness_mm, 2.0);
  EXPECT_EQ(set({"body.material=PC"}).where("body.material").file, "--set body.material=PC");
}

TEST(DesignReader, AnOverrideMendsAFileThatIsWrongThere) {
  EXPECT_EQ(complaint(with_line(3, "base_mm = -1"), {"element.base_mm=1"}), "");
}

TEST(DesignReader, FilesAreNamedInTheOrderThatStoresOfStudiesHave) {
  const auto paths = [](const std::string& design) {
    std::vector<std::filesystem::path> files;
    for (const design::NamedFile& named : design::files_named(design, "d/d.toml", {})) files.push_back(named.file);
    return files;
  };
  const std::string text =
      "[entrance_surface]\nturned_part = \"f.toml\"\n[light]\nspectrum = \"l.csv\"\n[part]\nfacets = \"p.csv\"\n"
      "[surface]\nheight_map = \"h.txt\"\n[array]\nmask = \"m.png\"\n[element]\nkind = \"rtp\"\n";
  const std::vector<std::filesystem::path> expected = {"d/m.png", "d/h.txt", "d/p.csv", "d/l.csv", "d/f.toml"};
  EXPECT_EQ(paths(text), expected);
  EXPECT_EQ(paths("[light]\nspectrum = \"A\"\n[element]\nkind = \"rtp\"\n"), std::vector<std::filesystem::path>{});
}

// Removing a key by an override has the same effect as removing it from the file. The last override of a key takes
// precedence.
TEST(DesignReader, KeysAreUnset) {
  const std::string text = joined(kLines) + "refractive_index = 1.6\nmaterial = \"PC\"\n[form]\nsink_um = 0.1\n";
  const auto read = [&](const std::vector<std::string>& overrides) {
    return design::parse_design(text, "d.toml", overrides);
  };
  EXPECT_EQ(read({}).substance.refractive_index, 1.6);
  EXPECT_EQ(read({"body.refractive_index="}).substance.refractive_index, std::nullopt);
  EXPECT_EQ(read({"body.material = "}).substance.material, "PMMA");
  EXPECT_TRUE(read({"form="}).surface.form.is_plane());
  EXPECT_EQ(read({"body.refractive_index=", "body.refractive_index=1.7"}).substance.refractive_index, 1.7);
  EXPECT_EQ(read({"body.refractive_index=1.7", "body.refractive_index="}).substance.refractive_index, std::nullopt);
  EXPECT_EQ(design::with(read({"body.refractive_index=1.7"}), std::vector<std::string>{"body.refractive_index="})
                .substance.refractive_index,
            std::nullopt);
  EXPECT_EQ(read({"light.spectrum="}).light.wavelength_nm(), read({}).light.wavelength_nm())
      << "a key that the file does not have";
  EXPECT_EQ(set_complaint({"element.base_mm="}), "d.toml:1: element.base_mm");
  EXPECT_EQ(read({"schema="}).substance.refractive_index, 1.6);
  for (const std::string key :
       {".", "body.", ".body", "body..material", "zone.area_fraction", "coating.facets.thickness_nm"})
    EXPECT_EQ(set_complaint({key + "="}), "--set " + key + "=");
  EXPECT_EQ(set_complaint({"body.refractve_index="}), "--set body.refractve_index=");
}

using Facts = std::vector<std::string>;

// If a key has no effect because another key takes precedence, a warning reports both keys.
TEST(DesignReader, KeysWithoutEffectAreTold) {
  const std::string index = joined(kLines) + "refractive_index = 1.6\n";  // line 11
  const auto warnings = [](const std::string& text, const std::vector<std::string>& overrides) {
    return facts_of(design::parse_design(text, "d.toml", overrides).warnings());
  };
  EXPECT_EQ(warnings(index, {}), Facts{});
  EXPECT_EQ(warnings(index, {"body.material=PC"}), Facts{"superseded_key at --set body.material=PC: body.material"});
  EXPECT_EQ(warnings(index + "material = \"PC\"\n", {}), Facts{"superseded_key at d.toml:12: body.material"});
  EXPECT_EQ(warnings(index, {"body.refractive_index=", "body.material=PC"}), Facts{});
  EXPECT_EQ(warnings(index, {"body.material=PMMA"}), Facts{}) << "an override by the default";
  // If an override sets the key that takes precedence, the user intends this effect, and no warning is given. A file
  // may give both an absorption and a material without a warning.
  const std::string plastic = joined(kLines) + "material = \"PC\"\n";
  EXPECT_EQ(warnings(plastic, {"body.refractive_index=1.6"}), Facts{});
  EXPECT_EQ(warnings(plastic + "absorption_per_mm = 0.1\n", {}), Facts{});
  EXPECT_EQ(warnings(joined(kLines) + "absorption_per_mm = 0.1\n", {"body.material=PC"}).size(), 1U);
  EXPECT_EQ(warnings(joined(kLines), {"idealisation.facets=mirror", "body.facet_coating=aluminium"}).size(), 1U);
}

// A correlation length or a period needs a height to have an effect.
TEST(DesignReader, LengthsWithoutHeightsCauseAWarning) {
  const std::string text = joined(kLines);
  const auto warnings = [&](const std::string& more) {
    return facts_of(design::parse_design(text + more, "d.toml").warnings());
  };
  EXPECT_EQ(warnings("[surface]\ncorrelation_length_um = 5\n"),
            Facts{"key_without_effect at d.toml:12: surface.correlation_length_um"});
  EXPECT_EQ(warnings("[surface]\ncorrelation_length_down_um = 5\n").size(), 1U);
  EXPECT_EQ(warnings("[surface]\nwaviness_length_um = 5\n").size(), 1U);
  EXPECT_EQ(warnings("[entrance]\ncorrelation_length_um = 5\n").size(), 1U);
  EXPECT_EQ(warnings("[surface]\ncorrelation_length_um = 0\n"), Facts{}) << "the default";
  EXPECT_EQ(warnings("[surface]\ncorrelation_length_um = 5\nroughness_sq_nm = 3\n"), Facts{});
  EXPECT_EQ(warnings("[surface]\ncorrelation_length_um = 5\nroughness_sq_nm = 0\n"), Facts{})
      << "a study may vary the height from 0 on";
}

TEST(DesignReader, ErrorsInOverridesNameTheOverride) {
  EXPECT_EQ(set_complaint({"element.base_mm=0"}), "--set element.base_mm=0: element.base_mm");
  EXPECT_EQ(set_complaint({"element.base_mm=0.4mm"}), "--set element.base_mm=0.4mm: element.base_mm");
  EXPECT_EQ(set_complaint({"element.base_mm=\"\""}), "--set element.base_mm=\"\": element.base_mm");
  EXPECT_EQ(set_complaint({"elemnt.base_mm=1"}), "--set elemnt.base_mm=1: elemnt");
  EXPECT_EQ(set_complaint({"element=3"}), "--set element=3: element");
  for (const std::string text : {"", "x", "=3", "[body]", "# x", "a b=3"})
    EXPECT_EQ(set_complaint({text}), "--set " + std::string(text)) << text;
  EXPECT_EQ(set_complaint({"title=a\nb=1"}), "--set title=a\\nb=1");
  EXPECT_EQ(set_complaint({"a..b=x"}), "--set a..b=x");
  EXPECT_EQ(set_complaint({"title=\xff"}), "--set title=\\xff");
}

TEST(DesignReader, UnreadablePathsAreRefused) {
  const auto refused = [](const fs::path& path) { return refusal_of([&] { design::read_design(path); }); };
  EXPECT_EQ(refused("no/such.toml"), "no/such.toml");
  EXPECT_EQ(refused("/"), "/");
  for (const std::string device : {"/dev/zero", "/dev/null"}) EXPECT_EQ(refused(device), device);
}

/// Replaces the standard input during its lifetime.
class StandardInput {
 public:
  explicit StandardInput(const std::string& text) : stream_(text), before_(std::cin.rdbuf(stream_.rdbuf())) {}
  ~StandardInput() {
    std::cin.rdbuf(before_);
    std::cin.clear();
  }
  StandardInput(const StandardInput&) = delete;
  StandardInput& operator=(const StandardInput&) = delete;

 private:
  std::istringstream stream_;
  std::streambuf* before_;
};

TEST(DesignReader, DashIsStandardInput) {
  {
    const StandardInput input(joined(kLines));
    EXPECT_EQ(design::read_design("-").source, "-");
  }
  const StandardInput input(with_line(3, "base_mm = -3"));
  try {
    design::read_design("-");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(recorded_place_of(error), "standard input:3: element.base_mm");
  }
}

TEST(DesignReader, EveryExampleIsValid) {
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(RETRACE_SOURCE_DIR) / "examples")) {
    if (entry.path().extension() != ".toml") continue;
    std::ifstream stream(entry.path());
    std::stringstream text;
    text << stream.rdbuf();
    // The folder also contains studies and jobs. Designs are recognized by their schema.
    if (text.str().find("schema = \"retrace.design/1\"") == std::string::npos) continue;
    ++count;
    EXPECT_NO_THROW(design::read_design(entry.path())) << entry.path();
    EXPECT_EQ(text.str().substr(0, 2), "# ") << entry.path() << " has no head that says what it is";
  }
  EXPECT_GE(count, 9);
}

/// Expects that the reader accepts the text or throws an InputError whose message is one line.
void expect_graceful(const std::string& text, const std::vector<std::string>& overrides) {
  try {
    design::parse_design(text, "d.toml", overrides);
  } catch (const InputError& error) {
    RC_ASSERT(std::string(error.what()).find('\n') == std::string::npos);
  }
}

TEST(DesignReader, ArbitraryBytesNeverCrash) {
  EXPECT_TRUE(rc::check("bytes", [](const std::string& text) { expect_graceful(text, {}); }));
  EXPECT_TRUE(rc::check("override", [](const std::string& text) {
    expect_graceful(joined(kLines), {text});
    expect_graceful(joined(kLines), {"element.base_mm=" + text});
  }));
}

TEST(DesignReader, DamagedDesignsNeverCrash) {
  EXPECT_TRUE(rc::check("a valid design with one stretch replaced", [] {
    std::string text = design::design_template("rtp");
    const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
    const auto length = *rc::gen::inRange<std::size_t>(0, 20);
    text.replace(at, length, *rc::gen::arbitrary<std::string>());
    expect_graceful(text, {});
  }));
}

}  // namespace
}  // namespace retrace::studies::design_reader_test
