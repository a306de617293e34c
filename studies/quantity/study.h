#pragma once

// Contents of a study: base design, parameters with their values, intervals or distributions, and the quantities to
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
#include "studies/quantity/error_level.h"
#include "studies/quantity/quantity.h"

namespace retrace::studies {

/// Value of a parameter, as TOML for overrides and in the form that tables show.
struct ParameterValue {
  std::string toml;
  std::variant<double, std::string> shown;
};

/// Interval; both ends belong to it.
struct Interval {
  double from = 0.0;
  double to = 0.0;
  bool logarithmic = false;  ///< true: equal steps are equal ratios, and both ends are > 0

  /// Returns the value at a fraction (0..1) of the interval.
  double at(double fraction) const;
};

/// Distribution of a parameter in manufacture.
struct Distribution {
  enum class Kind { normal, uniform, triangular };
  Kind kind = Kind::normal;
  double mean = 0.0;              ///< normal: mean; triangular: mode
  double sigma = 0.0;             ///< normal: standard deviation, > 0
  std::optional<Interval> range;  ///< uniform and triangular: required; normal: limits of the distribution

  /// Returns the quantile: the value below which the fraction u (0 to 1) of the values lies.
  double quantile(double u) const;
};

/// Parameter that a study varies: one or more keys that have one common value.
struct Parameter {
  std::string name;  ///< name of its column: the given name, or the first key
  std::vector<std::string> keys;
  std::vector<ParameterValue> values;  ///< values of a list or a range; empty for an interval or a distribution
  std::optional<Interval> interval;
  std::optional<Distribution> distribution;
  InputLocation location;

  /// Converts a number to the value of a parameter.
  static ParameterValue value_of(double number);
};

/// Contents of a study file that sweeps, optimizations and tolerance studies have in common.
struct Study {
  std::string source;  ///< name of the file as given
  std::string title;
  std::shared_ptr<const schema::Document> document;  ///< document of the study file
  /// Path of the base design's file, relative to the working directory.
  std::string design_file;
  std::map<std::string, std::string> design_texts;  ///< texts of the design files, by name of the file
  /// All files that are read: the study, its designs, and the files that the designs and quantities name.
  std::vector<std::string> files;
  std::vector<std::string> overrides;  ///< values of the option --set
  std::uint32_t seed = 1;
  /// Accuracy of all quantities relative to the settings of [analysis]. If it is set, stored points contain the scale
  /// and the replicate of this level as additional inputs. Empty: the settings of [analysis] apply.
  std::optional<ErrorLevel> level;
  std::vector<Parameter> parameters;
  Quantities quantities;
  /// Parts that define the study, each as a name and a canonical text. Two studies with equal parts have equal points.
  std::vector<std::pair<std::string, std::string>> parts;
};

/// Values of the parameters at one point of a study, in the order of the parameters.
using PointValues = std::vector<ParameterValue>;

/// Returns one allowed value of each parameter, as an example.
PointValues example_values(const Study& study);

/// Returns the values of all parameters from the form in which tables show them. Returns nothing if a parameter does
/// not have such a value.
std::optional<PointValues> values_of(const Study& study, const std::vector<std::variant<double, std::string>>& shown);

}  // namespace retrace::studies
