#include "retrace/drawing.h"

#include "library/drawing_content.h"

namespace retrace {

Drawing::Drawing(std::shared_ptr<const Content> content) : content_(std::move(content)) {}

std::string Drawing::svg() const {
  return content_ ? content_->svg() : std::string();
}

std::string Drawing::png() const {
  return content_ ? content_->png() : std::string();
}

}  // namespace retrace
