#pragma once

#include <span>
#include <string>
#include <string_view>

namespace retrace::studies {

/// The kinds that design_template() knows, in the order to list them.
std::span<const std::string_view> design_kinds();

/// A complete, commented design file to start from; parse_design() reads it as it is.
/// \throw InputError if `kind` is none of design_kinds().
std::string design_template(std::string_view kind);

}  // namespace retrace::studies
