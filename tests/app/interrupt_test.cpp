// Tests of interrupts during long work, for each command.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>
#include <vector>

#include "tests/app/program.h"

namespace retrace::test::interrupt_test {
namespace {

using namespace std::chrono_literals;

// Maximum processor time, in s, that a run may use after an interrupt: one second, plus the time to write the remaining
// results. Processor time does not depend on other work on the machine.
constexpr double kAfter_s = 2.0;
constexpr auto kFarTooLong = 300s;

struct LongRun {
  std::string name;
  Arguments arguments;
  int signal = SIGINT;
  double before_s = 0.5;              ///< processor time before the interrupt
  std::vector<Arguments> first = {};  ///< runs that create the inputs
};

void PrintTo(const LongRun& run, std::ostream* stream) {
  *stream << run.name;
}

class LongWork : public testing::TestWithParam<LongRun> {};

TEST_P(LongWork, EndsWithinASecondOfAnInterrupt) {
  const TemporaryFolder folder;
  folder.write(
      "finite.toml",
      "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 0.5\n[array]\nextent = \"finite\"\nx_length_mm = 12\n"
      "y_length_mm = 12\n[body]\nthickness_mm = 1.5\nmaterial = \"PMMA\"\n"
      "[surface]\nangle_error_sigma_arcmin = 1\nangle_error_seed = 3\n");
  folder.write("wide.toml",
               "[element]\nkind = \"rtp\"\nbase_mm = 0.2\nwidth_mm = 0.2\n[array]\narrangement = \"offset\"\n"
               "overlap_percent = 50\nextent = \"finite\"\nx_length_mm = 80\ny_length_mm = 80\n[body]\n"
               "thickness_mm = 1.5\nmaterial = \"PMMA\"\n");
  for (const Arguments& first : GetParam().first) {
    const Outcome made = retrace(folder, first);
    ASSERT_EQ(made.code, 0) << made.err;
  }
  Arguments arguments = GetParam().arguments;
  arguments.insert(arguments.begin(), RETRACE_PROGRAM);
  Child child(folder.path(), arguments);
  while (!child.has_ended() && child.processor_time_s() < GetParam().before_s) std::this_thread::sleep_for(5ms);
  ASSERT_FALSE(child.has_ended()) << "too short to be interrupted: " << child.wait().err;
  const double before_s = child.processor_time_s();
  child.interrupt(GetParam().signal);
  const Outcome outcome = child.wait(kFarTooLong);
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  for (const std::string& name : folder.names()) EXPECT_FALSE(name.ends_with(".tmp")) << name;
  EXPECT_LT(outcome.processor_time_s - before_s, kAfter_s);
}

const Arguments kJob = {"job",     "wide.toml", "--machine=ideal", "--strategy=two-step", "--tool-width-mm=0.2",
                        "--quiet", "-o",        "job.toml"};
const Arguments kFabricate = {"fabricate", "job.toml", "--dialect=rs274ngc", "--quiet", "-o", "f"};
const std::string kReflector = example("reflex_reflector.toml");

INSTANTIATE_TEST_SUITE_P(
    Commands, LongWork,
    testing::Values(
        LongRun{"rre", {"rre", example("tail_lamp_100cm2.toml"), "--threads=1", "--samples=4294967296"}},
        LongRun{"rre_exact",
                {"rre", kReflector, "--threads=1", "--engine=exact", "--cutoff=1e-12", "--incidence=5:60:1",
                 "--footprint", "-o", "r"}},
        LongRun{"photometry_of_a_finite_part",
                {"photometry", "finite.toml", "--threads=1", "--standard=r150", "--class=IA", "--colour=red",
                 "--area-cm2=1.44", "--engine=exact", "--light=design", "-o", "p"},
                SIGINT,
                3.0},  // at this time, all beams are traced; the sum over their polygons takes minutes
        LongRun{"photometry_by_rays",
                {"photometry", kReflector, "--threads=1", "--standard=r150", "--class=IA", "--colour=red",
                 "--area-cm2=30", "--engine=montecarlo", "--samples=4294967296"},
                SIGTERM},
        LongRun{"photometry_with_preliminary_readings",
                {"photometry", kReflector, "--threads=1", "--standard=r150", "--class=IA", "--colour=red",
                 "--area-cm2=30", "--engine=montecarlo", "--samples=4294967296"},
                SIGINT,
                3.0},  // the preliminary readings are being computed at this time
        LongRun{"photometry_seeks_advice",
                {"photometry", kReflector, "--threads=1", "--standard=r150", "--class=IA", "--colour=red",
                 "--area-cm2=1e-3", "--rotation=0,20,40,60", "--quiet"},
                SIGINT,
                2.0},  // at this time, the table is finished, which is a third of the work
        LongRun{"image_detector",
                {"image", example("rtp_brick_2mm.toml"), "--detector", "--threads=1", "--engine=montecarlo",
                 "--samples=1000000000", "-o", "i"}},
        LongRun{"image_camera", {"image", example("rtp_brick_2mm.toml"), "--camera", "--threads=1", "-o", "i"}},
        LongRun{"image_road", {"image", "finite.toml", "--road", "--threads=1", "--dye=red", "-o", "i"}, SIGTERM},
        LongRun{"sweep", {"sweep", example("studies/incline_photometry.toml"), "--threads=1", "-o", "s"}},
        LongRun{
            "tolerance", {"tolerance", example("studies/tolerance_reflector.toml"), "--threads=1", "-o", "t"}, SIGTERM},
        LongRun{"optimize", {"optimize", example("studies/element_base.toml"), "--threads=1", "-o", "o"}, SIGINT, 0.3},
        LongRun{"inspect", {"inspect", "wide.toml", "--set=array.x_length_mm=40000", "-o", "i"}},
        LongRun{"export", {"export", "wide.toml", "e.stl"}, SIGTERM},
        LongRun{"export_of_a_material", {"export", kReflector, "m.json", "--threads=1"}},
        LongRun{"turn", {"turn", example("turning/lenslet_array.toml"), "-o", "t"}, SIGHUP},
        LongRun{"fabricate", kFabricate, SIGTERM, 0.5, {kJob}},
        LongRun{"validate", {"validate", "--threads=1", "-o", "v.md"}},
        LongRun{"verify", {"verify", "job.toml", "f/program.ngc", "--threads=1"}, SIGINT, 0.5, {kJob, kFabricate}},
        LongRun{"rays",
                {"rays", "wide.toml", "--emitter=lambertian", "--threads=1", "--rays=1000000000", "--split=1e-5", "-o",
                 "r.csv"}},
        LongRun{"roughness", {"roughness", example("facet_quality.toml"), "--threads=1", "--target-error=1e-6"}}),
    [](const auto& run) { return run.param.name; });

/// If the work does not stop in time after an interrupt, the process ends immediately. It prints one line and leaves no
/// temporary file.
TEST(Interrupt, WorkThatCannotStopInTimeLeavesNoTemporaryFile) {
  const TemporaryFolder folder;
  const Arguments arguments = {RETRACE_PROGRAM,
                               "rays",
                               example("rtp_brick_2mm.toml"),
                               "--emitter=lambertian",
                               "--rays=1000000000",
                               "--threads=1",
                               "--quiet",
                               "-o",
                               "r.csv"};
  Child child(folder.path(), arguments);
  const auto is_temporary = [](const std::string& name) { return name.ends_with(".tmp"); };
  const auto has_temporary = [&] { return std::ranges::any_of(folder.names(), is_temporary); };
  while (!child.has_ended() && !has_temporary()) std::this_thread::sleep_for(5ms);
  ASSERT_TRUE(has_temporary());
  child.interrupt(SIGALRM);  // signal at the deadline that an interrupt sets
  const Outcome outcome = child.wait(kFarTooLong);
  EXPECT_EQ(refused_at(outcome, 130), "");
  EXPECT_FALSE(has_temporary());
}

}  // namespace
}  // namespace retrace::test::interrupt_test
