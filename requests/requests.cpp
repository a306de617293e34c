#include <algorithm>
#include <array>

#include "requests/descriptions.h"

namespace retrace::requests {

namespace {

template <class... Types>
std::array<const Request*, sizeof...(Types)> descriptions_of(const std::tuple<Types...>*) {
  return {&description<Types>()...};
}

}  // namespace

std::span<const Request* const> all_requests() {
  static const auto all = descriptions_of(static_cast<const AllRequests*>(nullptr));
  return all;
}

const Row* row_of(const Request& request, std::string_view name) {
  const auto found = std::ranges::find(request.rows, name, &Row::name);
  return found == request.rows.end() ? nullptr : &*found;
}

std::string option_of(const Row& row) {
  if (!row.spelling.option.empty()) return std::string(row.spelling.option);
  std::string option = (row.spelling.notation == Notation::absent ? "--no-" : "--") + std::string(row.name);
  std::replace(option.begin(), option.end(), '_', '-');
  return option;
}

std::string option_of_field(std::string_view field) {
  for (const Request* const request : all_requests())
    for (const Row& row : request->rows)
      if (row.field().name == field) return option_of(row);
  return option_of(Row{field, schema::Flag{}, {}, {}});
}

}  // namespace retrace::requests
