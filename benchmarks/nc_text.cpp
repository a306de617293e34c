// Measures the time and peak memory of computing the NC text of a job with 10^5 elements. The targets are 10 s and 1
// GiB.

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "core/atomic_file.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"

namespace retrace::benchmarks::nc_text_benchmark {
namespace {

using namespace retrace::fabrication;

/// Returns a job with side x side prisms of 0.2 mm in brick rows, with a roughing cut and two finishing cuts per facet.
Job large_job(int side) {
  Job job;
  job.source = "benchmark";
  prism_of(job).base_mm = prism_of(job).width_mm = 0.2;
  job.array.arrangement = retrace::geometry::Arrangement::offset;
  job.array.x_length_mm = job.array.y_length_mm = 0.2 * side;
  job.tool.width_mm = 0.2;
  job.process.name = "benchmark";
  return job;
}

Machine paper_machine() {
  const std::string file = std::string(RETRACE_SOURCE_DIR) + "/data/machines/paper.toml";
  return parse_machine(retrace::read_file(file), file);
}

void job_to_nc_text(benchmark::State& state) {
  const Job job = large_job(static_cast<int>(state.range(0)));
  const Machine machine = paper_machine();
  std::size_t elements = 0;
  std::size_t bytes = 0;
  for ([[maybe_unused]] auto step : state) {
    const Plan plan = make_plan(job, machine);
    elements = plan.elements.size();
    bytes = 0;
    for (const Program& program : plan.programs) bytes += nc_text(program, "rs274ngc").size();
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.counters["elements"] = static_cast<double>(elements);
  state.counters["text_MB"] = 1e-6 * static_cast<double>(bytes);
  state.counters["peak_MiB"] = static_cast<double>(usage.ru_maxrss) / 1024.0;
}
BENCHMARK(job_to_nc_text)->Arg(32)->Arg(100)->Arg(317)->Unit(benchmark::kSecond)->Iterations(1);

}  // namespace
}  // namespace retrace::benchmarks::nc_text_benchmark
