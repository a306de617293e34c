#include "studies/sweep/io/sweep_reader.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "core/number_format.h"
#include "core/toml_file.h"

namespace retrace::studies {
namespace {

constexpr std::array kCombinations = {
    TomlChoice<Combine>{"grid", Combine::grid}, TomlChoice<Combine>{"zipped", Combine::zipped},
    TomlChoice<Combine>{"sobol", Combine::sobol}, TomlChoice<Combine>{"latin_hypercube", Combine::latin_hypercube},
    TomlChoice<Combine>{"monte_carlo", Combine::monte_carlo}};
constexpr NumberRange kSamples{.low = 1.0, .high = 1'000'000.0};

}  // namespace

Sweep read_sweep(Study study) {
  TomlTable table = parse_toml(study.text, study.source, kShortTomlBytes).table("sweep");
  const Combine combine = table.choice("combine", all(kCombinations)).value_or(Combine::grid);
  double samples = 0.0;
  if (combine != Combine::grid && combine != Combine::zipped) {
    samples = table.required_number("samples", kSamples);
    if (samples != std::floor(samples))
      table.fail("samples", fmt::format("must be a whole number, got {}", shortest(samples)));
    if (study.parameters.size() > UnitSamples::most_dimensions)
      table.fail("combine", fmt::format("takes at most {} parameters", UnitSamples::most_dimensions));
  } else {
    table.refuse({"samples"}, "only allowed for combine = \"sobol\", \"latin_hypercube\" and \"monte_carlo\"");
  }
  table.finish();
  return {std::move(study), combine, static_cast<std::uint64_t>(samples)};
}

}  // namespace retrace::studies
