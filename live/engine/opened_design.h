#pragma once

// A design that the page has opened, with what is made of it once and asked for often.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "materials/io/material_library.h"
#include "raytrace/exact/beam_tracer.h"
#include "studies/design/optical_model.h"
#include "studies/scene/piece.h"

namespace retrace::live {

class OpenedDesign {
 public:
  /// \throw InputError where the text is no design, or no part can be made of it
  OpenedDesign(std::string toml, const std::string& source, const materials::MaterialLibrary& library);
  OpenedDesign(const OpenedDesign&) = delete;
  OpenedDesign& operator=(const OpenedDesign&) = delete;

  const std::string& toml() const { return toml_; }
  const studies::Design& design() const { return design_; }
  /// Why beams cannot follow its light; empty if they can.
  const std::string& why_not() const { return why_not_; }
  /// The command that asks the same of the program.
  std::string command() const;

  /// None of balls.
  const studies::OpticalModel* model() const { return model_ ? &*model_ : nullptr; }
  /// \throw InputError where there is none
  const studies::OpticalModel& require_model() const;
  /// \throw InputError where beams do not serve
  const raytrace::BeamTracer& require_tracer() const;
  /// What is shown in three dimensions, made when it is first asked for. \throw InputError where there is nothing to
  /// show
  const studies::Piece& piece() const;

 private:
  std::string toml_;
  studies::Design design_;
  const materials::MaterialLibrary& library_;
  std::optional<studies::OpticalModel> model_;
  std::string why_not_;
  std::optional<raytrace::BeamTracer> tracer_;
  mutable std::unique_ptr<const studies::Piece> piece_;
};

}  // namespace retrace::live
