#include "studies/tolerance/io/tolerance_reader.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>

#include "core/io/toml_node.h"
#include "core/number_format.h"
#include "studies/design/table_reader.h"
#include "studies/quantity/io/constraint_reader.h"

namespace retrace::studies {
namespace {

using Kind = UnitSamples::Kind;

constexpr std::array kSampling = {Choice<Kind>{"sobol", Kind::sobol},
                                  Choice<Kind>{"latin_hypercube", Kind::latin_hypercube},
                                  Choice<Kind>{"monte_carlo", Kind::monte_carlo}};
constexpr std::array kYesNo = {Choice<bool>{"none", false}, Choice<bool>{"sobol", true}};
constexpr Range kSamples{.low = 2.0, .high = 1'000'000.0};
constexpr Range kConfidence{.low = 50.0, .high = 99.99};
constexpr Range kPercent{.low = 0.0, .high = 100.0};
constexpr double kOfPercent = 0.01;

void check_parameters(const Study& study) {
  for (const Parameter& parameter : study.parameters)
    if (!parameter.distribution)
      throw InputError(parameter.location,
                       "a tolerance study needs a distribution: \"normal\", \"uniform\" or \"triangular\"");
}

/// Samples are told by numbers of 32 bits, points by numbers that SQLite can count.
void check_size(const Study& study, const ToleranceRequest& request, TableReader& table) {
  const std::size_t parameters = study.parameters.size();
  const std::size_t dimensions = (request.indices ? 2 : 1) * parameters;
  if (dimensions > UnitSamples::most_dimensions)
    table.fail("indices", fmt::format("are known for at most {} parameters, got {}", UnitSamples::most_dimensions / 2,
                                      parameters));
  const std::uint64_t points = 1 + request.samples * (request.indices ? parameters + 2 : 1);
  if (points > Sweep::most_points)
    table.fail("samples", fmt::format("makes {} points with {} parameters, and at most {} are allowed", points,
                                      parameters, Sweep::most_points));
}

}  // namespace

ToleranceRequest read_tolerance(const Study& study) {
  const DesignDocument document(study.text, study.source, {});
  if (const toml::node* const node = document.root().get("tolerance"); node != nullptr && !node->is_table())
    throw InputError(document.location(*node, "tolerance"), "must be a table, got " + shown(*node));
  check_parameters(study);
  TableReader table(document, "tolerance");
  ToleranceRequest request;
  const double samples = table.number("samples", kSamples).value_or(static_cast<double>(request.samples));
  if (samples != std::floor(samples))
    table.fail("samples", fmt::format("must be a whole number, got {}", shortest(samples)));
  request.samples = static_cast<std::uint64_t>(samples);
  request.sampling = table.choice("sampling", std::span<const Choice<Kind>>(kSampling)).value_or(request.sampling);
  request.indices = table.choice("indices", std::span<const Choice<bool>>(kYesNo)).value_or(true);
  request.confidence =
      kOfPercent * table.number("confidence_percent", kConfidence).value_or(request.confidence / kOfPercent);
  request.constraints = read_constraints(study);
  if (const auto least = table.number("least_yield_percent", kPercent)) {
    if (request.constraints.empty()) table.fail("least_yield_percent", "needs one or more tables [[constraint]]");
    request.least_yield = kOfPercent * *least;
  }
  check_size(study, request, table);
  table.finish();
  return request;
}

}  // namespace retrace::studies
