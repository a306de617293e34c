#pragma once

// Texts that describe the dependencies between options or between fields.

#include <span>
#include <string>
#include <string_view>

namespace retrace {

/// Returns the words as a list, such as "a, b or c".
/// \param conjunction word before the last one: "and" or "or"
std::string in_words(std::span<const std::string> words, std::string_view conjunction);

/// Returns the text that describes a requirement, such as "requires --camera or --road", "not allowed together with
/// --lamp" or "requires --engine exact if --cutoff is given". The requirement is met if at least one condition of
/// `required` is satisfied or at least one condition of `excluded` is not satisfied.
/// \pre at least one of the lists is not empty
std::string requirement_text(std::span<const std::string> required, std::span<const std::string> excluded);

}  // namespace retrace
