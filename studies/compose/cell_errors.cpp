#include "studies/compose/cell_errors.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <string>

#include "core/error.h"
#include "core/number_format.h"
#include "core/threads.h"
#include "studies/optimise/evaluator.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/quantity/study_names.h"
#include "studies/sweep/sweep.h"

namespace retrace::studies {
namespace {

constexpr const char* kErrorKey = "surface.dihedral_error_arcmin";

/// Returns the angle errors that the design of the cell itself specifies with the key `surface.dihedral_error_arcmin`.
std::vector<double> own_errors(const Study& study, const PointValues& values) {
  const Candidate candidate = make_candidate(study, values);
  if (!candidate.design().elements()) return {};
  const geometry::PartSpec& part = candidate.design().part();
  if (std::holds_alternative<geometry::RuledCells>(part.element)) return {};
  const auto& errors = part.angle_errors.dihedral_error_arcmin;
  const bool is_prism = std::holds_alternative<geometry::RtpElement>(part.element);
  return {errors.begin(), is_prism ? errors.begin() + 1 : errors.end()};
}

/// Returns the study with the given angle errors for its cells, instead of the angle errors that the cells specify.
Study with_errors(const Study& study, const std::vector<double>& errors_arcmin) {
  Study changed = study;
  for (Parameter& parameter : changed.parameters) std::erase(parameter.keys, kErrorKey);
  std::vector<std::string> texts;
  for (const double error : errors_arcmin) texts.push_back(shortest(error));
  changed.overrides.push_back(texts.size() == 1 ? fmt::format("{}={}", kErrorKey, texts.front())
                                                : fmt::format("{}=[{}]", kErrorKey, fmt::join(texts, ", ")));
  return changed;
}

/// Returns the goals of a computed design.
/// \throw InputError if a goal has no value
std::vector<double> goals_from(const Study& study, const ComposeRequest& request, const compute::StoredPoint& point) {
  std::vector<double> goals;
  for (const std::string& goal : request.goals) {
    const std::size_t k = quantity_index(study, goal).value();
    if (k < point.outputs.size() && point.outputs[k].value) goals.push_back(*point.outputs[k].value);
  }
  if (goals.size() != request.goals.size())
    throw InputError("a cell with angle errors cannot be computed: " +
                     (point.reason.empty() ? "the value of a goal cannot be computed" : point.reason));
  return goals;
}

}  // namespace

std::size_t angles_of(const Study& study, const PointValues& values) {
  return own_errors(study, values).size();
}

std::vector<std::vector<double>> goals_with_errors(const Study& study, const ComposeRequest& request,
                                                   const FamilyCell& cell,
                                                   const std::vector<std::vector<double>>& errors_arcmin,
                                                   const Cancellation* cancel) {
  const std::vector<double> own = own_errors(study, cell.values);
  std::vector<std::optional<compute::StoredPoint>> points(errors_arcmin.size());
  for_each_in_parallel(points.size(), [&](std::size_t k) {
    std::vector<double> errors = own;
    for (std::size_t angle = 0; angle < errors.size(); ++angle) errors[angle] += errors_arcmin[k][angle];
    points[k] = compute_point(with_errors(study, errors), 0, cell.values, cancel);
  });
  std::vector<std::vector<double>> goals;
  for (const std::optional<compute::StoredPoint>& point : points) {
    if (!point || is_cancelled(cancel)) throw Interrupted{};
    goals.push_back(goals_from(study, request, *point));
  }
  return goals;
}

}  // namespace retrace::studies
