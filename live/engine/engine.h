#pragma once

// Entry point of retrace for the live page. Requests and answers are JSON texts (README.md of live/).

#include <cstddef>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "live/engine/opened_design.h"

namespace retrace::live {

/// Stores the designs that a page has opened, and answers requests. Use in a single thread only.
class Engine {
 public:
  /// Maximum number of designs that are kept open.
  static constexpr std::size_t kMaxOpenDesigns = 64;

  Engine();
  ~Engine();

  /// Returns the answer to any request, including invalid ones, as one line of JSON.
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
