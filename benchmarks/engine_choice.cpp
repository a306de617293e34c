// Measures the additional cost of the engine `auto` relative to the faster engine, for random designs with three
// directions each, on one thread.
//   retrace_engine_choice_benchmark [DESIGNS [FIRST_SEED [TARGET_ERROR]]]
// The program prints one line per design. At the end it compares `auto` with the faster of the exact engine and Monte
// Carlo.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/processor_time.h"
#include "benchmarks/random_designs.h"
#include "core/error.h"
#include "design/io/design_reader.h"
#include "studies/rre/rre.h"

namespace retrace::benchmarks {
namespace {

Timed timed_by(const design::Design& design, studies::RreSettings request, raytrace::Engine engine, double most_s) {
  request.engine = engine;
  return timed(design, request, most_s);
}

struct Comparison {
  double automatic_s = 0.0;
  double faster_s = 0.0;

  double ratio() const { return automatic_s / faster_s; }
  bool keeps(double factor) const { return automatic_s <= factor * faster_s + 0.05; }
};

std::optional<Comparison> compare(unsigned seed, double target_error) {
  RandomDesigns random(seed);
  const std::string text = random.next();
  studies::RreSettings request;
  request.incidence_deg = {random.between(0.0, 10.0), random.between(10.0, 30.0), random.between(30.0, 60.0)};
  request.azimuth_deg = {random.between(0.0, 90.0)};
  request.target_error = target_error;
  try {
    const design::Design design = design::parse_design(text, fmt::format("design {}", seed));
    constexpr double kPatience_s = 60.0;
    const Timed rays = timed_by(design, request, raytrace::Engine::montecarlo, kPatience_s);
    const Timed automatic = timed_by(design, request, raytrace::Engine::automatic, 2.0 * kPatience_s);
    Timed exact{kPatience_s, false, ""};
    if (text.find("roughness") == std::string::npos)
      exact = timed_by(design, request, raytrace::Engine::exact, 1.2 * rays.s + 0.1);
    const double faster_s = exact.is_complete ? std::min(exact.s, rays.s) : rays.s;
    const Comparison comparison{automatic.s, faster_s};
    if (std::getenv("RETRACE_SHOW_DESIGNS") != nullptr) fmt::print("{}\n", text);
    fmt::print("{:4}  auto {:8.3f} s ({:>6})  {:>6} {:8.3f} s  exact {:>10}  ratio {:5.2f}\n", seed, automatic.s,
               automatic.engine, rays.engine, rays.s, exact.is_complete ? fmt::format("{:.3f} s", exact.s) : "-",
               comparison.ratio());
    return comparison;
  } catch (const InputError&) {
    return std::nullopt;  // the random sizes are not a valid design; the next design is tried
  }
}

}  // namespace

int run(unsigned designs, unsigned seed, double target_error) {
  std::vector<Comparison> all;
  for (; all.size() < designs; ++seed)
    if (const auto comparison = compare(seed, target_error)) all.push_back(*comparison);
  const auto share = [&](double factor) {
    return 100.0 *
           static_cast<double>(std::count_if(all.begin(), all.end(), [&](const auto& c) { return c.keeps(factor); })) /
           static_cast<double>(all.size());
  };
  double automatic_s = 0.0, faster_s = 0.0;
  for (const Comparison& c : all) {
    automatic_s += c.automatic_s;
    faster_s += c.faster_s;
  }
  fmt::print(
      "{} designs, target error {}: within 1.5 times the faster engine + 50 ms {:.1f} %, within twice {:.1f} %; in all "
      "{:.1f} s, the faster engines {:.1f} s\n",
      all.size(), target_error, share(1.5), share(2.0), automatic_s, faster_s);
  return 0;
}

}  // namespace retrace::benchmarks

int main(int count, char** values) {
  const auto number = [&](int k, double otherwise) { return k < count ? std::atof(values[k]) : otherwise; };
  return retrace::benchmarks::run(static_cast<unsigned>(number(1, 300)), static_cast<unsigned>(number(2, 1)),
                                  number(3, 1e-3));
}
