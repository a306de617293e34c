#pragma once

// Functions that return the validation rows of each topic. Each function is in a file of its own.

#include <string>
#include <utility>
#include <vector>

#include "studies/validation/validation.h"

namespace retrace::studies {

/// Returns a function that appends a row to `rows` and gives it a topic and a source.
/// \pre the function is not called after the end of the life of `rows`
inline auto appender(std::vector<ValidationRow>& rows, const std::string& topic, const std::string& source) {
  return [&rows, topic, source](ValidationRow row) {
    row.topic = topic;
    row.source = source;
    rows.push_back(std::move(row));
  };
}

/// Returns rows for retroreflective efficiency, total reflection, apertures, angle errors and diffraction.
std::vector<ValidationRow> light_validation();
/// Returns rows for balls with mirrors.
std::vector<ValidationRow> ball_validation();
/// Returns rows for cross sections of cube corners in laser ranging.
std::vector<ValidationRow> ranging_validation();
/// Returns rows for materials, roughness of facets and scatter.
std::vector<ValidationRow> surface_validation();
/// Returns rows for kinematics, cuts and machining times.
std::vector<ValidationRow> chisel_validation();
/// Returns rows for cutting forces.
std::vector<ValidationRow> force_validation();
/// Returns rows for turned and planed surfaces.
std::vector<ValidationRow> turning_validation();

}  // namespace retrace::studies
