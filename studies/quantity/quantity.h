#pragma once

// Quantities that a study computes of each candidate design, such as RRE, areas or machining time, behind one
// interface.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "studies/quantity/candidate.h"

namespace retrace::studies {

/// What a quantity of a candidate came to.
struct Measured {
  std::optional<double> value;  ///< none where there is none, such as a limit that does not exist
  double std_error = 0.0;
};

/// The limit that a margin is counted from: value over limit - 1.
struct QuantityLimit {
  double value = 0.0;
  std::string unit;
};

/// Something that a study asks of every design: the one way in which sweeps, optimisation and tolerance studies reach
/// the rest of retrace. Values without state, shared by threads.
class Quantity {
 public:
  explicit Quantity(std::string name) : name_(std::move(name)) {}
  virtual ~Quantity() = default;
  Quantity(const Quantity&) = delete;
  Quantity& operator=(const Quantity&) = delete;

  /// Its column in tables; unique in a study.
  const std::string& name() const { return name_; }
  /// Nothing if it was cancelled. \throw Error if it cannot be computed for this candidate
  virtual std::optional<Measured> measure(const Candidate& candidate, const Cancellation* cancel) const = 0;
  /// Returns an identifier of the ray or beam tracing from which the value is computed. Quantities with equal
  /// identifiers share one tracing. The identifier is empty if nothing is traced and the computation takes negligible
  /// time.
  virtual std::string tracing() const { return {}; }
  /// What it is of, for people: "20' V 5 H -20".
  virtual std::string label() const { return name_; }
  /// Whether a part that is mixed of several has their mean, weighted by shares of the area: no least of several
  /// values.
  virtual bool adds_up() const { return true; }
  /// Of the margin to a limit: that limit.
  virtual std::optional<QuantityLimit> limit() const { return std::nullopt; }
  /// Its change with a parameter of the design, per unit of the parameter's name; none where it cannot be told
  /// reliably, or only by differences. \throw Error as measure()
  virtual std::optional<double> slope(const Candidate& candidate, RreParameter parameter,
                                      const Cancellation* cancel) const;

 private:
  std::string name_;
};

using Quantities = std::vector<std::shared_ptr<const Quantity>>;

/// Directions over which a quantity is taken, and how they count.
struct AngleWindow {
  std::optional<std::vector<double>> incidence_deg;  ///< without it, that of the analysis
  std::optional<std::vector<double>> azimuth_deg;    ///< likewise
  bool by_solid_angle = false;                       ///< directions count by |sin t|; else all alike
};

/// `each`: a quantity for each direction.
enum class Reduction { mean, least, each };

/// A share of the incident light over a window: RRE, or another account of the ledger. One quantity has one direction
/// where each has its own.
struct ShareSpec {
  AngleWindow window;
  Reduction reduction = Reduction::mean;
  std::size_t account = static_cast<std::size_t>(raytrace::Account::retroreflected);
  std::optional<double> acceptance_half_angle_deg;  ///< without it, the design's narrowest
  /// Far field: what comes back between this half-angle and the other.
  std::optional<double> beyond_half_angle_deg;
};
std::shared_ptr<const Quantity> make_share(std::string name, const ShareSpec& spec);

/// What needs no light; see docs/study_file.md.
enum class PlainQuantity {
  elements_full,
  elements_partial,
  element_depth_mm,
  lens_thickness_mm,
  facet_area_mm2,
  effective_area_mm2,
  entrance_area_mm2,
  full_element_share,
  tir_limit_deg,
  tool_fit_mm,
  machining_time_h,
  machining_time_per_element_s,
  area_rate_mm2_per_h,
  process_sa_nm,
  root_radius_um
};
std::shared_ptr<const Quantity> make_plain(std::string name, PlainQuantity which);

}  // namespace retrace::studies
