// Conversion between the engines and their names in requests.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/message_text.h"
#include "studies/rre/rre.h"

namespace retrace::studies {
namespace {

constexpr std::array<std::pair<std::string_view, Engine>, 6> kEngines = {{{"auto", Engine::automatic},
                                                                          {"exact", Engine::exact},
                                                                          {"stochastic", Engine::stochastic},
                                                                          {"montecarlo", Engine::montecarlo},
                                                                          {"cell", Engine::cell},
                                                                          {"embree", Engine::embree}}};

}  // namespace

bool is_one_of(Engine engine, std::span<const Engine> engines) {
  return std::ranges::count(engines, engine) > 0;
}

Engine engine_from_name(std::string_view name) {
  for (const auto& [known, engine] : kEngines)
    if (known == name) return engine;
  throw InputError(Field{"engine"},
                   fmt::format("must be auto, exact, stochastic, montecarlo, cell or embree, got {}", printable(name)));
}

std::string_view engine_name(Engine engine) {
  for (const auto& [name, known] : kEngines)
    if (known == engine) return name;
  return "";
}

}  // namespace retrace::studies
