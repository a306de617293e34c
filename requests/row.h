#pragma once

// Describes requests as constant data: their fields, the allowed values, and how a field is spelled on the command line
// and in Python. The command line, Python, documentation and checks of ranges are made from these data.

#include <span>
#include <string_view>

#include "core/field.h"
#include "core/schema/conditions.h"
#include "core/schema/schema.h"

namespace retrace::requests {

/// Condition under which a field has an effect: a list of conditions on other fields, of which at least one must hold.
using Need = std::span<const schema::Condition>;

/// Notation of a value on the command line.
enum class Notation {
  plain,
  commas,       ///< one number, or numbers separated by commas, such as X,Y,Z
  by_x,         ///< numbers separated by x, such as 400x300
  number_list,  ///< numbers and ranges, such as 0,10:40:5
  /// "--no-NAME" sets a flag, which is set by default, to false. The description of the field begins with a verb,
  /// because help of the option shows it after "do not".
  absent
};

/// Spelling of a field.
struct Spelling {
  std::string_view value = {};  ///< placeholder for the value on the command line, such as "DIR"; empty for flags
  Notation notation = Notation::plain;
  std::string_view option = {};     ///< name of the option, such as "--incidence"; empty: the name of the field
  std::string_view keyword = {};    ///< keyword in Python; empty: the name of the field
  std::string_view otherwise = {};  ///< description of the default if no value is given, such as "as in the file"
  /// Value that is used if no value is given, written as on the command line. Giving it is not the same, because it is
  /// refused where the field has no effect.
  std::string_view usual = {};
  /// Name of the field in messages if it differs from that of a field of another request with another option:
  /// "road.distance_m". The part up to the dot is not shown in C++.
  std::string_view qualified = {};
  bool is_no_option = false;   ///< true if the command line has another way to set the field
  bool is_no_keyword = false;  ///< true if Python has another way to set the field
};

/// Field of a request. Its default is the initialiser of the member.
struct Row {
  std::string_view name;     ///< name of the field; the suffix is the unit
  schema::Kind kind;         ///< kind and range of the value
  std::string_view meaning;  ///< description, without a full stop at the end
  schema::Access access;
  Spelling spelling = {};
  std::span<const Need> needs = {};  ///< conditions, all of which must hold if the field is not at its default
  bool is_required = false;

  Field field() const { return {spelling.qualified.empty() ? name : spelling.qualified}; }
};

/// Description of a request.
struct Request {
  std::string_view name;     ///< name of the type without "Request", such as "camera" for CameraRequest
  std::string_view command;  ///< command of the program; empty if only the library has the function
  std::span<const Row> rows;
  const void* (*initial)();  ///< returns an object with the defaults of all fields
  /// Function that checks combinations of values, each of which is allowed by itself; may be null.
  /// \throw InputError at a field
  void (*check)(const void* request) = nullptr;
};

/// Returns an object with the defaults of all fields, for Request::initial.
template <class Type>
const void* initial_object() {
  static const Type initial;
  return &initial;
}

/// Returns the description of a request. Each type of request has a specialisation in requests/rows/.
template <class Type>
const Request& description();

/// Returns the descriptions of all requests.
std::span<const Request* const> all_requests();

/// Returns the row of a field, or null if the request has no such field.
const Row* row_of(const Request& request, std::string_view name);

/// Returns the option of a field, such as "--target-error".
std::string option_of(const Row& row);
/// Returns the option of a field that is named as in messages, see Row::field(). It is a FieldSpelling.
std::string option_of_field(std::string_view field);

/// Sets a field.
/// \param object object of the type of the request
/// \throw InputError at the field if the value is not allowed
void set(const Row& row, void* object, const schema::Value& value);
/// Sets a field to a value that is written as on the command line.
/// \throw InputError at the field if the text or the value is not allowed
void set_text(const Row& row, void* object, std::string_view text);
/// Returns the value of a field as it is written on the command line. Returns an empty text if there is no value.
std::string text_of(const Row& row, const void* object);

/// Checks all fields of a request and its rules.
/// \param object object of the type of the request
/// \throw InputError at the first field that is not allowed
void check(const Request& request, const void* object);
/// Checks all fields of a request and its rules.
/// \throw InputError at the first field that is not allowed
template <class Type>
void check(const Type& request) {
  check(description<Type>(), static_cast<const void*>(&request));
}

}  // namespace retrace::requests
