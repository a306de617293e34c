#pragma once

// Drawings of results.

#include <memory>
#include <string>

#include "core/error.h"

namespace retrace {

/// A drawing of a result, made when it is asked for. Copies share what is drawn.
class RETRACE_API Drawing {
 public:
  Drawing() = default;  ///< none

  explicit operator bool() const { return content_ != nullptr; }
  /// As an SVG document; empty if there is none, or it is a picture of pixels alone. \throw OutputError
  std::string svg() const;
  /// As a PNG file; empty if there is none. \throw OutputError
  std::string png() const;

  struct Content;
  explicit Drawing(std::shared_ptr<const Content> content);

 private:
  std::shared_ptr<const Content> content_;
};

}  // namespace retrace
