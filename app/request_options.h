#pragma once

// Makes the options of a command from the rows of requests, and requests from the given options.

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/command.h"
#include "requests/row.h"

namespace retrace::app {

/// Values of the options that set fields of requests, as given on the command line.
struct FieldTexts {
  std::map<std::string, std::optional<std::string>> values;  ///< by option
  std::map<std::string, bool> flags;                         ///< by option; true if the option is given
};

/// A request of a command.
struct CommandRequest {
  const requests::Request& request;
  /// Option that selects the request if the command has several requests, such as "--camera".
  std::string mode = {};
  /// Text before the help of its options if the command has several requests but no option selects this one, such as
  /// "material".
  std::string label = {};
};

/// Returns the options for the fields of the requests of a command. If fields of several requests have the same option,
/// they share it.
/// \param texts receives the given values; it must outlive the arguments
std::vector<Argument> field_arguments(std::span<const CommandRequest> of_command, FieldTexts& texts);

/// Sets the fields of a request whose options are given, and its seed.
/// \param object object of the type of the request
/// \throw InputError at a field whose value is not allowed
void set_fields(const requests::Request& request, void* object, const FieldTexts& texts, const CommonOptions& common);

/// Returns the request that the options describe. Fields without an option keep their defaults.
/// \throw InputError at a field whose value is not allowed
template <class Type>
Type request_of(const FieldTexts& texts, const CommonOptions& common) {
  Type request;
  set_fields(requests::description<Type>(), &request, texts, common);
  return request;
}

}  // namespace retrace::app
