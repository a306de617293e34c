// Functions on formulas that are independent of the parser (muParser).
#include "core/math/formula.h"

namespace retrace {

using Step = Formula::Step;

bool is_binary(Formula::Step step) {
  switch (step) {
    case Step::add:
    case Step::subtract:
    case Step::multiply:
    case Step::divide:
    case Step::power:
    case Step::atan2: return true;
    default: return false;
  }
}

bool Formula::uses(int variable) const {
  for (const Node& node : nodes)
    if (node.step == Step::variable && node.a == variable) return true;
  return false;
}

}  // namespace retrace
