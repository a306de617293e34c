#pragma once

// Members that a file names only where they mean something.

#include "core/schema/access.h"

namespace retrace::fabrication {

/// A member that is an optional number.
template <auto member>
inline constexpr schema::Access access_given = {
    [](const void* object) {
      const auto& number = static_cast<const typename schema::MemberTypes<decltype(member)>::Object*>(object)->*member;
      return number ? schema::Value(*number) : schema::Value();
    },
    [](void* object, const schema::Value& value) {
      static_cast<typename schema::MemberTypes<decltype(member)>::Object*>(object)->*member = std::get<double>(value);
    }};

/// A member that is written where a function of its object says so.
template <auto member, auto is_written>
inline constexpr schema::Access access_where = {
    [](const void* object) {
      const auto& typed = *static_cast<const typename schema::MemberTypes<decltype(member)>::Object*>(object);
      return is_written(typed) ? schema::get_member<member>(object) : schema::Value();
    },
    schema::set_member<member>};

}  // namespace retrace::fabrication
