// Validation rows for cutting forces: values with which the model was calibrated, values that it predicts, and values
// that it does not reproduce.

#include <fmt/format.h>

#include <string>
#include <utility>

#include "fabrication/forces/forces.h"
#include "fabrication/forces/io/force_table.h"
#include "studies/validation/rows.h"

namespace retrace::studies {
namespace {

using fabrication::CutConditions, fabrication::ForceEvents, fabrication::ForceModel;

/// Returns the conditions of experiment 1, with prisms of 1 mm. For a depth of 5 um, they are the conditions of the
/// third last of 142 cuts; for 10 um, of the second last of 71 cuts.
CutConditions experiment_1(double depth_um) {
  CutConditions cut;
  cut.depth_of_cut_um = depth_um;
  cut.width_mm = 0.982;
  // Length of the plunge from the first contact to the root, from recorded times in s and a feed of 10 mm/min.
  cut.plunge_mm = (5.23 - 1.0) * 10.0 / 60.0;
  cut.plough_mm = 0.25;
  return cut;
}

CutConditions experiment_2() {
  CutConditions cut = experiment_1(5.0);
  cut.width_mm = 0.818;
  cut.configuration = fabrication::Configuration::orthogonal;
  return cut;
}

CutConditions experiment_3(int facet) {
  CutConditions cut = experiment_1(5.0);
  cut.width_mm = 1.032;
  cut.strategy = fabrication::Strategy::bidirectional;
  cut.facet = facet;
  return cut;
}

ForceModel calibrated() {
  return fabrication::calibrate(fabrication::shipped_forces());
}

}  // namespace

std::vector<ValidationRow> force_validation() {
  constexpr const char* kSource = "Milliken 2017, chapter 4";
  std::vector<ValidationRow> rows;
  const auto add = [&](ValidationRow row) {
    row.topic = "Cutting forces in aluminium";
    row.reference = Reference::published;
    row.source = kSource;
    rows.push_back(std::move(row));
  };
  struct Event {
    CutConditions cut;
    std::string experiment, name;
    double ForceEvents::*force;
    double newton;
    std::optional<double> allowed;
    const char* why;
  };
  constexpr const char* kCalibrated = "the model is calibrated with this value";
  const CutConditions five = experiment_1(5.0);
  const CutConditions ten = experiment_1(10.0);
  for (const Event& e :
       {Event{five, "1, 5 um", "full chip, Fz", &ForceEvents::full_chip_fz_n, -1.57, 1e-9, kCalibrated},
        Event{five, "1, 5 um", "full chip, Fy", &ForceEvents::full_chip_fy_n, -0.66, 1e-9, kCalibrated},
        Event{five, "1, 5 um", "before the root, Fz", &ForceEvents::before_root_fz_n, -3.76, 1e-9, kCalibrated},
        Event{five, "1, 5 um", "root, Fz", &ForceEvents::root_fz_n, -5.34, 1e-9, kCalibrated},
        Event{five, "1, 5 um", "root, Fx", &ForceEvents::root_fx_n, -0.95, 1e-9, kCalibrated},
        Event{five, "1, 5 um", "plough peak, Fy", &ForceEvents::peak_fy_n, -3.33, 1e-9, kCalibrated},
        Event{ten, "1, 10 um", "full chip, Fz", &ForceEvents::full_chip_fz_n, -3.14, 1e-9, kCalibrated},
        Event{ten, "1, 10 um", "root, Fz", &ForceEvents::root_fz_n, -9.82, 1e-9, kCalibrated},
        Event{ten, "1, 10 um", "plough peak, Fy", &ForceEvents::peak_fy_n, -5.81, 1e-9, kCalibrated},
        Event{experiment_2(), "2, 5 um", "full chip, Fz", &ForceEvents::full_chip_fz_n, -1.29, 0.02 * 1.29,
              "2 %: predicted from experiment 1"},
        Event{experiment_2(), "2, 5 um", "root, Fz", &ForceEvents::root_fz_n, -4.06, std::nullopt,
              "without side walls, the chip moves freely, and forces do not scale with the width of the edge"},
        Event{experiment_2(), "2, 5 um", "plough peak, Fy", &ForceEvents::peak_fy_n, -1.73, std::nullopt,
              "without side walls, the chip moves freely"},
        Event{experiment_3(1), "3, facet 1", "root, Fz", &ForceEvents::root_fz_n, -26.29, 1e-9, kCalibrated},
        Event{experiment_3(1), "3, facet 1", "retract peak, Fy", &ForceEvents::peak_fy_n, -11.43, 1e-9, kCalibrated},
        Event{experiment_3(2), "3, facet 2", "root, Fz", &ForceEvents::root_fz_n, -15.74, 1e-9, kCalibrated},
        Event{experiment_3(2), "3, facet 2", "retract peak, Fy", &ForceEvents::peak_fy_n, -6.21, 1e-9, kCalibrated}})
    add({.quantity = fmt::format("experiment {}: {}", e.experiment, e.name),
         .unit = "N",
         .expected = e.newton,
         .allowed = e.allowed,
         .why = e.why,
         .compute = [cut = e.cut, force = e.force](auto) { return force_events(calibrated(), cut).*force; }});
  for (const double depth_um : {5.0, 10.0})
    add({.quantity = fmt::format("specific force of the chip at {} um", depth_um),
         .unit = "N/mm2",
         .expected = 319.8,
         .allowed = 0.1,
         .why = "forces are printed to 0.01 N",
         .compute = [depth_um](auto) { return calibrated().chip_fz_n_per_mm.at(depth_um) / (1e-3 * depth_um); }});
  for (const auto& [depth_um, friction] : {std::pair{5.0, 3.2}, {10.0, 4.2}})
    add({.quantity = fmt::format("friction of the side walls at {} um", depth_um),
         .unit = "N/mm",
         .expected = friction,
         .allowed = 0.05,
         .why = "printed to 0.1",
         .compute = [depth_um = depth_um](auto) { return calibrated().friction_n_per_mm.at(depth_um); }});
  return rows;
}

}  // namespace retrace::studies
