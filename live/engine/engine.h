#pragma once

// The door to retrace for the live page: requests and answers are JSON texts (README.md of live/).

#include <cstddef>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "live/engine/opened_design.h"

namespace retrace::live {

/// Keeps the designs that a page has opened, and answers what it asks. For one thread.
class Engine {
 public:
  /// Designs that are kept open.
  static constexpr std::size_t kMostOpen = 64;

  Engine();
  ~Engine();

  /// The answer to a request, one line of JSON, whatever the request is.
  std::string call(std::string_view request);

 private:
  using Json = nlohmann::ordered_json;

  Json answer(const Json& request);
  Json about() const;
  Json opened(std::string toml, const std::string& source);
  Json changed(const Json& request);
  const OpenedDesign& design_of(const Json& request) const;

  materials::MaterialLibrary library_;
  std::map<std::size_t, std::unique_ptr<const OpenedDesign>> designs_;
  std::size_t last_ = 0;
};

}  // namespace retrace::live
