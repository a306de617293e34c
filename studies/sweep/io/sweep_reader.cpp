#include "studies/sweep/io/sweep_reader.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "core/io/toml_node.h"
#include "core/number_format.h"
#include "studies/design/table_reader.h"

namespace retrace::studies {
namespace {

constexpr std::array kCombinations = {
    Choice<Combine>{"grid", Combine::grid}, Choice<Combine>{"zipped", Combine::zipped},
    Choice<Combine>{"sobol", Combine::sobol}, Choice<Combine>{"latin_hypercube", Combine::latin_hypercube},
    Choice<Combine>{"monte_carlo", Combine::monte_carlo}};
constexpr Range kSamples{.low = 1.0, .high = 1'000'000.0};

}  // namespace

Sweep read_sweep(Study study) {
  const DesignDocument document(study.text, study.source, {});
  if (const toml::node* const node = document.root().get("sweep"); node != nullptr && !node->is_table())
    throw InputError(document.location(*node, "sweep"), "must be a table, got " + shown(*node));
  TableReader table(document, "sweep");
  const Combine combine =
      table.choice("combine", std::span<const Choice<Combine>>(kCombinations)).value_or(Combine::grid);
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
