#pragma once

// Drawings of results.

#include <memory>
#include <string>

#include "core/error.h"

namespace retrace {

/// A drawing of a result. It is drawn when svg() or png() is called. Copies share their data.
class RETRACE_API Drawing {
 public:
  Drawing() = default;  ///< an empty object without a drawing

  explicit operator bool() const { return content_ != nullptr; }
  /// Returns the drawing as an SVG document. Returns an empty text if there is no drawing or it has only a PNG file.
  /// \throw OutputError if the drawing fails
  std::string svg() const;
  /// Returns the drawing as the content of a PNG file. Returns an empty text if there is no drawing.
  /// \throw OutputError if the drawing fails
  std::string png() const;

  struct Content;
  explicit Drawing(std::shared_ptr<const Content> content);

 private:
  std::shared_ptr<const Content> content_;
};

}  // namespace retrace
