#pragma once

// Types that describe requests as constant data: the fields, their allowed values, and their names on the command line
// and in Python. Options, Python keywords, documentation and range checks are generated from these data.

#include <span>
#include <string_view>

#include "core/field.h"
#include "core/schema/conditions.h"
#include "core/schema/schema.h"

namespace retrace::requests {

/// Alternative conditions on other fields of the request. The need is met if at least one of them holds.
using Need = std::span<const schema::Condition>;

/// Notation of a value on the command line.
enum class Notation {
  plain,
  commas,       ///< one number, or numbers separated by commas, such as 0,0,100
  by_x,         ///< numbers separated by the letter x, such as 400x300
  number_list,  ///< numbers and ranges start:stop:step, such as 0,10:40:5
  /// Option --no-NAME, which sets a flag to false that is true by default. The description of the field must begin with
  /// a verb, because the help text of the option is "do not" followed by the description.
  absent
};

/// Spelling of a field on the command line, in Python and in messages.
struct Spelling {
  std::string_view value = {};  ///< placeholder for the value on the command line, such as "DIR"; empty for flags
  Notation notation = Notation::plain;
  std::string_view option = {};     ///< option, such as "--incidence"; if empty, it is made from the name of the field
  std::string_view keyword = {};    ///< keyword in Python; if empty, the name of the field is used
  std::string_view otherwise = {};  ///< describes the behaviour if no value is given, such as "as in the file"
  /// Default of an optional field, written as on the command line. It is used if the field has no value. If a user
  /// gives this value explicitly, Row::needs is checked as for any other value.
  std::string_view usual = {};
  /// Name of the field in messages, such as "road.distance_m". It is needed if another request has a field with the
  /// same name but a different option. If empty, `name` is used. Messages in C++ omit the part up to the dot.
  std::string_view qualified = {};
  bool is_no_option = false;   ///< true if no option is generated, because the program sets the field in another way
  bool is_no_keyword = false;  ///< true if no keyword is generated, because Python sets the field in another way
  /// Name of the field in former versions, or empty. The option and the keyword made from it are still accepted.
  std::string_view former = {};
};

/// Description of a field of a request. The default value is the initialiser of the C++ member, so it is not repeated
/// here.
struct Row {
  std::string_view name;     ///< name of the field; a suffix such as _mm is the unit
  schema::Kind kind;         ///< type of the value and its allowed range or words
  std::string_view meaning;  ///< description for help and documentation, without a full stop at the end
  schema::Access access;
  Spelling spelling = {};
  std::span<const Need> needs = {};  ///< needs, each of which must be met if the value of the field is not its default
  bool is_required = false;

  Field field() const { return {spelling.qualified.empty() ? name : spelling.qualified}; }
};

/// Description of a request, which is a struct with the settings of a computation.
struct Request {
  std::string_view name;     ///< name of the type without "Request", such as "camera" for CameraRequest
  std::string_view command;  ///< command of the program, such as "image"; empty if the request has no command
  std::span<const Row> rows;
  const void* (*initial)();  ///< returns an object of the request type with default values
  /// Function that checks combinations of values that are allowed individually. It may be null.
  /// \throw InputError if a combination is not allowed; the error names a field
  void (*check)(const void* request) = nullptr;
};

/// Returns a request object with default values in all fields. Used as Request::initial.
template <class Type>
const void* initial_object() {
  static const Type initial;
  return &initial;
}

/// Returns the description of the request type `Type`. Each request type has a specialisation in requests/rows/.
template <class Type>
const Request& description();

/// Returns the descriptions of all requests.
std::span<const Request* const> all_requests();

/// Returns the row of the field with this name, or null if the request has no such field.
const Row* row_of(const Request& request, std::string_view name);

/// Returns the command-line option of a field, such as "--target-error".
std::string option_of(const Row& row);
/// Returns the option that a field had in former versions, or an empty text.
std::string former_option_of(const Row& row);
/// Returns the command-line option of a field. The function can be used as a FieldSpelling (core/field.h).
/// \param field name of the field in messages, as returned by Row::field()
std::string option_of_field(std::string_view field);

/// Checks a value and assigns it to a field.
/// \param object object of the request type to which the row belongs
/// \param value value other than std::monostate; see reset() for removing a value
/// \throw InputError if the value is not allowed; the error names the field
void set(const Row& row, void* object, const schema::Value& value);
/// Sets a field to its default.
/// \param object object of the type of `request`
void reset(const Request& request, const Row& row, void* object);
/// Parses a value in the notation of the command line, checks it and assigns it to a field.
/// \throw InputError if the text cannot be parsed or the value is not allowed; the error names the field
void set_text(const Row& row, void* object, std::string_view text);
/// Returns the value of a field in the notation of the command line. Returns an empty text if the field has no value.
std::string text_of(const Row& row, const void* object);
/// Returns a text for the default of a field: Spelling::otherwise, Spelling::usual, or the value of the default.
/// Returns an empty text if the field is required or has no default.
std::string default_text(const Request& request, const Row& row);

/// Checks the value of each field, the conditions in Row::needs, and combinations of values (Request::check).
/// \param object object of the request type
/// \throw InputError if a check fails; the error names the first field that is not allowed
void check(const Request& request, const void* object);
/// Checks the value of each field, the conditions in Row::needs, and combinations of values (Request::check).
/// \throw InputError if a check fails; the error names the first field that is not allowed
template <class Type>
void check(const Type& request) {
  check(description<Type>(), static_cast<const void*>(&request));
}

}  // namespace retrace::requests
