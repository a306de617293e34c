#pragma once

// Commented example files of every kind of design, for `retrace init`.

#include <span>
#include <string>
#include <string_view>

namespace retrace::studies {

/// The kinds of designs, in the order to list them.
std::span<const std::string_view> design_kinds();

/// A complete, commented file to start from: of design_kinds() a design, which parse_design() reads as it is, of
/// "round_zone_lens" a part for `retrace plane`.
/// \throw InputError if `kind` is none of these
std::string design_template(std::string_view kind);

}  // namespace retrace::studies
