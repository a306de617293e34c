#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "report/results/result_plots.h"
#include "studies/optimise/important_parameters.h"
#include "studies/optimise/optimise.h"
#include "studies/quantity/study_names.h"

namespace retrace::report {
namespace {

using studies::Variant;

// Values of Series::look for designs that satisfy all constraints, for designs that violate a constraint, and for the
// best design.
constexpr std::size_t kFeasibleLook = 0, kExcludedLook = 6, kChosenLook = 1;

double number_of(const Variant& variant, std::size_t parameter) {
  return std::get<double>(variant.values[parameter].shown);
}

/// Returns the name of the plotted objective, and the factor by which the objective is multiplied. If the objective
/// consists of one quantity, the factor converts it to this quantity.
std::pair<std::string, double> shown_objective(const studies::OptimiseRequest& request) {
  const auto& weights = request.objective.weights;
  if (weights.size() != 1) return {"objective", 1.0};
  return {weights.front().first, 1.0 / weights.front().second};
}

/// Returns all designs with an objective, ordered by the value of a parameter.
std::vector<const Variant*> sorted_designs(const studies::Optimum& optimum, std::size_t parameter) {
  std::vector<const Variant*> designs;
  for (const Variant& variant : optimum.designs)
    if (variant.objective) designs.push_back(&variant);
  std::ranges::stable_sort(
      designs, [&](const Variant* a, const Variant* b) { return number_of(*a, parameter) < number_of(*b, parameter); });
  return designs;
}

/// Returns the ranges of a parameter in which all evaluated designs are feasible. Each range ends halfway between a
/// feasible and an infeasible design.
std::vector<Range> feasible_ranges(const std::vector<const Variant*>& designs, std::size_t parameter) {
  std::vector<Range> ranges;
  bool is_inside = false;
  std::optional<double> last;
  for (const Variant* const design : designs) {
    const double here = number_of(*design, parameter);
    const double border = last ? 0.5 * (*last + here) : here;
    if (design->feasible() && !is_inside) ranges.push_back({border, here});
    if (design->feasible()) ranges.back().high = here;
    if (!design->feasible() && is_inside) ranges.back().high = border;
    is_inside = design->feasible();
    last = here;
  }
  return ranges;
}

/// Returns a plot with the two most important parameters as axes. The colours of the points show the objective.
LinePlot plane_plot(const studies::Study& study, const studies::OptimiseRequest& request,
                    const studies::Optimum& optimum, std::size_t x, std::size_t y) {
  const auto [name, factor] = shown_objective(request);
  LinePlot plot;
  plot.title = studies::shown_title(study) + ": evaluated designs";
  plot.x_label = study.parameters[x].name;
  plot.y_label = study.parameters[y].name;
  plot.scale_label = name;
  plot.legend = {{"feasible", kFeasibleLook}, {"violates a constraint", kExcludedLook}, {"chosen", kChosenLook}};
  const auto add = [&](const Variant& variant, std::size_t look) {
    Series point{"", {}, {}, {}};
    point.has_line = false;
    point.look = look;
    point.scale_value = factor * *variant.objective;
    point.add(number_of(variant, x), number_of(variant, y));
    plot.series.push_back(std::move(point));
  };
  for (const Variant& variant : optimum.designs)
    if (variant.objective) add(variant, variant.feasible() ? kFeasibleLook : kExcludedLook);
  if (optimum.best) add(*optimum.best, kChosenLook);
  return plot;
}

}  // namespace

LinePlot optimum_plot(const studies::Study& study, const studies::OptimiseRequest& request,
                      const studies::Optimum& optimum) {
  const std::vector<std::size_t> axes = studies::important_parameters(study, optimum);
  if (axes.size() > 1) return plane_plot(study, request, optimum, axes[0], axes[1]);
  const auto [name, factor] = shown_objective(request);
  LinePlot plot;
  plot.title = studies::shown_title(study) + ": objective";
  plot.y_label = name;
  if (axes.empty()) return plot;
  const std::size_t x = axes.front();
  plot.x_label = study.parameters[x].name + " (shaded: all constraints hold)";
  const std::vector<const Variant*> designs = sorted_designs(optimum, x);
  plot.shaded_x = feasible_ranges(designs, x);
  Series feasible{"feasible", {}, {}, {}};
  Series excluded{"violates a constraint", {}, {}, {}};
  feasible.has_line = excluded.has_line = false;
  feasible.look = kFeasibleLook;
  excluded.look = kExcludedLook;
  for (const Variant* const design : designs)
    (design->feasible() ? feasible : excluded)
        .add(number_of(*design, x), factor * *design->objective, std::abs(factor) * design->objective_error);
  plot.series.push_back(std::move(feasible));
  if (!excluded.x.empty()) plot.series.push_back(std::move(excluded));
  if (optimum.best) {
    Series chosen{"chosen", {}, {}, {}};
    chosen.has_line = false;
    chosen.look = kChosenLook;
    chosen.add(number_of(*optimum.best, x), factor * *optimum.best->objective,
               std::abs(factor) * optimum.best->objective_error);
    plot.series.push_back(std::move(chosen));
  }
  return plot;
}

LinePlot constraints_plot(const studies::Study& study, const studies::OptimiseRequest& request,
                          const studies::Optimum& optimum) {
  LinePlot plot;
  plot.title = studies::shown_title(study) + ": constrained quantities";
  plot.y_label = "quantity / limit";
  const std::vector<std::size_t> axes = studies::important_parameters(study, optimum);
  if (axes.empty()) return plot;
  const std::size_t x = axes.front();
  plot.x_label = study.parameters[x].name + " (shaded: all constraints hold)";
  const std::vector<const Variant*> designs = sorted_designs(optimum, x);
  plot.shaded_x = feasible_ranges(designs, x);
  for (const studies::Constraint& constraint : request.constraints) {
    const std::size_t k = studies::quantity_index(study, constraint.quantity).value();
    const double limit = constraint.max ? *constraint.max : *constraint.min;
    Series series{constraint.text(), {}, {}, {}};
    // A quantity cannot be divided by the limit 0. In this case, 1 + quantity is drawn, so that the limit is also at 1.
    const double scale = limit != 0.0 ? 1.0 / limit : 1.0;
    const double shift = limit != 0.0 ? 0.0 : 1.0;
    for (const Variant* const design : designs) {
      const compute::StoredOutput& output = design->outputs[k];
      series.add(number_of(*design, x),
                 output.value ? shift + scale * *output.value : std::numeric_limits<double>::quiet_NaN(),
                 std::abs(scale) * output.std_error);
    }
    plot.series.push_back(std::move(series));
  }
  if (!designs.empty()) {
    Series limit{"limit", {}, {}, {}};
    limit.add(number_of(*designs.front(), x), 1.0);
    limit.add(number_of(*designs.back(), x), 1.0);
    plot.series.push_back(std::move(limit));
  }
  return plot;
}

}  // namespace retrace::report
