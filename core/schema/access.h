#pragma once

// Functions that read and set members of C++ objects for a file format (see core/schema/schema.h). The rows and tables
// of the format contain pointers to these functions. The functions are generated from pointers to members, or from
// functions of the object's type.

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/schema/schema.h"

namespace retrace::schema {

template <class>
struct MemberTypes;
template <class Object_, class Type_>
struct MemberTypes<Type_ Object_::*> {
  using Object = Object_;
  using Type = Type_;
};
template <class>
struct FirstOf;
template <class Result, class First, class... Rest>
struct FirstOf<Result (*)(First, Rest...)> {
  using Type = std::remove_cvref_t<First>;
};

template <class Type>
inline constexpr bool is_optional = false;
template <class Type>
inline constexpr bool is_optional<std::optional<Type>> = true;
template <class Type>
inline constexpr bool is_array = false;
template <std::size_t size>
inline constexpr bool is_array<std::array<double, size>> = true;

/// Converts a member of an object to a Value. Returns std::monostate for an empty optional or an empty path.
template <class Type>
Value to_value(const Type& member) {
  if constexpr (is_optional<Type>)
    return member ? to_value(*member) : Value();
  else if constexpr (is_array<Type>)
    return std::vector<double>(member.begin(), member.end());
  else if constexpr (std::is_same_v<Type, std::filesystem::path>)
    return member.empty() ? Value() : Value(member.string());
  else if constexpr (std::is_enum_v<Type> || (std::is_integral_v<Type> && !std::is_same_v<Type, bool>))
    return static_cast<double>(member);
  else
    return member;
}

/// Sets a member of an object from a Value. std::monostate clears an optional or a path.
/// \pre the value has the alternative that to_value() returns for the member, and integers fit the type of the member
template <class Type>
void from_value(Type& member, const Value& value) {
  if constexpr (is_optional<Type>) {
    if (std::holds_alternative<std::monostate>(value))
      member.reset();
    else
      from_value(member.emplace(), value);
  } else if constexpr (is_array<Type>) {
    const auto& numbers = std::get<std::vector<double>>(value);
    std::copy(numbers.begin(), numbers.end(), member.begin());
  } else if constexpr (std::is_same_v<Type, std::filesystem::path>) {
    const std::string* const name = std::get_if<std::string>(&value);
    member = name != nullptr ? *name : std::string();
  } else if constexpr (std::is_enum_v<Type>) {
    member = static_cast<Type>(static_cast<int>(std::get<double>(value)));
  } else if constexpr (std::is_integral_v<Type> && !std::is_same_v<Type, bool>) {
    member = static_cast<Type>(std::get<double>(value));
  } else {
    member = std::get<Type>(value);
  }
}

template <auto member>
Value get_member(const void* object) {
  using Types = MemberTypes<decltype(member)>;
  return to_value(static_cast<const typename Types::Object*>(object)->*member);
}

template <auto member>
void set_member(void* object, const Value& value) {
  using Types = MemberTypes<decltype(member)>;
  from_value(static_cast<typename Types::Object*>(object)->*member, value);
}

/// Access to a data member: a number, a flag, a text, a path, a list of these, an optional of these, or an enumerator.
/// The value of an enumerator is the index of its word.
template <auto member>
inline constexpr Access access = {get_member<member>, set_member<member>};

/// Access to a member of a variant's alternative. `variant` is the variant, a member of the object, and `member` is a
/// member of the alternative that it holds.
template <auto variant, auto member>
inline constexpr Access access_in = {
    [](const void* object) {
      const auto& value = static_cast<const typename MemberTypes<decltype(variant)>::Object*>(object)->*variant;
      return get_member<member>(&std::get<typename MemberTypes<decltype(member)>::Object>(value));
    },
    [](void* object, const Value& given) {
      auto& value = static_cast<typename MemberTypes<decltype(variant)>::Object*>(object)->*variant;
      set_member<member>(&std::get<typename MemberTypes<decltype(member)>::Object>(value), given);
    }};

template <auto get>
Value get_by(const void* object) {
  return get(*static_cast<const typename FirstOf<decltype(get)>::Type*>(object));
}
template <auto set>
void set_by(void* object, const Value& value) {
  set(*static_cast<typename FirstOf<decltype(set)>::Type*>(object), value);
}
/// Access through the functions `Value get(const Object&)` and `void set(Object&, const Value&)`.
template <auto get, auto set>
inline constexpr Access access_by = {get_by<get>, set_by<set>};

/// Calls the function of a rule with an object. The function must have one of three forms:
/// - `void (const Object&, const Refuse&)`;
/// - `void (const Object&)`, which throws an error if the rule is violated;
/// - `std::string (const Object&)`, which returns a message, or an empty text if the rule holds.
template <auto function>
void check_by(const void* object, const Refuse& refuse) {
  const auto& typed = *static_cast<const typename FirstOf<decltype(function)>::Type*>(object);
  if constexpr (std::is_invocable_v<decltype(function), decltype(typed), const Refuse&>)
    function(typed, refuse);
  else if constexpr (std::is_void_v<std::invoke_result_t<decltype(function), decltype(typed)>>)
    function(typed);
  else if (const std::string complaint = function(typed); !complaint.empty())
    refuse({}, complaint);
}

template <auto member>
const void* child_at(const void* parent, std::size_t) {
  return &(static_cast<const typename MemberTypes<decltype(member)>::Object*>(parent)->*member);
}
template <auto member>
void* child_of(void* parent) {
  return &(static_cast<typename MemberTypes<decltype(member)>::Object*>(parent)->*member);
}
/// Access to the object of an inner table. It is a member of the object of the outer table, so it always exists.
template <auto member>
inline constexpr Child child = {[](const void*) -> std::size_t { return 1; }, child_at<member>, child_of<member>};

/// Access to an inner table that is only read from files. When the object is written, the data of this table are
/// written in the form of another table.
template <auto member>
inline constexpr Child child_only_read = {[](const void*) -> std::size_t { return 0; }, child_at<member>,
                                          child_of<member>};

/// Access to a list of tables. Their objects are in a vector, which is a member of the object of the outer table.
template <auto member>
inline constexpr Child children = {
    [](const void* parent) {
      return (static_cast<const typename MemberTypes<decltype(member)>::Object*>(parent)->*member).size();
    },
    [](const void* parent, std::size_t index) -> const void* {
      return &(static_cast<const typename MemberTypes<decltype(member)>::Object*>(parent)->*member)[index];
    },
    [](void* parent) -> void* {
      return &(static_cast<typename MemberTypes<decltype(member)>::Object*>(parent)->*member).emplace_back();
    }};

}  // namespace retrace::schema
