#pragma once

// Reads and checks the values of a request.

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "core/error.h"
#include "requests/descriptions.h"
#include "studies/scene/design_excerpt.h"

namespace retrace::live {

using Json = nlohmann::ordered_json;

/// Returns the value of a key.
/// \throw InputError that names the key, if the key is missing or its value has another type
template <class Type>
Type get(const Json& request, const char* key) {
  const auto found = request.find(key);
  if (found == request.end()) throw InputError({"", 0, key}, "is missing in the request");
  try {
    return found->template get<Type>();
  } catch (const Json::exception&) {
    throw InputError({"", 0, key}, "has the wrong type for the request");
  }
}
template <class Type>
Type get(const Json& request, const char* key, const Type& otherwise) {
  return request.contains(key) ? get<Type>(request, key) : otherwise;
}

/// Creates a request of the library from the JSON object `request`. The key of a field is the name of its option
/// without the leading dashes, with underscores instead of hyphens, such as "area_cm2". Fields without a key or with an
/// empty text keep their defaults.
/// \throw InputError that names the field, if its value is not allowed
template <class Type>
Type fields_of(const Json& request) {
  Type fields;
  for (const requests::Row& row : requests::description<Type>().rows) {
    std::string key = requests::option_of(row).substr(2);
    std::replace(key.begin(), key.end(), '-', '_');
    const auto found = request.find(key);
    if (found == request.end()) continue;
    if (found->is_number()) requests::set(row, &fields, found->template get<double>());
    if (found->is_boolean()) requests::set(row, &fields, found->template get<bool>());
    if (found->is_string() && *found != "") requests::set(row, &fields, found->template get<std::string>());
  }
  return fields;
}

/// Returns the value of a key, which is a fraction, or `otherwise` if the key is missing.
/// \throw InputError unless the value is between 0 and 1
inline double fraction_of(const Json& request, const char* key, double otherwise) {
  const double value = get<double>(request, key, otherwise);
  if (!(value > 0.0 && value < 1.0)) throw InputError({"", 0, key}, "must be between 0 and 1");
  return value;
}

inline studies::SceneLight checked(double incidence_deg, double azimuth_deg) {
  if (!(std::abs(incidence_deg) < 90.0)) throw InputError({"", 0, "incidence_deg"}, "must be between -90 and 90");
  if (!std::isfinite(azimuth_deg)) throw InputError({"", 0, "azimuth_deg"}, "must be finite");
  return {incidence_deg, azimuth_deg};
}

inline studies::SceneLight light_of(const Json& request) {
  return checked(get<double>(request, "incidence_deg"), get<double>(request, "azimuth_deg", 0.0));
}

}  // namespace retrace::live
