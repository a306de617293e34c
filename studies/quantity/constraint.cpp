#include "studies/quantity/constraint.h"

#include <algorithm>
#include <limits>

#include "core/number_format.h"

namespace retrace::studies {

double Constraint::violation(const std::optional<double>& value) const {
  if (!value) return std::numeric_limits<double>::infinity();
  double violation = 0.0;
  if (min) violation = std::max(violation, *min - *value);
  if (max) violation = std::max(violation, *value - *max);
  return violation;
}

std::string Constraint::text() const {
  std::string text = quantity;
  if (min) text = shortest(*min) + " <= " + text;
  if (max) text += " <= " + shortest(*max);
  return text;
}

}  // namespace retrace::studies
