#include "geometry/substrate/sag_formula.h"

#include <array>

#include "core/error.h"
#include "core/math/formula_evaluation.h"

namespace retrace::geometry {

Formula::Formula(std::string_view text) : formula_(parse_formula(std::string(text), {"x", "y"}, InputLocation{})) {}

Jet Formula::at(double x, double y) const {
  const std::array<Jet, 2> variables = {Jet{x, 1.0}, Jet{y, 0.0, 1.0}};
  return formula_.evaluate(variables.data());
}

}  // namespace retrace::geometry
