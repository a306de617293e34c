#include "fabrication/job/io/job_files.h"
#include "fabrication/job/io/process_files.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/planing/io/part_files.h"
#include "fabrication/turning/io/part_files.h"
#include "tests/support/documents.h"
#include "tests/support/key_table.h"
#include "tests/support/refusals.h"

// Tests of process and machine files: written files can be read back unchanged, and the documentation agrees with the
// rows of the formats.

namespace retrace::fabrication::formats_test {
namespace {

using geometry::Vec3;

double real(double low, double high) {
  return low + (high - low) * *rc::gen::inRange(0, 1 << 30) / static_cast<double>(1 << 30);
}
std::string some_text() {
  return *rc::gen::nonEmpty(rc::gen::container<std::string>(rc::gen::inRange<char>(1, 127)));
}

template <class Value>
Sourced<Value> sourced(Value value) {
  return {std::move(value), *rc::gen::element(Basis::measured, Basis::assumed), some_text()};
}
template <class Value>
bool same(const Sourced<Value>& a, const Sourced<Value>& b) {
  return a.value == b.value && a.basis == b.basis && a.source == b.source;
}
bool same(const Sourced<Interval>& a, const Sourced<Interval>& b) {
  return a.value.low == b.value.low && a.value.high == b.value.high && a.basis == b.basis && a.source == b.source;
}

LinearAxis linear_axis(const Vec3& near) {
  return {sourced<Vec3>((near + 0.1 * Vec3(real(-1, 1), real(-1, 1), real(-1, 1))).normalized()),
          sourced(Interval{real(-1e4, 0), real(1, 1e4)}), sourced(real(1e-3, 1e6)), sourced(real(1e-3, 1e6)),
          sourced(real(1e-3, 1e6))};
}
RotaryAxis rotary_axis(const Vec3& near) {
  return {sourced<Vec3>(Vec3(real(-1e4, 1e4), real(-1, 1), 0)),
          sourced<Vec3>((near + 0.1 * Vec3(real(-1, 1), real(-1, 1), real(-1, 1))).normalized()),
          sourced(*rc::gen::element(1.0, -1.0)),
          sourced(Interval{real(-3600, 0), real(1, 3600)}),
          sourced(real(1e-3, 1e6)),
          sourced(real(1e-3, 1e6))};
}
MachineBody body() {
  MachineBody result = {
      some_text(), *rc::gen::element(KinematicLink::workpiece, KinematicLink::cradle, KinematicLink::tool), {}};
  result.points_mm = sourced<std::vector<Vec3>>(
      {Vec3(real(-1e3, 0), 0, 0), Vec3(1, real(-1, 1), 0), Vec3(0, 1, 0), Vec3(0, 0, real(1, 1e4))});
  return result;
}
Machine machine() {
  Machine m;
  m.name = some_text();
  m.title = *rc::gen::arbitrary<bool>() ? some_text() : "";
  m.x = linear_axis({1, 0, 0});
  m.y = linear_axis({0, 1, 0});
  m.z = linear_axis({0, 0, 1});
  m.tilt = *rc::gen::element(Tilt::table, Tilt::head);
  m.a = rotary_axis(m.tilt == Tilt::table ? Vec3(1, 0, 0) : Vec3(0, 1, 0));
  m.c = rotary_axis({0, 0, 1});
  if (*rc::gen::arbitrary<bool>()) {
    m.mount.offset_mm = sourced<Vec3>(Vec3(real(-10, 10), real(-1, 1), 0));
    m.mount.rotation_deg = sourced<Vec3>(Vec3(real(-5, 5), 0, real(-1, 1)));
  }
  for (int k = *rc::gen::inRange(0, 3); k > 0; --k) m.bodies.push_back(body());
  return m;
}

bool same(const LinearAxis& a, const LinearAxis& b) {
  return same(a.direction, b.direction) && same(a.limits_mm, b.limits_mm) &&
         same(a.max_feed_mm_per_min, b.max_feed_mm_per_min) && same(a.rapid_mm_per_min, b.rapid_mm_per_min) &&
         same(a.acceleration_mm_per_s2, b.acceleration_mm_per_s2);
}
bool same(const RotaryAxis& a, const RotaryAxis& b) {
  return same(a.point_mm, b.point_mm) && same(a.direction, b.direction) && same(a.sign, b.sign) &&
         same(a.limits_deg, b.limits_deg) && same(a.speed_deg_per_s, b.speed_deg_per_s) &&
         same(a.acceleration_deg_per_s2, b.acceleration_deg_per_s2);
}
bool same(const Machine& a, const Machine& b) {
  bool is_same = a.name == b.name && a.title == b.title && a.tilt == b.tilt && same(a.x, b.x) && same(a.y, b.y) &&
                 same(a.z, b.z) && same(a.a, b.a) && same(a.c, b.c) && same(a.mount.offset_mm, b.mount.offset_mm) &&
                 same(a.mount.rotation_deg, b.mount.rotation_deg) && a.bodies.size() == b.bodies.size();
  for (std::size_t i = 0; is_same && i < a.bodies.size(); ++i)
    is_same = a.bodies[i].name == b.bodies[i].name && a.bodies[i].link == b.bodies[i].link &&
              same(a.bodies[i].points_mm, b.bodies[i].points_mm);
  return is_same;
}

RC_GTEST_PROP(MachineFile, ReadsBackToTheSameMachine, ()) {
  const Machine m = machine();
  RC_ASSERT(same(parse_machine(schema::object_text(machine_format(), &m), "m.toml"), m));
}

TEST(MachineFile, ShippedMachinesReadBackTheSame) {
  for (const char* const name : {"ideal", "ideal-dmc", "paper", "thesis"}) {
    const std::string file = std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml";
    const Machine m = parse_machine(read_file(file), file);
    EXPECT_TRUE(same(parse_machine(schema::object_text(machine_format(), &m), "m.toml"), m)) << name;
  }
}

bool same(const Process& a, const Process& b) {
  return schema::object_text(process_format(), &a) == schema::object_text(process_format(), &b) && a.name == b.name &&
         a.clearance_mm == b.clearance_mm && a.finishing_cuts == b.finishing_cuts &&
         a.shortest_plough == b.shortest_plough && a.finishing_plunge_sa_nm == b.finishing_plunge_sa_nm;
}

RC_GTEST_PROP(ProcessFile, ReadsBackToTheSameProcess, ()) {
  Process p;
  p.name = some_text();
  p.source = some_text();
  p.clearance_mm = real(1e-6, 100.0);
  p.roughing_depth_um = real(1e-3, 1000.0);
  p.finishing_depth_um = real(1e-3, 1000.0);
  p.finishing_cuts = *rc::gen::inRange(1, 1001);
  p.plough_length_mm = real(1.0, 100.0);
  p.dwell_s = real(0.0, 60.0);
  p.roughing_feed_mm_per_min = real(kMinFeedMmPerMin, 1e5);
  p.finishing_feed_mm_per_min = real(kMinFeedMmPerMin, 1e5);
  p.retract_feed_mm_per_min = real(kMinFeedMmPerMin, 1e5);
  p.shortest_plough = *rc::gen::arbitrary<bool>();
  p.plough_lift_um = real(0.0, 1000.0);
  p.slow_retract_um = real(0.0, 1000.0);
  p.rotary_clearance_mm = real(1e-6, 100.0);
  p.plough_sa_nm = real(0.0, 1e4);
  p.roughing_plunge_sa_nm = real(0.0, 1e4);
  p.finishing_plunge_sa_nm = real(0.0, 1e4);
  RC_ASSERT(same(parse_process(schema::object_text(process_format(), &p), "p.toml"), p));
}

TEST(ProcessFile, DefaultsAreThoseOfAProcess) {
  const Process p = parse_process(
      "schema = \"retrace.process/1\"\nname = \"\"\nsource = \"\"\nclearance_mm = 0.2\nroughing_depth_um = 15\n"
      "finishing_depth_um = 5\nplough_length_mm = 0.1\nroughing_feed_mm_per_min = 50\nfinishing_feed_mm_per_min = 20\n"
      "retract_feed_mm_per_min = 200\n",
      "p.toml");
  EXPECT_TRUE(same(p, Process{}));
}

/// Returns the error message for a process file whose last line is wrong.
std::string refusal(const std::string& line) {
  return refusal_of(
      [&] {
        parse_process(
            "schema = \"retrace.process/1\"\nname = \"p\"\nsource = \"s\"\nclearance_mm = 0.2\nroughing_depth_um = 15\n"
            "finishing_depth_um = 5\nroughing_feed_mm_per_min = 50\nfinishing_feed_mm_per_min = 20\n"
            "retract_feed_mm_per_min = 200\n" +
                line,
            "p.toml");
      },
      "accepted");
}

TEST(ProcessFile, WhatIsWrongIsRefusedWithFileLineAndKey) {
  expect_refusals(refusal, {{"plough_length_mm = 0.1\n", "accepted"},
                            {"", "p.toml: plough_length_mm"},
                            {"plough_length_mm = 0.014\n", "p.toml:10: plough_length_mm"},
                            {"plough_length_mm = 0.014\nshortest_plough = true\n", "accepted"},
                            {"plough_length_mm = 0.1\nfinishing_cuts = 1001\n", "p.toml:11: finishing_cuts"},
                            {"plough_length_mm = 0.1\ndwel_s = 1\n", "p.toml:11: dwel_s"}});
}

RC_GTEST_PROP(JobFile, DocumentsReadBackTheSame, ()) {
  documents_test::expect_random_document_to_read_back(job_format());
}

RC_GTEST_PROP(PlanedPartFile, DocumentsReadBackTheSame, ()) {
  documents_test::expect_random_document_to_read_back(planed_part_format());
}

RC_GTEST_PROP(TurnedPartFile, DocumentsReadBackTheSame, ()) {
  documents_test::expect_random_document_to_read_back(turning::turned_part_format());
}

TEST(FormatsInTheDocumentation, AreWhatTheRowsSay) {
  EXPECT_EQ(documents_test::documented("machine_file.md", "machine"), schema::key_tables(machine_format()));
  EXPECT_EQ(documents_test::documented("job_file.md", "job"), schema::key_tables(job_format()));
  EXPECT_EQ(documents_test::documented("planing_file.md", "planed_part"), schema::key_tables(planed_part_format()));
  EXPECT_EQ(documents_test::documented("turning_file.md", "turned_part"),
            schema::key_tables(turning::turned_part_format()));
}

}  // namespace
}  // namespace retrace::fabrication::formats_test
