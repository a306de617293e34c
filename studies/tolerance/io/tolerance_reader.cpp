#include "studies/tolerance/io/tolerance_reader.h"

#include <fmt/format.h>

#include "studies/quantity/io/constraint_reader.h"

namespace retrace::studies {
namespace {

constexpr double kOfPercent = 0.01;

void check_parameters(const Study& study) {
  for (const Parameter& parameter : study.parameters)
    if (!parameter.distribution)
      throw InputError(
          parameter.location,
          "every parameter of a tolerance study requires a distribution: \"normal\", \"uniform\" or \"triangular\"");
}

/// Checks that the numbers of samples and points are allowed. Numbers of samples have 32 bits, and numbers of points
/// must be valid in SQLite.
void check_size(const Study& study, const ToleranceRequest& request) {
  const std::size_t parameters = study.parameters.size();
  const std::size_t dimensions = (request.indices ? 2 : 1) * parameters;
  if (dimensions > compute::UnitSamples::max_dimensions)
    study.document->fail("tolerance.indices", fmt::format("are available for at most {} parameters, got {}",
                                                          compute::UnitSamples::max_dimensions / 2, parameters));
  const std::uint64_t points = 1 + request.samples * (request.indices ? parameters + 2 : 1);
  if (points > Sweep::max_points)
    study.document->fail("tolerance.samples",
                         fmt::format("gives {} points with {} parameters, but at most {} are allowed", points,
                                     parameters, Sweep::max_points));
}

}  // namespace

ToleranceRequest read_tolerance(const Study& study) {
  const schema::Document& document = *study.document;
  check_parameters(study);
  ToleranceRequest request;
  request.samples = static_cast<std::uint64_t>(document.number("tolerance.samples"));
  request.sampling = document.choice<compute::UnitSamples::Kind>("tolerance.sampling");
  request.indices = document.text("tolerance.indices") == "sobol";
  request.confidence = kOfPercent * document.number("tolerance.confidence_percent");
  request.constraints = read_constraints(study);
  if (const auto least = document.number_if("tolerance.min_yield_percent")) {
    if (request.constraints.empty())
      document.fail("tolerance.min_yield_percent", "requires one or more tables [[constraint]]");
    request.min_yield = kOfPercent * *least;
  }
  check_size(study, request);
  return request;
}

}  // namespace retrace::studies
