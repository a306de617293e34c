#include "live/engine/opened_design.h"

#include "core/error.h"
#include "design/engine_facts.h"
#include "design/file_names.h"
#include "design/io/design_reader.h"

namespace retrace::live {
OpenedDesign::OpenedDesign(std::string toml, const std::string& source, const materials::MaterialLibrary& library)
    : toml_(std::move(toml)), design_(design::parse_design(toml_, source)), library_(library) {
  design::require_no_files(design_, "which the live page cannot read: use the program retrace");
  design::require_supported(
      design_, {.what = "the live page", .balls = true, .solids = true, .entrances = true, .wet_backs = true});
  if (!design_.balls()) model_ = design::make_model(design_, library_);
  const raytrace::EngineFacts facts = design::engine_facts(design_, model_ ? &model_->optics : nullptr);
  if (const auto obstacle = raytrace::obstacle_for(raytrace::Engine::exact, facts))
    why_not_ = raytrace::traced_by(*obstacle, "Monte Carlo, which the live page does not support");
  else
    tracer_.emplace(model_->part, raytrace::BeamTracer::Elements::instanced);
}

std::string OpenedDesign::command() const {
  return "retrace rre DESIGN --incidence=-40:40:5";
}

const design::OpticalModel& OpenedDesign::require_model() const {
  if (!model_) throw InputError(design_.where("element.kind"), "balls are not shown on the live page");
  return *model_;
}

const raytrace::BeamTracer& OpenedDesign::require_tracer() const {
  if (!tracer_) throw InputError({design_.source_name(), 0, ""}, why_not_);
  return *tracer_;
}

const studies::DesignExcerpt& OpenedDesign::excerpt() const {
  if (!excerpt_) {
    require_model();
    excerpt_ = std::make_unique<const studies::DesignExcerpt>(design_, library_, studies::kLiveElements);
  }
  return *excerpt_;
}

}  // namespace retrace::live
