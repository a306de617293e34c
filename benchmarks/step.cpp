// Measures time and memory of the complete program for writing arrays as STEP, STL and OBJ. Each file is written in a
// separate process, so that its memory is measured separately.
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace retrace::benchmarks::step_benchmark {
namespace {

namespace fs = std::filesystem;

/// Writes a design file of `columns` x `rows` prisms of 0.45 mm in brick rows.
fs::path write_design(std::int64_t columns, std::int64_t rows) {
  const fs::path path = fs::temp_directory_path() / ("retrace_step_" + std::to_string(::getpid()) + ".toml");
  std::ofstream(path) << "[element]\nkind = \"rtp\"\nbase_mm = 0.45\nwidth_mm = 0.45\n"
                      << "[array]\narrangement = \"offset\"\nx_length_mm = " << 0.45 * static_cast<double>(columns)
                      << "\ny_length_mm = " << 0.45 * static_cast<double>(rows) << "\n[body]\nthickness_mm = 2.0\n";
  return path;
}

void write_solid(benchmark::State& state, const char* ending) {
  const fs::path design = write_design(state.range(0), state.range(1));
  fs::path file = design;
  file.replace_extension(ending);
  rusage usage{};
  for (auto _ : state) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::execl(RETRACE_PROGRAM, "retrace", "export", design.c_str(), file.c_str(), "--quiet",
              static_cast<char*>(nullptr));
      std::_Exit(EXIT_FAILURE);
    }
    int status = 0;
    if (child < 0 || ::wait4(child, &status, 0, &usage) < 0 || status != 0) {
      state.SkipWithError("the program failed");
      break;
    }
  }
  std::error_code ignored;
  state.counters["file_MB"] = static_cast<double>(fs::file_size(file, ignored)) / 1e6;
  state.counters["elements"] = static_cast<double>(state.range(0) * state.range(1));
  state.counters["peak_MiB"] = static_cast<double>(usage.ru_maxrss) / 1024.0;
  fs::remove(design, ignored);
  fs::remove(file, ignored);
}

void step(benchmark::State& state) {
  write_solid(state, ".step");
}
void stl(benchmark::State& state) {
  write_solid(state, ".stl");
}
void obj(benchmark::State& state) {
  write_solid(state, ".obj");
}

constexpr auto kMilliseconds = benchmark::kMillisecond;

BENCHMARK(step)
    ->ArgNames({"columns", "rows"})
    ->Args({10, 10})
    ->Args({40, 25})
    ->Args({100, 50})
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(kMilliseconds);
BENCHMARK(stl)
    ->ArgNames({"columns", "rows"})
    ->Args({40, 25})
    ->Args({222, 222})
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(kMilliseconds);
BENCHMARK(obj)->ArgNames({"columns", "rows"})->Args({40, 25})->Iterations(1)->UseRealTime()->Unit(kMilliseconds);

}  // namespace
}  // namespace retrace::benchmarks::step_benchmark
