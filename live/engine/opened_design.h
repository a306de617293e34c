#pragma once

// A design that the page has opened, with cached objects that many answers need.

#include <memory>
#include <optional>
#include <string>

#include "design/optical_model.h"
#include "materials/io/material_library.h"
#include "raytrace/exact/beam_tracer.h"
#include "studies/scene/design_excerpt.h"

namespace retrace::live {

class OpenedDesign {
 public:
  /// \throw InputError if the text is not a valid design, or if no part can be built from it
  OpenedDesign(std::string toml, const std::string& source, const materials::MaterialLibrary& library);
  OpenedDesign(const OpenedDesign&) = delete;
  OpenedDesign& operator=(const OpenedDesign&) = delete;

  const std::string& toml() const { return toml_; }
  const design::Design& design() const { return design_; }
  /// Returns the reason why the exact engine cannot trace this design, or an empty text.
  const std::string& why_not() const { return why_not_; }
  /// Returns the command line that computes the same result with the program.
  std::string command() const;

  /// Returns the optical model, or null for balls.
  const design::OpticalModel* model() const { return model_ ? &*model_ : nullptr; }
  /// \throw InputError if there is no optical model
  const design::OpticalModel& require_model() const;
  /// \throw InputError if the exact engine cannot trace this design
  const raytrace::BeamTracer& require_tracer() const;
  /// Returns the three-dimensional shape for display, which is built on first use.
  /// \throw InputError if there is nothing to display
  const studies::DesignExcerpt& excerpt() const;

 private:
  std::string toml_;
  design::Design design_;
  const materials::MaterialLibrary& library_;
  std::optional<design::OpticalModel> model_;
  std::string why_not_;
  std::optional<raytrace::BeamTracer> tracer_;
  mutable std::unique_ptr<const studies::DesignExcerpt> excerpt_;
};

}  // namespace retrace::live
