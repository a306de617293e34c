// For any table of facets, the reader either returns groups that satisfy its postconditions or throws an InputError of
// one line.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "studies/roughness/io/facet_table_reader.h"
#include "tests/fuzz/one_line.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
  try {
    const auto groups = retrace::studies::parse_facet_table(text, "fuzz.csv");
    if (groups.empty()) std::abort();
    for (const retrace::studies::FacetGroup& group : groups)
      if (group.facets == 0 || !(group.roughness_sa_nm >= 0.0 && group.roughness_sa_nm <= 1e5) ||
          !(group.waviness_sa_nm >= 0.0 && group.waviness_sa_nm <= 1e5) ||
          std::any_of(group.name.begin(), group.name.end(), is_control))
        std::abort();
  } catch (const retrace::InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
  return 0;
}
