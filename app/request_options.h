#pragma once

// Creates the command-line options of a command from the descriptions of its requests (requests/row.h). Sets the fields
// of the requests from the options that the user gives.

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
  std::map<std::string, std::optional<std::string>> values;  ///< value of each option; empty if it is not given
  std::map<std::string, bool> flags;                         ///< for each flag: true if it is given
};

/// Request whose fields are options of a command. A command can have several requests.
struct CommandRequest {
  const requests::Request& request;
  /// Option that selects this request among several requests of the command, such as "--camera". It is empty if no
  /// option selects the request.
  std::string mode = {};
  /// Name of the request in the help of its options, such as "material". It is only used if `mode` is empty and the
  /// command has several requests.
  std::string label = {};
};

/// Returns the command-line options that set the fields of a command's requests. Fields of different requests that have
/// the same option name share one option.
/// \param of_command requests of the command
/// \param texts receives the values from the command line; it must outlive the returned arguments
std::vector<Argument> field_arguments(std::span<const CommandRequest> of_command, FieldTexts& texts);

/// Sets the fields of a request whose options are given. Sets the field `seed`, if the request has it, from `common`.
/// \param request description of the type of request
/// \param object request whose fields are set; it has the type that `request` describes
/// \throw InputError that names the field, if its value is not allowed
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
