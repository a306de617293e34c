// Measures the time that the engine `auto` takes per direction on one thread. All designs in examples/ are traced with
// five refractive indices of the medium behind the facets and sixteen directions each, at the default target error.
//   retrace_every_direction_benchmark [PART_OF_NAME]
// The program prints the slowest direction of each example, and all directions that take more than ten seconds.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/processor_time.h"
#include "core/error.h"
#include "design/io/design_reader.h"
#include "studies/rre/rre.h"

namespace retrace::benchmarks {
namespace {

namespace fs = std::filesystem;

constexpr std::array kBackIndices = {1.0, 1.2, 1.333, 1.45, 1.6};
constexpr std::array kIncidences_deg = {0.0, 1e-3, 5.0, 20.0, 45.0, 70.0};
constexpr std::array kAzimuths_deg = {0.0, 30.0, 90.0};
constexpr double kAllowed_s = 10.0;
constexpr double kPatience_s = 300.0;  // elapsed time after which a run is cancelled

struct Measured {
  double back_index = 1.0;
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  Timed time;

  std::string text() const {
    return fmt::format("back {:5.3f}, incidence {:6.3f}, azimuth {:2.0f}: {:8.3f} s{} ({})", back_index, incidence_deg,
                       azimuth_deg, time.s, time.is_complete ? "" : ", given up", time.engine);
  }
};

std::vector<fs::path> files(const std::string& part_of_name) {
  std::vector<fs::path> found;
  const fs::path folder = fs::path(RETRACE_SOURCE_DIR) / "examples";
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".toml" && entry.path().string().find(part_of_name) != std::string::npos)
      found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

/// Returns a design, or nothing if the file is not a design (but a job, study or machine).
std::optional<design::Design> design_of(const fs::path& file) {
  try {
    return design::read_design(file);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

std::vector<Measured> measure(const design::Design& given) {
  std::vector<Measured> all;
  for (const double back_index : kBackIndices) {
    const std::string behind[] = {fmt::format("body.back_index={}", back_index)};
    const design::Design design = design::with(given, behind);
    for (const double incidence_deg : kIncidences_deg)
      for (const double azimuth_deg : kAzimuths_deg) {
        if (incidence_deg == 0.0 && azimuth_deg != 0.0) continue;
        studies::RreSettings request;
        request.incidence_deg = {incidence_deg};
        request.azimuth_deg = {azimuth_deg};
        all.push_back({back_index, incidence_deg, azimuth_deg, timed(design, request, kPatience_s)});
      }
  }
  return all;
}

}  // namespace

int run(const std::string& part_of_name) {
  std::size_t directions = 0, slow = 0;
  double total_s = 0.0;
  for (const fs::path& file : files(part_of_name)) {
    const auto design = design_of(file);
    if (!design) continue;
    std::vector<Measured> all = measure(*design);
    std::ranges::sort(all, std::greater(), [](const Measured& m) { return m.time.s; });
    double sum_s = 0.0;
    for (const Measured& m : all) sum_s += m.time.s;
    fmt::print("{:28} mean {:6.3f} s; worst at {}\n", file.stem().string(), sum_s / static_cast<double>(all.size()),
               all.front().text());
    for (const Measured& m : all) {
      if (m.time.is_complete && m.time.s <= kAllowed_s) break;
      fmt::print("  above {} s: {}\n", kAllowed_s, m.text());
      ++slow;
    }
    std::fflush(stdout);
    directions += all.size();
    total_s += sum_s;
  }
  fmt::print("{} directions in {:.1f} s, {} of them above {} s\n", directions, total_s, slow, kAllowed_s);
  return 0;
}

}  // namespace retrace::benchmarks

int main(int count, char** values) {
  return retrace::benchmarks::run(count > 1 ? values[1] : "");
}
