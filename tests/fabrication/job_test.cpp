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
  const auto elements = cut_elements(job);  // row 1: two, row 2 shifted by half a base: one
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
  job.array.pattern = {"--#", "---", "#--"};  // the first text is the row of largest y
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
  // Choose a wedge angle for which no fin remains between plunges and chips have enough room.
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
    job.process.least_chip_um = real(0.01, 0.5);
    job.process.stop_every_min = real(1.0, 600.0);
    job.process.stop_before_finishing = job.strategy == Strategy::two_step;
  }
  if (job.array.arrangement == Arrangement::single) job.array.x_length_mm = job.array.y_length_mm = 0.0;
  RC_ASSERT(same(parse_job(job_text(job), "j.toml"), job));
}

struct Wrong {
  std::string from;
  std::string to;
  std::string message;
};

TEST(JobFile, WhatIsWrongIsRefusedWithFileLineAndKey) {
  const std::string good = job_text(square_job(4));
  ASSERT_NO_THROW(parse_job(good, "j.toml"));
  const auto line_of = [&](const std::string& text) {
    return std::to_string(1 +
                          std::count(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(good.find(text)), '\n'));
  };
  const Wrong cases[] = {
      {"roughing_depth_um = 15", "roughing_depth_um = 0", "process.roughing_depth_um: must be > 0 and <= 1000, got 0"},
      {"\nwidth_mm = 0.451\nwedge", "\nwidth_mm = 0.46\nwedge",
       "tool.width_mm: must be <= 0.451000, the element's width, got 0.46"},
      {"wedge_deg = 50", "wedge_deg = 80", "tool.wedge_deg: with clearance_deg must be <= 77.500 for chips"},
      {"wedge_deg = 50", "wedge_deg = 41",
       "tool.wedge_deg: with clearance_deg must be >= 45, half the apex angle, or a fin of 2.000 degrees"},
      {"side_clearance_deg = 2", "side_clearance_deg = 25", "tool.side_clearance_deg: must be > 0 and <= 20, got 25"},
      {"\nwidth_mm = 0.451\nwedge_deg = 50\nclearance_deg = 3\nedge_radius_um = 0\nside_clearance_deg = 2",
       "\nwidth_mm = 0.1\nwedge_deg = 50\nclearance_deg = 3\nedge_radius_um = 0\nside_clearance_deg = 9",
       "tool.side_clearance_deg: must be < 8.911, or the diamond ends in a point within its element, got 9"},
      {"side_clearance_deg = 2\n",
       "side_clearance_deg = 2\n[[tool.edge_chips]]\nposition_um = 226\nwidth_um = 2\ndepth_um = 1\n",
       "tool.edge_chips[1].position_um: must be >= -224.5 and <= 224.5, got 226"},
      {"side_clearance_deg = 2\n",
       "side_clearance_deg = 2\n[[tool.edge_chips]]\nposition_um = 1\nwidth_um = 2\ndepth_um = 1.1\n",
       "tool.edge_chips[1].depth_um: must be > 0 and <= 1, got 1.1"},
      {"side_clearance_deg = 2\n",
       "side_clearance_deg = 2\n[[tool.edge_chips]]\nposition_um = 1\nwidth_um = 2\ndepth_um = 1\n"
       "[[tool.edge_chips]]\nposition_um = 2\nwidth_um = 2\ndepth_um = 1\n",
       "tool.edge_chips[2].position_um: must keep clear of the other chips, got 2"},
      {"side_clearance_deg = 2\n", "side_clearance_deg = 2\nedge_chips = 3\n", "tool.edge_chips: must be"},
      {"\nclearance_deg = 3", "\nclearance_deg = 1", "tool.clearance_deg: must be >= 2 and <= 15, got 1"},
      {"strategy = \"two-step\"", "strategy = \"two-steps\"", "strategy: must be"},
      {"arrangement = \"offset\"", "arrangement = \"honeycomb\"", "array.arrangement: must be"},
      {"x_gap_mm = 0", "x_gap_m = 0", "array.x_gap_m: unknown key, did you mean \"x_gap_mm\"?"},
      {"x_length_mm = 1.804", "x_length_mm = 0.4", "array.x_length_mm: must hold one element"},
      {"x_offset_mm = 0", "x_offset_mm = 0\npattern = [\"#\"]", "array.pattern: must have 4 rows"},
      {"finishing_cuts = 2", "finishing_cuts = 1.5", "process.finishing_cuts: must be a whole number, got 1.5"},
      {"plough_length_mm = 0.1", "plough_length_mm = 0.001", "process.plough_length_mm: must be at least"},
      {"shortest_plough = false", "shortest_plough = 0", "process.shortest_plough: must be true or false, got 0"},
      {"roughing_feed_mm_per_min = 50", "roughing_feed_mm_per_min = 4.9e-4",
       "process.roughing_feed_mm_per_min: must be >= 5e-04 and <= 1e+05, got 0.00049"},
      {"finishing_feed_mm_per_min = 20", "finishing_feed_mm_per_min = 4.9e-4",
       "process.finishing_feed_mm_per_min: must be >= 5e-04 and <= 1e+05, got 0.00049"},
      {"retract_feed_mm_per_min = 200", "retract_feed_mm_per_min = 0",
       "process.retract_feed_mm_per_min: must be >= 5e-04 and <= 1e+05, got 0"},
      {"machine = \"ideal\"", "machine = \"\"", "machine: must name a machine"},
      {"machine = \"ideal\"", "machine = \"a\\u0000.toml\"", "machine: must name a machine"},
      {"side_clearance_deg = 2\n", "side_clearance_deg = 2\nedge_life_mm = 0\n",
       "tool.edge_life_mm: must be > 0 and <= 1e+09, got 0"},
      {"side_clearance_deg = 2\n", "side_clearance_deg = 2\nedge_life_mm = 9\nnext_edge = \"tool\"\n",
       "tool.next_edge: must be \"stop\" or \"program\", got \"tool\""},
      {"mist = true", "stop_every_min = 0", "process.stop_every_min: must be > 0 and <= 1e+05, got 0"},
      {"mist = true", "stop_before_finishing = 1", "process.stop_before_finishing: must be true or false, got 1"},
      {"mist = true", "least_chip_um = 0", "process.least_chip_um: must be > 0 and <= 1000, got 0"},
      {"mist = true", "least_chip_um = 2.6",
       "process.least_chip_um: must be at most half of roughing_depth_um and finishing_depth_um, 2.5, got 2.6"},
      {"base_mm = 0.451", "base_mm = nan", "element.base_mm: must be a finite number, got nan"},
  };
  for (const Wrong& wrong : cases) {
    SCOPED_TRACE(wrong.message);
    const std::string message =
        refusal_of([&] { parse_job(with_replaced(good, wrong.from, wrong.to), "j.toml"); }, "not refused");
    EXPECT_TRUE(message.starts_with("j.toml:")) << message;
    EXPECT_NE(message.find(": " + wrong.message), std::string::npos) << message;
    if (wrong.from.front() != '\n' && wrong.to.find('\n') == std::string::npos) {
      EXPECT_TRUE(message.starts_with("j.toml:" + line_of(wrong.from) + ": ")) << message;
    }
  }
}

