// Measures time and memory of the complete program for camera pictures of 100 cm2 of prisms (about 49,000 elements) at
// 1 % noise. Each picture is computed in a separate process, so that its memory is measured separately.
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

namespace retrace::benchmarks::camera_benchmark {
namespace {

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Computes a picture with the given number of columns and rows. Smaller pictures show a smaller part of the array, so
/// that the size of the pixels is constant.
void camera(benchmark::State& state) {
  const auto side = state.range(0);
  const std::string pixels = std::to_string(side) + "x" + std::to_string(side);
  const std::string field_mm = std::to_string(0.115 * static_cast<double>(side));
  rusage usage{};
  for (auto _ : state) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::execl(RETRACE_PROGRAM, "retrace", "image", RETRACE_SOURCE_DIR "/examples/tail_lamp_100cm2.toml", "--camera",
              "--observation-deg", "0.1", "--noise", "0.01", "--pixels", pixels.c_str(), "--field-mm", field_mm.c_str(),
              "--quiet", "--json", "/dev/null", static_cast<char*>(nullptr));
      std::_Exit(EXIT_FAILURE);
    }
    int status = 0;
    if (child < 0 || ::wait4(child, &status, 0, &usage) < 0 || status != 0) {
      state.SkipWithError("the program failed");
      break;
    }
  }
  state.counters["Mpixel"] = 1e-6 * static_cast<double>(side * side);
  state.counters["processor_s"] = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  state.counters["peak_MiB"] = static_cast<double>(usage.ru_maxrss) / 1024.0;
}

BENCHMARK(camera)->ArgName("columns")->Arg(250)->Arg(1000)->Iterations(1)->UseRealTime()->Unit(benchmark::kSecond);

}  // namespace
}  // namespace retrace::benchmarks::camera_benchmark
