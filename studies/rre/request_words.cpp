// Names of engines in requests, and checks of the values of options.
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

void check_share(double value, bool zero_allowed, const char* option) {
  if (!(value > 0.0 && value < 1.0) && !(zero_allowed && value == 0.0))
    throw InputError({"", 0, option},
                     fmt::format("must lie between 0 {}and 1, got {}", zero_allowed ? "(included) " : "", value));
}

bool is_one_of(Engine engine, std::span<const Engine> engines) {
  return std::ranges::count(engines, engine) > 0;
}

void check_has_effect(const char* option, bool is_given, Engine engine, std::span<const Engine> engines) {
  if (!is_given || is_one_of(engine, engines)) return;
  std::vector<std::string_view> names;
  for (const Engine allowed : engines) names.push_back(engine_name(allowed));
  throw InputError({"", 0, option},
                   fmt::format("needs --engine {}, got {}", fmt::join(names, " or "), engine_name(engine)));
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
