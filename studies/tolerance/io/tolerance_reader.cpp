#include "studies/tolerance/io/tolerance_reader.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>

#include "core/number_format.h"
#include "core/toml_file.h"
#include "studies/quantity/io/constraint_reader.h"

namespace retrace::studies {
namespace {

using Kind = UnitSamples::Kind;

constexpr std::array kSampling = {TomlChoice<Kind>{"sobol", Kind::sobol},
                                  TomlChoice<Kind>{"latin_hypercube", Kind::latin_hypercube},
                                  TomlChoice<Kind>{"monte_carlo", Kind::monte_carlo}};
constexpr std::array kYesNo = {TomlChoice<bool>{"none", false}, TomlChoice<bool>{"sobol", true}};
constexpr NumberRange kSamples{.low = 2.0, .high = 1'000'000.0};
constexpr NumberRange kConfidence{.low = 50.0, .high = 99.99};
constexpr NumberRange kPercent{.low = 0.0, .high = 100.0};
constexpr double kOfPercent = 0.01;

void check_parameters(const Study& study) {
  for (const Parameter& parameter : study.parameters)
    if (!parameter.distribution)
      throw InputError(parameter.location,
                       "a tolerance study needs a distribution: \"normal\", \"uniform\" or \"triangular\"");
}

/// Samples are told by numbers of 32 bits, points by numbers that SQLite can count.
void check_size(const Study& study, const ToleranceRequest& request, TomlTable& table) {
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
  TomlTable table = parse_toml(study.text, study.source, kShortTomlBytes).table("tolerance");
  check_parameters(study);
  ToleranceRequest request;
  const double samples = table.number("samples", kSamples).value_or(static_cast<double>(request.samples));
  if (samples != std::floor(samples))
    table.fail("samples", fmt::format("must be a whole number, got {}", shortest(samples)));
  request.samples = static_cast<std::uint64_t>(samples);
  request.sampling = table.choice("sampling", all(kSampling)).value_or(request.sampling);
  request.indices = table.choice("indices", all(kYesNo)).value_or(true);
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
