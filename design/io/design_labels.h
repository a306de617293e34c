#pragma once

// Labels that tell designs apart in legends and tables.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "design/design.h"

namespace retrace::design {

/// Labels of several designs, in their order.
struct DesignLabels {
  std::vector<std::string> names;  ///< different for different entries
  /// Key that is the only difference between the designs, if its values are numbers. Otherwise empty.
  std::string key;
  std::vector<double> values;  ///< value of `key` for each design; empty if there is no such key
};

/// Returns labels for designs. Designs that differ in at most three keys are named by the values of these keys, such as
/// "material = PC". Other designs are named by their files, or by `names` if they have no file. Designs that would have
/// the same label get a number: "(1)", "(2)". A single design has its name of `names`.
/// \param designs JSON of the designs, see to_json()
/// \param names short names of the designs
DesignLabels design_labels(const std::vector<nlohmann::ordered_json>& designs, const std::vector<std::string>& names);

DesignLabels design_labels(const std::vector<Design>& designs);

}  // namespace retrace::design
