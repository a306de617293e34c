#pragma once

// Mechanistic model of the cutting forces in plunging and ploughing, calibrated with published measurements.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/warning.h"
#include "fabrication/job/job.h"

namespace retrace::fabrication {

/// Measured force on the tool, in machine axes.
struct MeasuredForce {
  int experiment = 0;
  std::string strategy;
  std::string configuration;
  double depth_of_cut_um = 0.0;
  double width_mm = 0.0;
  std::string event;
  std::optional<double> time_s;  ///< time since the start of the record; the tool touches the face at 1 s
  std::optional<double> fx_n;
  std::optional<double> fy_n;
  std::optional<double> fz_n;
};

/// Configuration of a cut. Isolated: the sides of the tool rub on the walls of the groove. Orthogonal: only the edge
/// touches the material.
enum class Configuration { isolated, orthogonal };
inline constexpr std::string_view kConfigurationWords[] = {"isolated", "orthogonal"};

/// Linear function of the depth of cut: the sum of a constant (edge force) and a part proportional to the depth (shear
/// force).
struct LinearInDepth {
  double at_zero = 0.0;
  double per_um = 0.0;
  double at(double depth_um) const { return at_zero + per_um * depth_um; }
};

/// Mechanistic model of the cutting forces in one plunge (docs/theory/forces.md). All values are positive. The measured
/// forces push the tool towards -X, -Y and -Z during plunging and ploughing.
struct ForceModel {
  LinearInDepth chip_fz_n_per_mm;    ///< F_z at full chip load, per mm of edge
  LinearInDepth chip_fy_n_per_mm;    ///< F_y at full chip load, per mm of edge
  LinearInDepth friction_n_per_mm;   ///< friction on both side walls, per mm of engagement
  LinearInDepth side_fx_n_per_mm;    ///< lateral force due to misalignment of the tool, per mm of engagement
  LinearInDepth root_fz_n_per_mm;    ///< additional F_z of the chip that touches the other facet, per mm of edge
  LinearInDepth plough_fy_n_per_mm;  ///< peak of F_y when the plough shears the chip off, per mm of edge
  LinearInDepth chip_travel_um;      ///< travel from first contact to full chip load in F_z
  LinearInDepth chip_travel_fy_um;   ///< travel from first contact to full chip load in F_y
  LinearInDepth root_travel_um;      ///< travel before the root over which the additional force rises
  // Bidirectional plunges along facets 1 and 2 were measured at one depth of cut only.
  std::array<double, 2> bidirectional_root_n_per_mm{};     ///< total F_z at the root, per mm of edge
  std::array<double, 2> bidirectional_retract_n_per_mm{};  ///< peak of F_y at the start of the retract, per mm of edge
  double calibrated_from_um = 0.0;                         ///< smaller one of the two depths of cut of the calibration
  double calibrated_to_um = 0.0;                           ///< larger one of the two depths of cut of the calibration
  double bidirectional_um = 0.0;                           ///< depth of cut of the bidirectional measurements
};

/// Calibrates the model with the two depths of cut of experiment 1, and with the bidirectional values of experiment 3.
/// \throw InputError if a required row is missing in the table
ForceModel calibrate(const std::vector<MeasuredForce>& table);

/// Conditions of one cut.
struct CutConditions {
  /// Unidirectional or bidirectional; two_step, which combines both, is not allowed.
  Strategy strategy = Strategy::unidirectional;
  int facet = 1;  ///< plunged facet of a bidirectional cut: 1 or 2
  Configuration configuration = Configuration::isolated;
  double depth_of_cut_um = 5.0;
  double width_mm = 1.0;
  double plunge_mm = 0.7;  ///< distance from the face to the root
  double plough_mm = 0.1;
  double dwell_s = 0.1;
  double clearance_mm = 0.0;  ///< travel along Z before the first contact
  double feed_mm_per_min = 10.0;
  double retract_feed_mm_per_min = 200.0;
};

/// Forces at the events of a cut, in N, with their signs.
struct ForceEvents {
  double full_chip_fz_n = 0.0, full_chip_fy_n = 0.0;
  double before_root_fz_n = 0.0;
  double root_fz_n = 0.0, root_fx_n = 0.0;
  double peak_fy_n = 0.0;  ///< peak during the plough, or during the retract of a bidirectional cut
};
ForceEvents force_events(const ForceModel& model, const CutConditions& cut);

/// Phase of a cutting cycle.
enum class ForcePhase { approach, plunge, dwell, plough, retract };
inline constexpr std::string_view kForcePhaseWords[] = {"approach", "plunge", "dwell", "plough", "retract"};

struct ForceSample {
  double time_s = 0.0;
  ForcePhase phase = ForcePhase::approach;
  double engaged_mm = 0.0;  ///< depth of the edge below the face, along the facet
  double fx_n = 0.0;
  double fy_n = 0.0;
  double fz_n = 0.0;
};

/// Returns the forces over one cycle, at the corners of the piecewise linear model. Time counts from the start of the
/// approach.
std::vector<ForceSample> force_profile(const ForceModel& model, const CutConditions& cut);

/// Returns warnings about conditions outside of the measurements, such as depths of cut below 5 um.
Warnings force_warnings(const ForceModel& model, const CutConditions& cut);

/// Minimum depth of cut, in um, for which measurements confirm the linear model.
inline constexpr double kMinLinearDepthUm = 5.0;

}  // namespace retrace::fabrication