TEST(JobFile, OnlyWhatIsFinishedStopsBeforeFinishing) {
  Job job = square_job(4);
  job.process.stop_before_finishing = true;
  ASSERT_NO_THROW(parse_job(job_text(job), "j.toml"));
  job.strategy = Strategy::bidirectional;
  EXPECT_TRUE(refusal_of([&] { parse_job(job_text(job), "j.toml"); })
                  .ends_with(": process.stop_before_finishing: must be false where nothing is finished: strategy = "
                             "\"two-step\" or \"dmc\" does, got \"bidirectional\""));
}

TEST(JobFile, BasesReadBackEqual) {
  for (const char* const substrate :
       {"kind = \"plane\"\nincline_deg = 7.5\nazimuth_deg = 30\nelements = \"parallel\"\n",
        "kind = \"cylinder\"\nradius_mm = -20\naxis = \"x\"\nelements = \"parallel\"\n",
        "kind = \"cylinder\"\nradius_mm = 30\naxis = \"y\"\nelements = \"normal\"\n",
        "kind = \"sphere\"\nradius_mm = 40\nelements = \"normal\"\n",
        "kind = \"formula\"\nsag_mm = \"0.01*x^2 - y/9\"\nelements = \"parallel\"\n"}) {
    const std::string text = job_text(square_job(4)) + "\n[base]\n" + substrate;
    const Job job = parse_job(text, "j.toml");
    ASSERT_TRUE(job.substrate) << substrate;
    const std::string again = job_text(job);
    EXPECT_NE(again.find(std::string("\n[base]\n") + substrate), std::string::npos) << again;
    EXPECT_EQ(job_text(parse_job(again, "j.toml")), again);
    EXPECT_EQ(cut_elements(job).front().foot_mm, cut_elements(parse_job(again, "j.toml")).front().foot_mm);
  }
}

