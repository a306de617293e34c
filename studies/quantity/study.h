#pragma once

// Studies as data: base design, parameters with their values, intervals or distributions, and the quantities to
// compute.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/schema/document.h"
#include "studies/quantity/quantity.h"

namespace retrace::studies {

/// A value of a parameter: as TOML, to be set, and as tables show it.
struct ParameterValue {
  std::string toml;
  std::variant<double, std::string> shown;
};

/// Values between two ends, both included.
struct Interval {
  double from = 0.0;
  double to = 0.0;
  bool logarithmic = false;  ///< equal steps are equal ratios; both ends are > 0

  /// The value at a share 0..1 of the way.
  double at(double share) const;
};

/// How a parameter is spread by manufacture.
struct Distribution {
  enum class Kind { normal, uniform, triangular };
  Kind kind = Kind::normal;
  double mean = 0.0;              ///< normal; triangular: its most frequent value
  double sigma = 0.0;             ///< normal; > 0
  std::optional<Interval> range;  ///< uniform and triangular: required; normal: cut off there

  /// The value below which a share u of (0, 1) lies.
  double quantile(double u) const;
};

/// What a study varies: one or more keys that have the same value.
struct Parameter {
  std::string name;  ///< its column: the first key, or the name it was given
  std::vector<std::string> keys;
  std::vector<ParameterValue> values;  ///< of a list or a range; empty if it is an interval or a distribution
  std::optional<Interval> interval;
  std::optional<Distribution> distribution;
  InputLocation location;

  /// A value within the interval, as it is set.
  static ParameterValue value_of(double number);
};

/// What every study file says, whatever is then done with it.
struct Study {
  std::string source;  ///< file name as given
  std::string title;
  std::shared_ptr<const schema::Document> document;  ///< of the study file
  std::string design_file;                           ///< of the base design; from the working directory
  std::map<std::string, std::string> design_texts;   ///< by file name, as read once
  std::vector<std::string> files;                    ///< all that are read: its own, designs, what these name
  std::vector<std::string> overrides;                ///< --set
  std::uint32_t seed = 1;
  std::vector<Parameter> parameters;
  Quantities quantities;
  /// What the study is, in parts with canonical texts: two studies with equal parts have equal points.
  std::vector<std::pair<std::string, std::string>> parts;
};

/// Values of the parameters of a study at one point, in their order.
using PointValues = std::vector<ParameterValue>;

/// Values that every parameter of a study may have.
PointValues some_values(const Study& study);

/// The values that tables show as these; nothing if a parameter of the study does not have such a one.
std::optional<PointValues> values_of(const Study& study, const std::vector<std::variant<double, std::string>>& shown);

}  // namespace retrace::studies
