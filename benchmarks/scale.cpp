// Measures peak memory and time of the program as functions of the number of elements.
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace retrace::benchmarks::scale_benchmark {
namespace {

/// Writes a design file of side x side prisms of 0.451 mm. With 222 prisms on a side, the lens has 100 cm^2.
/// \param substrate tables of the design file for the substrate and the plate that covers it; if it is empty, the
///     prisms are on the plane z = 0
std::filesystem::path write_design(std::int64_t side, const std::string& substrate) {
  const auto path = std::filesystem::temp_directory_path() / ("retrace_scale_" + std::to_string(::getpid()) + ".toml");
  const double length = 0.451 * static_cast<double>(side);
  std::ofstream(path) << "[element]\nkind = \"rtp\"\nbase_mm = 0.451\nwidth_mm = 0.451\n"
                      << "[array]\narrangement = \"offset\"\nx_length_mm = " << length << "\ny_length_mm = " << length
                      << "\n"
                      << substrate << "[body]\nthickness_mm = 3.0\nrefractive_index = 1.4917\n";
  return path;
}

/// Returns a substrate by number: a plane inclined by 10 degrees, a cylinder, or a sphere. The radius is proportional
/// to the size of the part.
std::string substrate_of(std::int64_t kind, std::int64_t side) {
  const double radius_mm = 0.451 * static_cast<double>(side);
  switch (kind) {
    case 1: return "[substrate]\nkind = \"plane\"\nincline_deg = 10\n";
    case 2: return "[substrate]\nkind = \"cylinder\"\nradius_mm = " + std::to_string(radius_mm) + "\n";
    case 3: return "[substrate]\nkind = \"sphere\"\nradius_mm = " + std::to_string(radius_mm) + "\n";
    default: return "";
  }
}

/// Args: elements along a side; number of the substrate.
void scale(benchmark::State& state) {
  const auto design = write_design(state.range(0), substrate_of(state.range(1), state.range(0)));
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
    ->ArgNames({"side", "base"})
    ->ArgsProduct({{10, 32, 100, 222, 316, 1000}, {0, 1, 2, 3}})
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace retrace::benchmarks::scale_benchmark
