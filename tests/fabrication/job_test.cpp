#include "fabrication/job/job.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <string>

#include "core/error.h"
#include "fabrication/job/io/job_files.h"
#include "geometry/part/part.h"
#include "tests/fabrication/jobs.h"
#include "tests/support/refusals.h"

// Tests of jobs: positions of the elements, reading and writing of job files without loss, and refused input.

namespace retrace::fabrication::test::job_test {
namespace {

using geometry::Arrangement;
using geometry::RowParity;

bool same(const Job& a, const Job& b) {
  return job_text(a) == job_text(b);
}

TEST(Job, CountsThesisArrays) {
  // Milliken 2017, 2.3 and 2.7: every second row lacks its first element.
  const std::pair<int, std::size_t> counts[] = {{1, 1}, {3, 8}, {4, 14}, {5, 23}, {7, 46}, {25, 613}};
  for (const auto& [n, elements] : counts) EXPECT_EQ(cut_elements(square_job(n)).size(), elements) << n;
}

TEST(Job, HasAsManyElementsAsThePartHasWholeOnes) {
  for (const auto arrangement : {Arrangement::aligned, Arrangement::offset, Arrangement::checker})
    for (const auto parity : {RowParity::even, RowParity::odd})
      for (const double y_length_mm : {1.0, 1.4, 3.7}) {
        Job job = square_job(5, arrangement);
        job.array.shifted_rows = parity;
        job.array.y_length_mm = y_length_mm;
        job.array.x_gap_mm = 0.02;
        job.array.x_offset_mm = 0.1;
        geometry::PartSpec spec;
        spec.element = prism_of(job);
        spec.array.arrangement = arrangement;
        spec.array.shifted_rows = parity;
        spec.array.partial_elements = geometry::PartialElements::omit;
        spec.array.x_length_mm = job.array.x_length_mm;
        spec.array.y_length_mm = y_length_mm;
        spec.array.x_gap_mm = 0.02;
        spec.array.x_offset_mm = 0.1;
        spec.thickness_mm = 1.0;
        EXPECT_EQ(static_cast<std::int64_t>(cut_elements(job).size()), geometry::build_part(spec).elements_full);
      }
}

TEST(Job, PlacesElementsInTheWorkpieceFrame) {
  Job job = square_job(2);
  const auto elements = cut_elements(job);  // row 1 has two elements; row 2, shifted by half a base, has one
  ASSERT_EQ(elements.size(), 3U);
  // Transformation to the workpiece frame: x_w = y_part and y_w = -x_part, from the centre of the extent.
  EXPECT_NEAR((elements[0].centre_mm - geometry::Vec2(-0.2255, 0.2255)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((elements[1].centre_mm - geometry::Vec2(-0.2255, -0.2255)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((elements[2].centre_mm - geometry::Vec2(0.2255, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_EQ(elements[2].row, 1);
}

TEST(Job, MirrorsADirectWorkpiece) {
  Job job = square_job(4);
  job.array.pattern = {"#---", "----", "----", "-#--"};
  const auto mould = cut_elements(job);
  job.workpiece.kind = WorkpieceKind::direct;
  const auto direct = cut_elements(job);
  ASSERT_EQ(mould.size(), 2U);
  ASSERT_EQ(direct.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_DOUBLE_EQ(direct[k].centre_mm.x(), mould[k].centre_mm.x());
    EXPECT_DOUBLE_EQ(direct[k].centre_mm.y(), -mould[k].centre_mm.y());
  }
}

TEST(Job, NumbersDirectElementsFromItsOwnLeft) {
  Job job = square_job(3);
  job.workpiece.kind = WorkpieceKind::direct;
  const auto elements = cut_elements(job);
  for (std::size_t k = 1; k < elements.size(); ++k)
    if (elements[k].row == elements[k - 1].row) {
      EXPECT_LT(elements[k].centre_mm.y(), elements[k - 1].centre_mm.y()) << "x_part rises, y_w = -x_part falls";
    }
}

TEST(Job, TurnsEverySecondElementOfAChecker) {
  const auto elements = cut_elements(square_job(4, Arrangement::checker));
  EXPECT_EQ(elements.size(), 16U);
  for (const CutElement& element : elements) EXPECT_EQ(element.rotated, (element.row + element.column) % 2 == 1);
}

TEST(Job, PatternSaysWhatIsCut) {
  Job job = square_job(3, Arrangement::aligned);
  job.array.pattern = {"--#", "---", "#--"};  // the first text is the row with the largest y
  const auto elements = cut_elements(job);
  ASSERT_EQ(elements.size(), 2U);
  EXPECT_EQ(elements[0].row, 0);
  EXPECT_EQ(elements[0].column, 0);
  EXPECT_EQ(elements[1].row, 2);
  EXPECT_EQ(elements[1].column, 2);
}

TEST(Job, ShrinkageMakesTheBlankLarger) {
  Job job = square_job(3, Arrangement::aligned);
  const double before_mm = cut_elements(job).front().centre_mm.norm();
  job.workpiece.shrinkage_percent = 0.5;
  EXPECT_DOUBLE_EQ(cut_elements(job).front().centre_mm.norm(), 1.005 * before_mm);
  EXPECT_DOUBLE_EQ(blank_prism(job).base_mm, 1.005 * 0.451);
  EXPECT_DOUBLE_EQ(blank_extent_mm(job).x(), 1.005 * 3 * 0.451);
}

RC_GTEST_PROP(JobFile, ReadsBackToTheSameJob, ()) {
  const auto real = [](double low, double high) {
    return low + (high - low) * *rc::gen::inRange(0, 1 << 30) / static_cast<double>(1 << 30);
  };
  Job job = square_job(4, *rc::gen::element(Arrangement::aligned, Arrangement::offset, Arrangement::single));
  job.title = *rc::gen::string<std::string>();
  job.title.erase(std::remove_if(job.title.begin(), job.title.end(), [](char c) { return (c & 0x80) != 0; }),
                  job.title.end());
  prism_of(job).base_mm = real(0.2, 3.0);
  prism_of(job).apex_angle_deg = real(70.0, 120.0);
  job.array.x_length_mm = real(3.0, 30.0);
  job.array.x_gap_mm = real(0.0, 0.1);
  job.array.overlap_percent = real(0.0, 99.0);
  job.array.shifted_rows = *rc::gen::element(RowParity::even, RowParity::odd);
  job.workpiece.shrinkage_percent = real(0.0, 9.0);
  job.workpiece.kind = *rc::gen::element(WorkpieceKind::mould, WorkpieceKind::direct);
  job.strategy = *rc::gen::element(Strategy::unidirectional, Strategy::bidirectional, Strategy::two_step);
  job.tool.width_mm = real(0.1, 0.451);
  // Choose a wedge angle that gives chips enough room and for which no fin remains between plunges.
  job.tool.wedge_deg = std::max(50.0, 0.5 * prism_of(job).apex_angle_deg);
  job.tool.edge_radius_um = real(0.0, 5.0);
  job.tool.side_clearance_deg = real(0.1, 1.0);
  if (*rc::gen::arbitrary<bool>()) job.tool.edge_chips = {{real(-20.0, 0.0), 3.0, real(0.1, 1.5)}, {20.0, 5.0, 0.25}};
  job.process.clearance_mm = real(0.01, 1.0);
  job.process.roughing_depth_um = real(1.0, 50.0);
  job.process.finishing_cuts = *rc::gen::inRange(1, 5);
  job.process.shortest_plough = *rc::gen::arbitrary<bool>();
  job.process.plough_lift_um = real(0.0, 9.0);
  job.process.plough_sa_nm = real(0.0, 900.0);
  if (*rc::gen::arbitrary<bool>()) {
    job.tool.edge_life_mm = real(1.0, 1e6);
    job.tool.next_edge = *rc::gen::element(NextEdge::stop, NextEdge::program);
    job.process.min_chip_um = real(0.01, 0.5);
    job.process.stop_every_min = real(1.0, 600.0);
    job.process.stop_before_finishing = job.strategy == Strategy::two_step;
  }
  if (job.array.arrangement == Arrangement::single) job.array.x_length_mm = job.array.y_length_mm = 0.0;
  RC_ASSERT(same(parse_job(job_text(job), "j.toml"), job));
}

struct Wrong {
  std::string from;
  std::string to;
  std::string place;
};

TEST(JobFile, WhatIsWrongIsRefusedWithFileLineAndKey) {
  const std::string good = job_text(square_job(4));
  ASSERT_NO_THROW(parse_job(good, "j.toml"));
  const Wrong cases[] = {
      {"roughing_depth_um = 15", "roughing_depth_um = 0", "j.toml:38: process.roughing_depth_um"},
      {"\nwidth_mm = 0.451\nwedge", "\nwidth_mm = 0.46\nwedge", "j.toml:28: tool.width_mm"},
      {"wedge_deg = 50", "wedge_deg = 80", "j.toml:29: tool.wedge_deg"},
      {"wedge_deg = 50", "wedge_deg = 41", "j.toml:29: tool.wedge_deg"},
      {"side_clearance_deg = 2", "side_clearance_deg = 25", "j.toml:32: tool.side_clearance_deg"},
      {"\nwidth_mm = 0.451\nwedge_deg = 50\nclearance_deg = 3\nedge_radius_um = 0\nside_clearance_deg = 2",
       "\nwidth_mm = 0.1\nwedge_deg = 50\nclearance_deg = 3\nedge_radius_um = 0\nside_clearance_deg = 9",
       "j.toml:32: tool.side_clearance_deg"},
      {"side_clearance_deg = 2\n",
       "side_clearance_deg = 2\n[[tool.edge_chips]]\nposition_um = 226\nwidth_um = 2\ndepth_um = 1\n",
       "j.toml:34: tool.edge_chips[1].position_um"},
      {"side_clearance_deg = 2\n",
       "side_clearance_deg = 2\n[[tool.edge_chips]]\nposition_um = 1\nwidth_um = 2\ndepth_um = 1.1\n",
       "j.toml:36: tool.edge_chips[1].depth_um"},
      {"side_clearance_deg = 2\n",
       "side_clearance_deg = 2\n[[tool.edge_chips]]\nposition_um = 1\nwidth_um = 2\ndepth_um = 1\n"
       "[[tool.edge_chips]]\nposition_um = 2\nwidth_um = 2\ndepth_um = 1\n",
       "j.toml:38: tool.edge_chips[2].position_um"},
      {"side_clearance_deg = 2\n", "side_clearance_deg = 2\nedge_chips = 3\n", "j.toml:33: tool.edge_chips"},
      {"\nclearance_deg = 3", "\nclearance_deg = 1", "j.toml:30: tool.clearance_deg"},
      {"strategy = \"two-step\"", "strategy = \"two-steps\"", "j.toml:4: strategy"},
      {"arrangement = \"offset\"", "arrangement = \"honeycomb\"", "j.toml:17: array.arrangement"},
      {"x_gap_mm = 0", "x_gap_m = 0", "j.toml:22: array.x_gap_m"},
      {"x_length_mm = 1.804", "x_length_mm = 0.4", "j.toml:20: array.x_length_mm"},
      {"x_offset_mm = 0", "x_offset_mm = 0\npattern = [\"#\"]", "j.toml:25: array.pattern"},
      {"finishing_cuts = 2", "finishing_cuts = 1.5", "j.toml:40: process.finishing_cuts"},
      {"plough_length_mm = 0.1", "plough_length_mm = 0.001", "j.toml:41: process.plough_length_mm"},
      {"shortest_plough = false", "shortest_plough = 0", "j.toml:46: process.shortest_plough"},
      {"roughing_feed_mm_per_min = 50", "roughing_feed_mm_per_min = 4.9e-4",
       "j.toml:43: process.roughing_feed_mm_per_min"},
      {"finishing_feed_mm_per_min = 20", "finishing_feed_mm_per_min = 4.9e-4",
       "j.toml:44: process.finishing_feed_mm_per_min"},
      {"retract_feed_mm_per_min = 200", "retract_feed_mm_per_min = 0", "j.toml:45: process.retract_feed_mm_per_min"},
      {"machine = \"ideal\"", "machine = \"\"", "j.toml:3: machine"},
      {"machine = \"ideal\"", "machine = \"a\\u0000.toml\"", "j.toml:3: machine"},
      {"side_clearance_deg = 2\n", "side_clearance_deg = 2\nedge_life_mm = 0\n", "j.toml:33: tool.edge_life_mm"},
      {"side_clearance_deg = 2\n", "side_clearance_deg = 2\nedge_life_mm = 9\nnext_edge = \"tool\"\n",
       "j.toml:34: tool.next_edge"},
      {"mist = true", "stop_every_min = 0", "j.toml:50: process.stop_every_min"},
      {"mist = true", "stop_before_finishing = 1", "j.toml:50: process.stop_before_finishing"},
      {"mist = true", "min_chip_um = 0", "j.toml:50: process.min_chip_um"},
      {"mist = true", "min_chip_um = 2.6", "j.toml:50: process.min_chip_um"},
      {"base_mm = 0.451", "base_mm = nan", "j.toml:12: element.base_mm"},
  };
  for (const Wrong& wrong : cases) {
    SCOPED_TRACE(wrong.to);
    EXPECT_EQ(refusal_of([&] { parse_job(with_replaced(good, wrong.from, wrong.to), "j.toml"); }), wrong.place);
  }
}

TEST(JobFile, OnlyWhatIsFinishedStopsBeforeFinishing) {
  Job job = square_job(4);
  job.process.stop_before_finishing = true;
  ASSERT_NO_THROW(parse_job(job_text(job), "j.toml"));
  job.strategy = Strategy::bidirectional;
  EXPECT_EQ(refusal_of([&] { parse_job(job_text(job), "j.toml"); }), "j.toml:50: process.stop_before_finishing");
}

TEST(JobFile, BasesReadBackEqual) {
  for (const char* const substrate :
       {"kind = \"plane\"\nincline_deg = 7.5\nazimuth_deg = 30\nelement_axes = \"parallel\"\n",
        "kind = \"cylinder\"\nradius_mm = -20\naxis = \"x\"\nelement_axes = \"parallel\"\n",
        "kind = \"cylinder\"\nradius_mm = 30\naxis = \"y\"\nelement_axes = \"normal\"\n",
        "kind = \"sphere\"\nradius_mm = 40\nelement_axes = \"normal\"\n",
        "kind = \"formula\"\nsag_mm = \"0.01*x^2 - y/9\"\nelement_axes = \"parallel\"\n"}) {
    const std::string text = job_text(square_job(4)) + "\n[substrate]\n" + substrate;
    const Job job = parse_job(text, "j.toml");
    ASSERT_TRUE(job.substrate) << substrate;
    const std::string again = job_text(job);
    EXPECT_NE(again.find(std::string("\n[substrate]\n") + substrate), std::string::npos) << again;
    EXPECT_EQ(job_text(parse_job(again, "j.toml")), again);
    EXPECT_EQ(cut_elements(job).front().origin_mm, cut_elements(parse_job(again, "j.toml")).front().origin_mm);
  }
}

TEST(JobFile, BasesThatCannotBeAreRefused) {
  const auto complaint = [](const Job& job, const std::string& substrate) -> std::string {
    return refusal_of([&] { parse_job(job_text(job) + "\n[substrate]\n" + substrate, "j.toml"); }, "none");
  };
  const Job good = square_job(4);
  const std::string plane = "kind = \"plane\"\nincline_deg = 5\n";
  ASSERT_EQ(complaint(good, plane), "none");
  const auto expect = [&](const Job& job, const std::string& substrate, const std::string& place) {
    EXPECT_EQ(complaint(job, substrate), place) << substrate;
  };
  expect(good, "kind = \"cone\"\n", "j.toml:56: substrate.kind");
  expect(good, "kind = \"plane\"\n", "j.toml:55: substrate.incline_deg");
  expect(good, "kind = \"plane\"\nincline_deg = 61\n", "j.toml:57: substrate.incline_deg");
  expect(good, plane + "radius_mm = 3\n", "j.toml:58: substrate.radius_mm");
  expect(good, plane + "element_axes = \"upright\"\n", "j.toml:58: substrate.element_axes");
  expect(good, "kind = \"sphere\"\nradius_mm = 0\n", "j.toml:57: substrate.radius_mm");
  expect(good, "kind = \"cylinder\"\nradius_mm = 0.3\n", "j.toml:57: substrate.radius_mm");
  expect(good, "kind = \"cylinder\"\nradius_mm = 9\naxis = \"z\"\n", "j.toml:58: substrate.axis");
  expect(good, "kind = \"formula\"\nsag_mm = \"x +\"\n", "j.toml:57: substrate.sag_mm");
  expect(good, "kind = \"formula\"\nsag_mm = \"1/x\"\n", "j.toml:57: substrate.sag_mm");
  expect(good, "kind = \"plane\"\nincline_deg = 55\nelement_axes = \"parallel\"\n", "j.toml:57: substrate.incline_deg");
  Job direct = good;
  direct.workpiece.kind = WorkpieceKind::direct;
  expect(direct, plane, "j.toml:57: substrate.incline_deg");
  Job offset = good;
  offset.array.x_offset_mm = 0.1;
  expect(offset, plane, "j.toml:57: substrate.incline_deg");
  Job masked = good;
  masked.array.pattern = {"####", "###-", "####", "###-"};
  expect(masked, plane, "j.toml:63: substrate.incline_deg");
  expect(square_job(1), plane, "j.toml:55: substrate.incline_deg");
  expect(good, "kind = \"plane\"\nincline_deg = 50\n", "j.toml:57: substrate.incline_deg");
}

TEST(JobFile, APatternMustLeaveSomethingToCut) {
  Job job = square_job(2, Arrangement::offset);
  job.array.pattern = {"-#", "--"};  // the only cell that is cut is in the last column of the shifted row
  EXPECT_THROW(parse_job(job_text(job), "j.toml"), InputError);
  job.array.pattern = {"#-", "--"};
  EXPECT_EQ(cut_elements(parse_job(job_text(job), "j.toml")).size(), 1U);
}

TEST(JobFile, DeepKeysAreRefused) {
  std::string text = "a";
  for (int k = 0; k < 1000; ++k) text += ".a";
  EXPECT_THROW(parse_job(text + " = 1\n", "j.toml"), InputError);
}

}  // namespace
}  // namespace retrace::fabrication::test::job_test
