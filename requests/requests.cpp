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

namespace {

std::string option_named(std::string_view name, Notation notation) {
  std::string option = (notation == Notation::absent ? "--no-" : "--") + std::string(name);
  std::replace(option.begin(), option.end(), '_', '-');
  return option;
}

}  // namespace

std::string option_of(const Row& row) {
  if (!row.spelling.option.empty()) return std::string(row.spelling.option);
  return option_named(row.name, row.spelling.notation);
}

std::string former_option_of(const Row& row) {
  return row.spelling.former.empty() ? std::string() : option_named(row.spelling.former, row.spelling.notation);
}

std::string option_of_field(std::string_view field) {
  for (const Request* const request : all_requests())
    for (const Row& row : request->rows)
      if (row.field().name == field) return option_of(row);
  return option_of(Row{field, schema::Flag{}, {}, {}});
}

}  // namespace retrace::requests
