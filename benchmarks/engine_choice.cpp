// What `auto` costs beside the engine that was faster: random designs, three directions each, one thread.
//   retrace_engine_choice_benchmark [DESIGNS [FIRST_SEED [TARGET_ERROR]]]
// prints a line a design and, at the end, how `auto` compares with the faster of the exact engine and Monte Carlo.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "benchmarks/processor_time.h"
#include "core/error.h"
#include "studies/design/io/design_reader.h"
#include "studies/rre/rre.h"

namespace retrace::benchmarks {
namespace {

/// Draws designs of every kind, arrangement, extent, carrier, error, edge, index, roughness and spectrum.
class RandomDesigns {
 public:
  explicit RandomDesigns(unsigned seed) : random_(seed) {}

  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  std::string next() {
    const int kind = pick(3);
    const bool is_infinite = one_in(2);
    const double size_mm = between(0.2, 3.0);
    std::string text = "[element]\n" + element(kind, size_mm) + "[array]\n" + array(kind, is_infinite, size_mm);
    const bool has_substrate = !is_infinite && one_in(6);
    if (has_substrate)
      text += fmt::format("[base]\nkind = \"cylinder\"\nradius_mm = {}\n", between(60.0, 400.0) * size_mm);
    text += fmt::format("[body]\nthickness_mm = {}\nrefractive_index = {}\n", between(0.5, 3.0), between(1.3, 1.8));
    if (one_in(4)) text += fmt::format("back_index = {}\n", between(1.0, 1.4));
    if (one_in(4)) text += "facet_coating = \"aluminium\"\n";
    if (one_in(4)) text += "absorption_per_mm = 0.01\n";
    if (one_in(6)) text += "[light]\nspectrum = \"A\"\n";
    text += "[surface]\n";
    if (one_in(3)) text += fmt::format("dihedral_error_arcmin = {}\n", between(-20.0, 20.0));
    if (!has_substrate && one_in(3)) text += fmt::format("root_radius_um = {}\n", between(1.0, 30.0));
    if (!has_substrate && one_in(4)) text += fmt::format("rim_radius_um = {}\n", between(1.0, 30.0));
    if (one_in(8)) text += fmt::format("roughness_sq_nm = {}\ncorrelation_length_um = 5\n", between(1.0, 20.0));
    return text;
  }

 private:
  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  bool one_in(int count) { return pick(count) == 0; }

  std::string element(int kind, double size_mm) {
    constexpr std::array<const char*, 3> kKinds = {"rtp", "hexagonal_icc", "triangular_icc"};
    const std::string text = fmt::format("kind = \"{}\"\n", kKinds[static_cast<std::size_t>(kind)]);
    if (kind == 0) return text + fmt::format("base_mm = {0}\nwidth_mm = {0}\n", size_mm);
    const std::string cant = one_in(3) ? fmt::format("cant_deg = {}\n", between(-10.0, 10.0)) : "";
    return text + fmt::format("aperture_mm = {}\n", size_mm) + cant;
  }

  std::string array(int kind, bool is_infinite, double size_mm) {
    constexpr std::array<const char*, 4> kOfPrisms = {"single", "aligned", "offset", "checker"};
    std::string text;
    bool is_single = false;
    if (kind == 0) {
      const int arrangement = pick(4);
      is_single = arrangement == 0;
      text = fmt::format("arrangement = \"{}\"\n", kOfPrisms[static_cast<std::size_t>(arrangement)]);
    }
    if (is_single) return text;
    if (is_infinite) return text + "extent = \"infinite\"\n";
    return text + fmt::format("x_length_mm = {}\ny_length_mm = {}\n", size_mm * std::exp(between(0.7, 4.0)),
                              size_mm * std::exp(between(0.7, 4.0)));
  }

  std::mt19937 random_;
};

Timed timed_by(const studies::Design& design, studies::RreRequest request, studies::Engine engine, double most_s) {
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
  studies::RreRequest request;
  request.incidence_deg = {random.between(0.0, 10.0), random.between(10.0, 30.0), random.between(30.0, 60.0)};
  request.azimuth_deg = {random.between(0.0, 90.0)};
  request.target_error = target_error;
  try {
    const studies::Design design = studies::parse_design(text, fmt::format("design {}", seed));
    constexpr double kPatience_s = 60.0;
    const Timed rays = timed_by(design, request, studies::Engine::montecarlo, kPatience_s);
    const Timed automatic = timed_by(design, request, studies::Engine::automatic, 2.0 * kPatience_s);
    Timed exact{kPatience_s, false, ""};
    if (text.find("roughness") == std::string::npos)
      exact = timed_by(design, request, studies::Engine::exact, 1.2 * rays.s + 0.1);
    const double faster_s = exact.is_complete ? std::min(exact.s, rays.s) : rays.s;
    const Comparison comparison{automatic.s, faster_s};
    if (std::getenv("RETRACE_SHOW_DESIGNS") != nullptr) fmt::print("{}\n", text);
    fmt::print("{:4}  auto {:8.3f} s ({:>6})  {:>6} {:8.3f} s  exact {:>10}  ratio {:5.2f}\n", seed, automatic.s,
               automatic.engine, rays.engine, rays.s, exact.is_complete ? fmt::format("{:.3f} s", exact.s) : "-",
               comparison.ratio());
    return comparison;
  } catch (const InputError&) {
    return std::nullopt;  // sizes that do not go together: the next one
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
