// Measures time and peak memory of tracing rays from a TM-25 file through a part and writing them to a file, on one
// thread. For comparison, Monte Carlo is run with the same number of rays.
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/random.h"
#include "studies/rays/io/tm25.h"

namespace retrace::benchmarks::rays_benchmark {
namespace {

namespace fs = std::filesystem;

constexpr double kSideMm = 10.0;

struct Folder {
  Folder() : path(fs::temp_directory_path() / ("retrace_rays_" + std::to_string(::getpid()))) {
    fs::create_directory(path);
  }
  ~Folder() { fs::remove_all(path); }
  fs::path path;
};

void write_design(const fs::path& file) {
  std::ofstream(file) << "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\narrangement = \"offset\"\n"
                      << "x_length_mm = " << kSideMm << "\ny_length_mm = " << kSideMm
                      << "\n[body]\nthickness_mm = 0.5\nrefractive_index = 1.4917\n";
}

/// Writes parallel rays that hit the entrance face vertically at random positions.
void write_rays(const fs::path& file, std::int64_t count) {
  studies::Tm25Sink sink(file);
  sink.begin({});
  std::vector<studies::AccountedRay> rays;
  for (std::int64_t k = 0; k < count; ++k) {
    const auto words = philox({1, 1}, static_cast<std::uint32_t>(k), 0);
    studies::AccountedRay& ray = rays.emplace_back();
    ray.position_mm = {kSideMm * unit_interval(words[0]), kSideMm * unit_interval(words[1]), 3.0};
    ray.direction = -geometry::Vec3::UnitZ();
    ray.radiant_w = 1.0;
    if (rays.size() < 65536 && k + 1 < count) continue;
    sink.write(rays);
    rays.clear();
  }
  sink.finish();
}

/// Runs the program and measures its processor time and peak memory.
/// \return true if the program succeeded
bool run(std::vector<std::string> arguments, double& seconds, double& peak_mib) {
  arguments.insert(arguments.begin(), RETRACE_PROGRAM);
  for (const char* more : {"--threads=1", "--quiet"}) arguments.emplace_back(more);
  std::vector<char*> raw;
  for (std::string& argument : arguments) raw.push_back(argument.data());
  raw.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    ::execv(RETRACE_PROGRAM, raw.data());
    std::_Exit(EXIT_FAILURE);
  }
  int status = 0;
  rusage usage{};
  if (child < 0 || ::wait4(child, &status, 0, &usage) < 0 || status != 0) return false;
  const auto of = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  seconds = of(usage.ru_utime) + of(usage.ru_stime);
  peak_mib = static_cast<double>(usage.ru_maxrss) / 1024.0;
  return true;
}

/// Arg: number of rays.
void rays_in_and_out(benchmark::State& state) {
  const Folder folder;
  const std::string design = folder.path / "bricks.toml";
  const std::string in = folder.path / "in.tm25ray";
  const std::string out = folder.path / "out.tm25ray";
  write_design(design);
  write_rays(in, state.range(0));
  double seconds = 0.0;
  double plain_seconds = 0.0;
  double peak_mib = 0.0;
  double ignored = 0.0;
  for (auto _ : state) {
    const bool is_done =
        run({"rays", design, "--source", in, "-o", out}, seconds, peak_mib) &&
        run({"rre", design, "--sampling=plain", "--samples=" + std::to_string(state.range(0))}, plain_seconds, ignored);
    if (is_done) continue;
    state.SkipWithError("the program failed");
    break;
  }
  const auto count = static_cast<double>(state.range(0));
  state.counters["Mrays_per_s"] = 1e-6 * count / seconds;
  state.counters["plain_Mrays_per_s"] = 1e-6 * count / plain_seconds;
  state.counters["of_plain"] = plain_seconds / seconds;
  state.counters["peak_MiB"] = peak_mib;
}

BENCHMARK(rays_in_and_out)
    ->Arg(100'000)
    ->Arg(1'000'000)
    ->Arg(10'000'000)
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace retrace::benchmarks::rays_benchmark
