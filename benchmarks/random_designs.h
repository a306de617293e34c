#pragma once

// Random design files, for benchmarks that compare engines over many designs.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <random>
#include <string>

namespace retrace::benchmarks {

/// Generates random design files as texts. The designs differ in element, arrangement, extent, base, errors of angle,
/// edge radii, indices, coating, absorption, roughness and spectrum.
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
      text += fmt::format("[substrate]\nkind = \"cylinder\"\nradius_mm = {}\n", between(60.0, 400.0) * size_mm);
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

}  // namespace retrace::benchmarks
