#pragma once

// Retroreflective efficiency (RRE) of designs for given directions of light. Also the ledger, which accounts for all
// power that is not retroreflected. `retrace rre` runs this study.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "core/warning.h"
#include "design/design.h"
#include "design/engine_facts.h"
#include "design/optical_model.h"
#include "raytrace/light/ledger.h"
#include "raytrace/paths/monte_carlo.h"
#include "studies/rre/adaptive_curve.h"
#include "studies/rre/derivatives.h"
#include "studies/rre/far_field.h"
#include "studies/rre/footprint.h"

namespace retrace::studies {

/// Default value of RreSettings::target_error, as a fraction of the incident power.
inline constexpr double kDefaultTargetError = 1e-4;
/// Maximum error of linear interpolation between automatically chosen incidences, as a fraction of the incident power.
/// It is used instead of target_error if target_error is smaller.
inline constexpr double kCurveTolerance = 1e-3;
/// Engine of a result to which several engines have contributed.
inline constexpr std::string_view kMixedEngines = "mixed";

/// Settings for the retroreflective efficiency over a grid of directions. resolve() makes them from a request
/// (studies/rre/rre_request.h) and checks the ranges.
struct RreSettings {
  std::vector<double> incidence_deg = {0.0};  ///< each in (-90, 90)
  /// Intervals in (-90, 90) in which further incidences are chosen automatically. They are chosen for each design on
  /// its own, and are the same for all azimuths of a design. Incidences are added until the error of linear
  /// interpolation between the points is at most target_error or kCurveTolerance, whichever is greater. All incidences
  /// of a design are then sorted in ascending order.
  std::vector<CurveSpan> incidence_spans;
  std::vector<double> azimuth_deg = {0.0};
  raytrace::Engine engine = raytrace::Engine::automatic;
  std::optional<std::uint64_t> rays;  ///< number of rays per point; none: rays are traced until target_error is reached
  /// Maximum standard error (Monte Carlo) or maximum truncated power (exact engine), as a fraction of the incident
  /// power. The default is kDefaultTargetError, half of kCurveTolerance if incidences are chosen automatically, or
  /// kCurveTolerance for maps. If the exact engine is requested by name or needed for other results, the default is
  /// 1e-10.
  std::optional<double> target_error;
  raytrace::Sampling::Kind sampling = raytrace::Sampling::Kind::stratified;  ///< `plain` uses Embree
  bool needs_plain_sampling() const { return sampling == raytrace::Sampling::Kind::plain; }
  /// Minimum power that is traced, as a fraction of the incident power. Default: 1e-10 (Monte Carlo), or the value that
  /// target_error requires (exact).
  std::optional<double> cutoff;
  std::uint32_t seed = 1;
  bool derivatives = false;  ///< exact engine: compute derivatives of RRE with respect to parameters of the design
  bool footprint = false;    ///< exact engine: compute the regions of the entrance face that return light
  bool far_field = false;    ///< exact engine: compute the directions in which light leaves the entrance face
  /// Trace a grid of directions for a polar map (studies/rre/rre_map.h). Directions that symmetries of a part map to
  /// each other are traced only one time.
  bool map = false;
};

/// Returns the target error of a request, or its default.
double target_error_of(const RreSettings& request);

/// RRE at one wavelength of a spectrum.
struct SpectralRre {
  double wavelength_nm = 0.0;
  double weight = 0.0;  ///< fraction of the flux that the wavelength represents
  double rre = 0.0;
  double std_error = 0.0;
  std::string engine;  ///< engine that was used
};

struct RrePoint {
  std::size_t design = 0;
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  double wavelength_nm = 0.0;  ///< centroid of the spectrum if the design has one
  double acceptance_half_angle_deg = 0.0;
  double rre = 0.0;
  double std_error = 0.0;  ///< error of random sampling only; light that was truncated may cause a further error
  /// Engine that was used: exact, stochastic, cell, embree or balls; kMixedEngines if wavelengths of a spectrum used
  /// several engines.
  std::string engine;
  raytrace::Stokes stokes;  ///< Stokes parameters of the retroreflected light, with respect to raytrace::source_axis()
  raytrace::Ledger ledger;
  std::uint64_t beams = 0;                      ///< exact and stochastic engine: number of beams traced for this point
  std::uint32_t depth = 0;                      ///< exact engine: number of interfaces on the longest path
  bool missed_target = false;                   ///< true: `std_error` is above the requested error at some wavelength
  std::vector<RreDerivative> derivatives = {};  ///< empty if they were not requested
  /// Values at the wavelengths of a spectrum. The values of the point are their means.
  std::vector<SpectralRre> by_wavelength = {};
};

/// Results for one direction that were requested in addition to RRE.
struct ReturnedLight {
  RrePoint at;  ///< point for the widest acceptance cone
  std::optional<Footprint> footprint;
  std::optional<FarField> far_field;
};

struct RreResult {
  std::vector<design::Design> designs;
  std::vector<std::vector<design::SpectralOptics>> light;  ///< traced wavelengths, for each design
  std::string engine = "none";  ///< engine that was used; "montecarlo" or "mixed" if there were several
  std::string engine_requested;
  std::uint32_t seed = 1;
  std::vector<RrePoint> points;  ///< sorted by design, wavelength, azimuth, incidence, acceptance cone
  /// Results for each direction, in the order of `points`. Empty unless footprints or far fields were requested.
  std::vector<ReturnedLight> returned;
  std::vector<EntranceFace> faces;    ///< entrance face of each design, if footprints were requested
  std::size_t traced_directions = 0;  ///< number of directions that were traced, for all designs together
  bool has_map = false;               ///< true: the request was for polar maps
  /// Returns true if the points are a complete grid for polar maps, see rre_maps().
  bool has_complete_maps() const { return has_map && complete; }
  std::uint64_t rays = 0;  ///< number of traced rays; rays of a direction that several results share are counted once
  double elapsed_s = 0.0;
  Warnings warnings;
  bool complete = true;
};

/// RRE study of designs. The constructor checks which combinations of settings and designs are supported; run()
/// computes the points.
class RreStudy {
 public:
  /// \throw InputError if the engine does not support a design or a requested result, or if a material is unknown
  RreStudy(std::vector<design::Design> designs, RreSettings request);
  ~RreStudy();

  /// Computes RRE of every design at every direction.
  /// \throw BudgetError if power is lost because a ray inside the part missed every face, or if too many beams are
  /// needed
  RreResult run(Progress* progress = nullptr, const Cancellation* cancel = nullptr) const;

  // The following functions are for tracing designs in several processes. They must not be used if incidences are
  // chosen automatically.

  /// Computes the points of one design.
  /// \throw BudgetError in the same cases as run()
  RreResult run_design(std::size_t design, const Cancellation* cancel) const;
  /// Returns the result that run() would return for given points of all designs. It contains only RRE and no other
  /// requested results.
  RreResult result_of(std::vector<RrePoint> points) const;

 private:
  RreResult begun() const;
  void finish(RreResult& result) const;
  RreResult run(std::optional<std::size_t> design, Progress* progress, const Cancellation* cancel) const;

  struct Prepared;
  std::unique_ptr<Prepared> prepared_;
};

}  // namespace retrace::studies
