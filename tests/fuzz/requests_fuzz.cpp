// The first two bytes of an input select a field of a request. The remaining bytes are the text of the field, as on the
// command line. The text either gives a value or causes an InputError of one line. If a value is converted to text,
// this text must give the same value.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/error.h"
#include "requests/descriptions.h"
#include "tests/fuzz/one_line.h"

namespace {

using namespace retrace;

template <class Type>
void try_text(std::uint8_t row_number, std::string_view text) {
  const requests::Request& description = requests::description<Type>();
  const requests::Row& row = description.rows[row_number % description.rows.size()];
  Type request;
  try {
    requests::set_text(row, &request, text);
    const std::string own = requests::text_of(row, &request);
    // A field without value has an empty text.
    if (!own.empty()) requests::set_text(row, &request, own);
    if (requests::text_of(row, &request) != own) std::abort();
    requests::check(request);
  } catch (const InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
}

template <class... Types>
std::vector<void (*)(std::uint8_t, std::string_view)> tries_of(std::tuple<Types...>*) {
  return {try_text<Types>...};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  static const auto tries = tries_of(static_cast<requests::AllRequests*>(nullptr));
  tries[data[0] % tries.size()](data[1], {reinterpret_cast<const char*>(data) + 2, size - 2});
  return 0;
}
