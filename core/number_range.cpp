#include "core/number_range.h"

#include <cmath>

#include "core/number_format.h"

namespace retrace {

bool NumberRange::contains(double value) const {
  return (low_included ? value >= low : value > low) && (high_included ? value <= high : value < high);
}

std::string NumberRange::text() const {
  std::string result;
  if (std::isfinite(low)) result += (low_included ? ">= " : "> ") + shortest(low);
  if (std::isfinite(low) && std::isfinite(high)) result += " and ";
  if (std::isfinite(high)) result += (high_included ? "<= " : "< ") + shortest(high);
  return result.empty() ? "any number" : result;
}

}  // namespace retrace
