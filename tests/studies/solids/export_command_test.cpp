#include <gtest/gtest.h>

#include <cmath>

#include "tests/app/program.h"

// Tests of the command `retrace export`.

namespace retrace::test::export_command_test {
namespace {

const std::string kPrism = example("rtp_single_0p45mm.toml");

TEST(Export, WritesEveryFormat) {
  const TemporaryFolder folder;
  for (const std::string name : {"a.stl", "a.obj", "a.glb", "a.STEP", "b.stp"}) {
    const Outcome outcome = retrace(folder, {"export", kPrism, "-o", name});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("wrote " + name), std::string::npos);
  }
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.STEP", "a.glb", "a.obj", "a.stl", "b.stp"}));
  EXPECT_EQ(folder.read("a.STEP"), folder.read("b.stp"));
  EXPECT_TRUE(folder.read("b.stp").starts_with("ISO-10303-21;"));
  EXPECT_EQ(folder.read("a.stl").substr(0, 7), "retrace");
}

TEST(Export, FileMayStandWithoutOption) {
  const TemporaryFolder folder;
  EXPECT_EQ(retrace(folder, {"export", kPrism, "a.stl", "--quiet"}).code, 0);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.stl"});
}

TEST(Export, SaysVolumesOfElementArrayAndMould) {
  const TemporaryFolder folder;
  folder.write("d.toml",
               "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.4\n[array]\nx_length_mm = 2\ny_length_mm = 2\n"
               "[body]\nthickness_mm = 1\n");
  const auto volume = [&](const std::string& what) {
    const Json json = retrace_json(folder, {"export", "d.toml", "--what", what});
    EXPECT_EQ(json.at("schema"), "retrace.export/2");
    EXPECT_EQ(json.at("what"), what);
    EXPECT_TRUE(json.at("is_manifold"));
    return json.at("volume_mm3").get<double>();
  };
  const double prism_mm3 = 0.25 * 0.5 * 0.5 * 0.4;
  EXPECT_NEAR(volume("element"), 0.5 * 0.4 + prism_mm3, 1e-12);
  EXPECT_NEAR(volume("array"), 4.0 + 20.0 * prism_mm3, 1e-11);
  EXPECT_NEAR(volume("mould"), 4.0 * 1.25 - 20.0 * prism_mm3, 1e-11);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"d.toml"}) << "nothing is written without a file";
}

TEST(Export, AnElementOfAnEndlessArrayIsWritten) {
  const TemporaryFolder folder;
  EXPECT_EQ(retrace(folder, {"export", example("honeycomb_infinite.toml"), "--what", "element", "-o", "e.step"}).code,
            0);
}

TEST(Export, WhatCannotBeIsRefusedAndNothingWritten) {
  const TemporaryFolder folder;
  EXPECT_EQ(refused_at(retrace(folder, {"export", kPrism, "-o", "a.dxf"})), "--out");
  EXPECT_EQ(refused_at(retrace(folder, {"export", kPrism, "-o", "a.stl", "--what", "tool"})), "--what");
  EXPECT_EQ(refused_at(retrace(folder, {"export", kPrism, "a.stl", "-o", "b.stl"})), "--out");
  EXPECT_EQ(refused_at(retrace(folder, {"export", kPrism, "a.stl", "--block-mm", "1"})), "--block-mm");
  EXPECT_EQ(refused_at(retrace(folder, {"export", kPrism, "a.stl", "--what", "mould", "--block-mm", "0"})),
            "--block-mm");
  EXPECT_EQ(refused_at(retrace(folder, {"export", example("honeycomb_infinite.toml"), "a.stl"})),
            "examples/honeycomb_infinite.toml: array.extent");
  EXPECT_EQ(refused_at(retrace(folder, {"export", kPrism, "a.stl", "--json", "a.stl"})), "--json");
  EXPECT_EQ(refused_at(retrace(folder, {"export", "none.toml", "a.stl"})), "none.toml");
  EXPECT_TRUE(folder.names().empty());
}

TEST(Export, TheDesignIsNotOverwritten) {
  const TemporaryFolder folder;
  folder.write("d.stl", read_text(kPrism));
  EXPECT_EQ(refused_at(retrace(folder, {"export", "d.stl", "d.stl"})), "--out");
  EXPECT_EQ(folder.read("d.stl"), read_text(kPrism));
}

TEST(Export, AFileThatCannotBeWrittenIsAnOutputError) {
  const TemporaryFolder folder;
  EXPECT_EQ(retrace(folder, {"export", kPrism, "-o", "no/such/folder/a.stl"}).code, 3);
}

}  // namespace
}  // namespace retrace::test::export_command_test
