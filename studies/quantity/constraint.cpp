#include "studies/quantity/constraint.h"

#include <algorithm>
#include <limits>

#include "core/number_format.h"

namespace retrace::studies {

double Constraint::violation(const std::optional<double>& value) const {
  if (!value) return std::numeric_limits<double>::infinity();
  double violation = 0.0;
  if (least) violation = std::max(violation, *least - *value);
  if (most) violation = std::max(violation, *value - *most);
  return violation;
}

std::string Constraint::text() const {
  std::string text = quantity;
  if (least) text = shortest(*least) + " <= " + text;
  if (most) text += " <= " + shortest(*most);
  return text;
}

}  // namespace retrace::studies
