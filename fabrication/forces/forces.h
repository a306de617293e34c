#pragma once

// A mechanistic model of cutting forces in plunging and ploughing, calibrated on published measurements.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/warning.h"
#include "fabrication/job/job.h"

namespace retrace::fabrication {

/// One measured force. Forces act on the tool, in machine axes.
struct MeasuredForce {
  int experiment = 0;
  std::string strategy;
  std::string configuration;
  double depth_of_cut_um = 0.0;
  double width_mm = 0.0;
  std::string event;
  std::optional<double> time_s;  ///< after the start of the record, in which the tool meets the face at 1 s
  std::optional<double> fx_n;
  std::optional<double> fy_n;
  std::optional<double> fz_n;
};

/// Whether the tool cuts with its edge alone, or between walls that its sides rub on.
enum class Configuration { isolated, orthogonal };
inline constexpr std::string_view kConfigurationWords[] = {"isolated", "orthogonal"};

/// A straight line in the depth of cut: edge + shear depth.
struct LinearInDepth {
  double at_zero = 0.0;
  double per_um = 0.0;
  double at(double depth_um) const { return at_zero + per_um * depth_um; }
};

/// A mechanistic model of one plunge (docs/theory/forces.md). Amounts are positive; the tool is pushed towards -X, -Y
/// and -Z while it plunges and ploughs, as measured.
struct ForceModel {
  LinearInDepth chip_fz_n_per_mm;    ///< at full chip load, for each mm of edge
  LinearInDepth chip_fy_n_per_mm;    ///< likewise
  LinearInDepth friction_n_per_mm;   ///< of both side walls, for each mm that the tool is engaged
  LinearInDepth side_fx_n_per_mm;    ///< sideways, from a tool that is not aligned, for each mm engaged
  LinearInDepth root_fz_n_per_mm;    ///< that the chip adds as it is pressed against the other facet, per mm of edge
  LinearInDepth plough_fy_n_per_mm;  ///< peak as the plough shears the chip off, per mm of edge
  LinearInDepth chip_travel_um;      ///< from first contact to full chip load along Z
  LinearInDepth chip_travel_fy_um;   ///< the same along Y, where the chip must form first
  LinearInDepth root_travel_um;      ///< before the root over which the root's force rises
  /// Of bidirectional plunges along facets 1 and 2, at one depth of cut only: what stands in for root and plough.
  std::array<double, 2> bidirectional_root_n_per_mm{};     ///< whole F_z at the root, per mm of edge
  std::array<double, 2> bidirectional_retract_n_per_mm{};  ///< peak of F_y at the start of the retract, likewise
  double calibrated_from_um = 0.0;                         ///< depths of cut that the lines go through
  double calibrated_to_um = 0.0;
  double bidirectional_um = 0.0;
};

/// Lines through experiment 1's two depths of cut; experiment 3 gives the bidirectional figures.
/// \throw InputError if the table lacks a row that is needed
ForceModel calibrate(const std::vector<MeasuredForce>& table);

/// One cut, to tell its forces.
struct CutConditions {
  Strategy strategy = Strategy::unidirectional;  ///< two_step: not allowed, ask for either of its parts
  int facet = 1;                                 ///< bidirectional: 1 or 2
  Configuration configuration = Configuration::isolated;
  double depth_of_cut_um = 5.0;
  double width_mm = 1.0;
  double plunge_mm = 0.7;  ///< from the face to the root
  double plough_mm = 0.1;
  double dwell_s = 0.1;
  double clearance_mm = 0.0;  ///< travelled along Z before first contact
  double feed_mm_per_min = 10.0;
  double retract_feed_mm_per_min = 200.0;
};

/// Forces at the events of a cut, in N, signed.
struct ForceEvents {
  double full_chip_fz_n = 0.0;
  double full_chip_fy_n = 0.0;
  double before_root_fz_n = 0.0;
  double root_fz_n = 0.0;
  double root_fx_n = 0.0;
  double peak_fy_n = 0.0;  ///< of the plough, or of the retract of a bidirectional cut
};
ForceEvents force_events(const ForceModel& model, const CutConditions& cut);

/// What the tool does at a time of a profile.
enum class ForcePhase { approach, plunge, dwell, plough, retract };
inline constexpr std::string_view kForcePhaseWords[] = {"approach", "plunge", "dwell", "plough", "retract"};

struct ForceSample {
  double time_s = 0.0;
  ForcePhase phase = ForcePhase::approach;
  double engaged_mm = 0.0;  ///< depth of the edge below the face along the facet
  double fx_n = 0.0;
  double fy_n = 0.0;
  double fz_n = 0.0;
};

/// Forces over one cycle, at the corners of the piecewise linear model; time counts from the start of the approach.
std::vector<ForceSample> force_profile(const ForceModel& model, const CutConditions& cut);

/// Remarks on conditions that the measurements do not cover, such as depths of cut below 5 um.
Warnings force_warnings(const ForceModel& model, const CutConditions& cut);

/// Depth below which the linear law is not shown to hold.
inline constexpr double kLeastLinearDepthUm = 5.0;

}  // namespace retrace::fabrication
