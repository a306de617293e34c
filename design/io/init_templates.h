#pragma once

// Commented example files for every kind of design, for `retrace init`.

#include <span>
#include <string>
#include <string_view>

namespace retrace::design {

/// Returns the kinds of designs, in the order in which they are listed.
std::span<const std::string_view> design_kinds();

/// Returns a complete, commented example file. For the kinds in design_kinds() it is a design that parse_design()
/// accepts. For "round_zone_lens" it is a part for `retrace plane`.
/// \throw InputError for other kinds
std::string design_template(std::string_view kind);

}  // namespace retrace::design
