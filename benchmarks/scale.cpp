// Peak memory and time of the program against the number of elements. A program of its own: a process started from one
// with much memory is charged for that too.
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

/// A design file of side x side prisms of 0.451 mm; 222 on a side make a lens of 100 cm^2.
std::filesystem::path write_design(std::int64_t side) {
  const auto path = std::filesystem::temp_directory_path() / ("retrace_scale_" + std::to_string(::getpid()) + ".toml");
  const double length = 0.451 * static_cast<double>(side);
  std::ofstream(path) << "[element]\nkind = \"rtp\"\nbase_mm = 0.451\nwidth_mm = 0.451\n"
                      << "[array]\narrangement = \"offset\"\nx_length_mm = " << length << "\ny_length_mm = " << length
                      << "\n[body]\nthickness_mm = 3.0\nrefractive_index = 1.4917\n";
  return path;
}

/// Arg: elements along a side.
void scale(benchmark::State& state) {
  const auto design = write_design(state.range(0));
  rusage usage{};
  for (auto _ : state) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::execl(RETRACE_PROGRAM, "retrace", "rre", design.c_str(), "--incidence=3", "--azimuth=20", "--samples=131072",
              "--quiet", static_cast<char*>(nullptr));
      std::_Exit(EXIT_FAILURE);
    }
    int status = 0;
    if (child < 0 || ::wait4(child, &status, 0, &usage) < 0 || status != 0) {
      state.SkipWithError("the program failed");
      break;
    }
  }
  std::filesystem::remove(design);
  state.counters["elements"] = static_cast<double>(state.range(0) * state.range(0));
  state.counters["peak_MiB"] = static_cast<double>(usage.ru_maxrss) / 1024.0;
}

BENCHMARK(scale)
    ->ArgName("side")
    ->Arg(10)
    ->Arg(32)
    ->Arg(100)
    ->Arg(222)
    ->Arg(316)
    ->Arg(1000)
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
