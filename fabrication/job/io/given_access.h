#pragma once

// Accessors with which file formats read and write a member that a file contains only under a condition.

#include "core/schema/access.h"

namespace retrace::fabrication {

/// Access to an optional number. A file contains it only if it has a value.
template <auto member>
inline constexpr schema::Access access_given = {
    [](const void* object) {
      const auto& number = static_cast<const typename schema::MemberTypes<decltype(member)>::Object*>(object)->*member;
      return number ? schema::Value(*number) : schema::Value();
    },
    [](void* object, const schema::Value& value) {
      static_cast<typename schema::MemberTypes<decltype(member)>::Object*>(object)->*member = std::get<double>(value);
    }};

/// Access to a member that is written to a file only if `is_written` returns true for the object that contains the
/// member.
template <auto member, auto is_written>
inline constexpr schema::Access access_where = {
    [](const void* object) {
      const auto& typed = *static_cast<const typename schema::MemberTypes<decltype(member)>::Object*>(object);
      return is_written(typed) ? schema::get_member<member>(object) : schema::Value();
    },
    schema::set_member<member>};

}  // namespace retrace::fabrication
