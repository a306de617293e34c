#include "core/requirement_text.h"

#include <fmt/format.h>

namespace retrace {

std::string in_words(std::span<const std::string> words, std::string_view conjunction) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (k > 0) text += k + 1 == words.size() ? fmt::format(" {} ", conjunction) : ", ";
    text += words[k];
  }
  return text;
}

std::string requirement_text(std::span<const std::string> required, std::span<const std::string> excluded) {
  if (required.empty()) return "not allowed together with " + in_words(excluded, "and");
  const std::string requirement = "requires " + in_words(required, "or");
  if (excluded.empty()) return requirement;
  return fmt::format("{} if {} {} given", requirement, in_words(excluded, "and"), excluded.size() == 1 ? "is" : "are");
}

}  // namespace retrace