TEST(JobFile, BasesThatCannotBeAreRefused) {
  const auto complaint = [](const Job& job, const std::string& substrate) -> std::string {
    return refusal_of([&] { parse_job(job_text(job) + "\n[base]\n" + substrate, "j.toml"); }, "none");
  };
  const Job good = square_job(4);
  const std::string plane = "kind = \"plane\"\nincline_deg = 5\n";
  ASSERT_EQ(complaint(good, plane), "none");
  const auto expect = [&](const Job& job, const std::string& substrate, const std::string& message) {
    const std::string said = complaint(job, substrate);
    EXPECT_TRUE(said.starts_with("j.toml:")) << said;
    EXPECT_NE(said.find(": base" + message), std::string::npos) << said << "\nnot " << message;
    EXPECT_EQ(said.find('\n'), std::string::npos);
  };
  expect(good, "kind = \"cone\"\n", ".kind: must be");
  expect(good, "kind = \"plane\"\n", ".incline_deg: ");
  expect(good, "kind = \"plane\"\nincline_deg = 61\n", ".incline_deg: must be >= 0 and <= 60, got 61");
  expect(good, plane + "radius_mm = 3\n", ".radius_mm: only allowed for kind = \"cylinder\" or \"sphere\", got 3");
  expect(good, plane + "elements = \"upright\"\n", ".elements: must be");
  expect(good, "kind = \"sphere\"\nradius_mm = 0\n", ".radius_mm: must not be 0");
  expect(good, "kind = \"cylinder\"\nradius_mm = 0.3\n", ".radius_mm: ");
  expect(good, "kind = \"cylinder\"\nradius_mm = 9\naxis = \"z\"\n", ".axis: must be");
  expect(good, "kind = \"formula\"\nsag_mm = \"x +\"\n", ".sag_mm: ");
  expect(good, "kind = \"formula\"\nsag_mm = \"1/x\"\n", ".sag_mm: is not finite");
  expect(good, "kind = \"plane\"\nincline_deg = 55\nelements = \"parallel\"\n",
         ".incline_deg: must rise less over its elements for a tool to come out of its cuts");
  Job direct = good;
  direct.workpiece.kind = WorkpieceKind::direct;
  expect(direct, plane, ".incline_deg: needs a mould: workpiece.kind must be \"mould\"");
  Job offset = good;
  offset.array.x_offset_mm = 0.1;
  expect(offset, plane, ".incline_deg: not allowed together with array.x_offset_mm");
  Job masked = good;
  masked.array.pattern = {"####", "###-", "####", "###-"};
  expect(masked, plane, ".incline_deg: not allowed together with array.pattern");
  expect(square_job(1), plane, ".incline_deg: not allowed for arrangement = \"single\"");
  expect(good, "kind = \"plane\"\nincline_deg = 50\n", ".incline_deg: must keep all facets at most 88");
}

TEST(JobFile, APatternMustLeaveSomethingToCut) {
  Job job = square_job(2, Arrangement::offset);
  job.array.pattern = {"-#", "--"};  // the only cell that is cut lies in the shifted row's last column
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
