#include "live/engine/opened_design.h"

#include "core/error.h"
#include "studies/design/engine_facts.h"
#include "studies/design/io/design_reader.h"
#include "studies/design/io/file_names.h"

namespace retrace::live {
OpenedDesign::OpenedDesign(std::string toml, const std::string& source, const materials::MaterialLibrary& library)
    : toml_(std::move(toml)), design_(studies::parse_design(toml_, source)), library_(library) {
  studies::check_names_no_file(design_, "which the live page cannot read: use the program retrace");
  if (!design_.balls()) model_ = studies::make_model(design_, library_);
  const raytrace::EngineFacts facts = studies::engine_facts(design_, model_ ? &model_->optics : nullptr);
  if (const auto obstacle = raytrace::why_not(raytrace::Engine::exact, facts))
    why_not_ = raytrace::traced_by(*obstacle, "Monte Carlo, which the live page does not support");
  else
    tracer_.emplace(model_->part, raytrace::BeamTracer::Elements::equal_at_once);
}

std::string OpenedDesign::command() const {
  return "retrace rre DESIGN --incidence=-40:40:5";
}

const studies::OpticalModel& OpenedDesign::require_model() const {
  if (!model_) throw InputError(design_.where("element.kind"), "balls are not shown on the live page");
  return *model_;
}

const raytrace::BeamTracer& OpenedDesign::require_tracer() const {
  if (!tracer_) throw InputError({design_.source_name(), 0, ""}, why_not_);
  return *tracer_;
}

const studies::Piece& OpenedDesign::piece() const {
  if (!piece_) {
    require_model();
    piece_ = std::make_unique<const studies::Piece>(design_, library_, studies::kLiveElements);
  }
  return *piece_;
}

}  // namespace retrace::live
