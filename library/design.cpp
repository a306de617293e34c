#include "retrace/design.h"

#include <nlohmann/json.hpp>

#include "core/json_text.h"
#include "core/version.h"
#include "design/io/design_json.h"
#include "design/io/design_reader.h"
#include "library/content.h"
#include "retrace/running.h"

namespace retrace {
namespace {

Design holding(design::Design design, std::string text, std::vector<std::string> overrides) {
  return Design(std::make_shared<const Design::Content>(
      Design::Content{std::move(design), std::move(text), std::move(overrides)}));
}

}  // namespace

const char* version() {
  return kVersion;
}

Design::Design(std::shared_ptr<const Content> content) : content_(std::move(content)) {
  if (!content_) throw InputError({"", 0, "design"}, "must come from Design::load() or Design::parse(), got null");
}

Design Design::load(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return parse(design::read_toml_text(file), file == "-" ? "standard input" : file.string(), overrides);
}

Design Design::parse(std::string_view text, const std::string& source, const std::vector<std::string>& overrides) {
  return holding(design::parse_design(text, source, overrides), std::string(text), overrides);
}

Design Design::with(const std::vector<std::string>& overrides) const {
  std::vector<std::string> all = content_->overrides;
  all.insert(all.end(), overrides.begin(), overrides.end());
  return holding(design::with(content_->design, overrides), content_->text, std::move(all));
}

std::string Design::title() const {
  return content_->design.title;
}

std::string Design::source() const {
  return content_->design.source;
}

std::string Design::text() const {
  return content_->text;
}

std::vector<std::string> Design::overrides() const {
  return content_->overrides;
}

std::string Design::json() const {
  return to_text(design::to_json(content_->design));
}

std::vector<std::filesystem::path> Design::files() const {
  return content_->design.files();
}

Warnings Design::warnings() const {
  return content_->design.warnings();
}

}  // namespace retrace
