#pragma once

// Quantities that a study computes for each candidate design, such as RRE, areas or machining time. They have a common
// interface.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "studies/quantity/candidate.h"

namespace retrace::studies {

/// Value of a quantity for a candidate.
struct Measured {
  std::optional<double> value;  ///< none if the quantity is not defined for this candidate
  double std_error = 0.0;
};

/// Limit of a quantity that is a margin. The margin is value / limit - 1.
struct QuantityLimit {
  double value = 0.0;
  std::string unit;
};

/// Quantity that a study computes for every design. Sweeps, optimizations and tolerance studies compute RRE, photometry
/// and other results only through this interface. Objects have no state and are shared by threads.
class Quantity {
 public:
  explicit Quantity(std::string name) : name_(std::move(name)) {}
  virtual ~Quantity() = default;
  Quantity(const Quantity&) = delete;
  Quantity& operator=(const Quantity&) = delete;

  /// Returns the name of the quantity's column in tables. It is unique in a study.
  const std::string& name() const { return name_; }
  /// Computes the value for a candidate. Returns nothing if the computation was cancelled.
  /// \throw Error if the quantity cannot be computed for this candidate
  virtual std::optional<Measured> measure(const Candidate& candidate, const Cancellation* cancel) const = 0;
  /// Returns an identifier of the ray or beam tracing from which the value is computed. Quantities with equal
  /// identifiers share one tracing. The identifier is empty if nothing is traced and the computation takes negligible
  /// time.
  virtual std::string tracing() const { return {}; }
  /// Returns a readable description of the quantity, such as "20' V 5 H -20".
  virtual std::string label() const { return name_; }
  /// Returns true if the quantity of a part with several kinds of cells is the area-weighted mean of the cells' values.
  /// This is not the case for a minimum of several values.
  virtual bool is_additive() const { return true; }
  /// Returns the limit of a quantity that is a margin. Returns nothing for other quantities.
  virtual std::optional<QuantityLimit> limit() const { return std::nullopt; }
  /// Returns the derivative (slope) of the quantity with respect to a parameter of the design, in the unit of the
  /// parameter. Returns nothing if the derivative is unreliable or available only by finite differences.
  /// \throw Error in the same cases as measure()
  virtual std::optional<double> slope(const Candidate& candidate, RreParameter parameter,
                                      const Cancellation* cancel) const;

 private:
  std::string name_;
};

using Quantities = std::vector<std::shared_ptr<const Quantity>>;

/// Directions over which a quantity is averaged or minimized, and their weights.
struct AngleWindow {
  std::optional<std::vector<double>> incidence_deg;  ///< none: incidence of the analysis
  std::optional<std::vector<double>> azimuth_deg;    ///< none: azimuth of the analysis
  bool by_solid_angle = false;                       ///< true: weights proportional to |sin t|; false: equal weights
};

/// Method by which the values for several directions are combined. With `each`, they are not combined: each direction
/// becomes a quantity.
enum class Reduction { mean, min, each };

/// Fraction of the incident light over a window of directions: RRE, or another account (category of power) of the
/// ledger. With Reduction::each, every quantity has a window of one direction.
struct FractionSpec {
  AngleWindow window;
  Reduction reduction = Reduction::mean;
  std::size_t account = static_cast<std::size_t>(raytrace::Account::retroreflected);
  std::optional<double> acceptance_half_angle_deg;  ///< none: smallest cone of the design
  /// Inner half-angle of a far-field quantity, which counts light between this half-angle and
  /// acceptance_half_angle_deg.
  std::optional<double> beyond_half_angle_deg;
};
std::shared_ptr<const Quantity> make_fraction(std::string name, const FractionSpec& spec);

/// Quantities that need no ray tracing; see docs/study_file.md.
enum class PlainQuantity {
  elements_full,
  elements_partial,
  element_depth_mm,
  lens_thickness_mm,
  facet_area_mm2,
  effective_area_mm2,
  entrance_area_mm2,
  full_element_area_fraction,
  tir_limit_deg,
  tool_fit_mm,
  machining_time_h,
  machining_time_per_element_s,
  area_rate_mm2_per_h,
  process_sa_nm,
  root_radius_um,
  machine_travel_mm,
  edge_life_margin_mm
};
std::shared_ptr<const Quantity> make_plain(std::string name, PlainQuantity which);

}  // namespace retrace::studies
