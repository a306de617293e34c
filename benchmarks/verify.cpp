// Measures the verification of NC text: time as a function of the number of elements. The prisms and their cuts are
// those of the samples in Milliken 2017, section 2.7.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "fabrication/chisel/check/verify.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"

namespace retrace::benchmarks::verify_benchmark {
namespace {

using namespace fabrication;

/// Returns a job with rows of 50 prisms of 0.451 mm, with 22 roughing cuts and two finishing cuts per facet.
Job job_of(std::int64_t elements) {
  Job job;
  prism_of(job).base_mm = prism_of(job).width_mm = 0.451;
  job.array.arrangement = geometry::Arrangement::aligned;
  job.array.x_length_mm = 0.451 * 50;
  job.array.y_length_mm = 0.451 * static_cast<double>(elements) / 50.0;
  job.tool.width_mm = 0.451;
  job.strategy = Strategy::two_step;
  job.process.name = "benchmark";
  return job;
}

/// Arg: number of elements.
void verify(benchmark::State& state) {
  const Job job = job_of(state.range(0));
  Machine machine = load_machine("paper", {});
  // The axis limits are large enough for arrays of any length.
  machine.x.limits_mm.value = machine.y.limits_mm.value = machine.z.limits_mm.value = {-1e4, 1e4};
  std::vector<std::string> texts;
  for (const Program& program : make_plan(job, machine).programs) texts.push_back(nc_text(program, "rs274ngc"));
  std::size_t bytes = 0;
  for (auto _ : state) {
    std::vector<NcProgram> programs;
    bytes = 0;
    for (const std::string& text : texts) {
      programs.push_back(parse_nc(text, "p.ngc", NcDialect::rs274ngc));
      bytes += text.size();
    }
    const Verification result = verify_programs(job, machine, programs, {}, {});
    if (!result.passes()) state.SkipWithError(result.findings.front().message.c_str());
  }
  state.counters["bytes"] = static_cast<double>(bytes);
  state.counters["time/element"] = benchmark::Counter(static_cast<double>(state.range(0) * state.iterations()),
                                                      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(verify)->Arg(250)->Arg(1250)->Arg(5000)->Arg(50000)->Unit(benchmark::kSecond)->UseRealTime()->Iterations(1);

}  // namespace
}  // namespace retrace::benchmarks::verify_benchmark
