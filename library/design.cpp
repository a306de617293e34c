#include "retrace/design.h"

#include <nlohmann/json.hpp>

#include "core/json_text.h"
#include "core/version.h"
#include "library/content.h"
#include "retrace/running.h"
#include "studies/design/io/design_json.h"
#include "studies/design/io/design_reader.h"

namespace retrace {
namespace {

Design holding(studies::Design design) {
  return Design(std::make_shared<const Design::Content>(Design::Content{std::move(design)}));
}

}  // namespace

const char* version() {
  return kVersion;
}

Design::Design(std::shared_ptr<const Content> content) : content_(std::move(content)) {}

Design Design::load(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return holding(studies::read_design(file, overrides));
}

Design Design::parse(std::string_view text, const std::string& source, const std::vector<std::string>& overrides) {
  return holding(studies::parse_design(text, source, overrides));
}

Design Design::with(const std::vector<std::string>& overrides) const {
  return holding(studies::with(content_->design, overrides));
}

std::string Design::title() const {
  return content_->design.title;
}

std::string Design::json() const {
  return to_text(studies::to_json(content_->design));
}

std::vector<std::filesystem::path> Design::files() const {
  return content_->design.files();
}

}  // namespace retrace
