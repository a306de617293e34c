#pragma once

// Retroreflective efficiency of designs over directions of the light, and where all other power goes. The study behind
// `retrace rre`.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "raytrace/light/ledger.h"
#include "raytrace/paths/monte_carlo.h"
#include "studies/design/design.h"
#include "studies/design/optical_model.h"
#include "studies/rre/adaptive_curve.h"
#include "studies/rre/derivatives.h"
#include "studies/rre/far_field.h"
#include "studies/rre/footprint.h"

namespace retrace::studies {

/// The tracer of a request. `automatic` is that of `exact`, `stochastic` and `montecarlo` which is expected to reach
/// the target error first, for each direction and wavelength; `montecarlo` is `cell` where that serves, else `embree`.
enum class Engine { automatic, exact, stochastic, montecarlo, cell, embree };

/// \throw InputError listing the engines for a name that is none of them
Engine engine_from_name(std::string_view name);
/// \throw InputError likewise
raytrace::Sampling::Kind sampling_from_name(std::string_view name);
std::string_view engine_name(Engine engine);

/// Engines of RRE (retroreflective efficiency) that trace rays. A request may give a number of rays only with them.
inline constexpr Engine kRayEngines[] = {Engine::automatic, Engine::montecarlo, Engine::cell, Engine::embree};
/// Engines of photometry and pictures that trace rays.
inline constexpr Engine kRayEnginesOfParts[] = {Engine::automatic, Engine::montecarlo, Engine::embree};
/// Engines that may trace all light as beams.
inline constexpr Engine kExactEngines[] = {Engine::exact, Engine::automatic};
/// Engines of RRE that stop following light below a cut-off power.
inline constexpr Engine kCutoffEngines[] = {Engine::automatic, Engine::exact, Engine::montecarlo, Engine::cell,
                                            Engine::embree};
/// Engines of RRE that use a target error, even if the request also gives a cut-off power.
inline constexpr Engine kTargetEngines[] = {Engine::automatic, Engine::stochastic, Engine::montecarlo, Engine::cell,
                                            Engine::embree};
/// Returns true if `engine` is one of `engines`.
bool is_one_of(Engine engine, std::span<const Engine> engines);
/// Refuses an option that is given although it has no effect with the requested engine.
/// \param engines engines with which the option has an effect
/// \throw InputError at `option`
void check_has_effect(const char* option, bool is_given, Engine engine, std::span<const Engine> engines);

/// Of a share of power. \throw InputError at `option` unless it lies between 0 and 1
void check_share(double value, bool zero_allowed, const char* option);

/// Default of RreRequest::target_error, of RRE as a fraction.
inline constexpr double kUsualTargetError = 1e-4;
/// Of RRE as a fraction: how far straight lines between chosen incidences may miss it, if target_error is less.
inline constexpr double kCurveTolerance = 1e-3;
/// The engine of what several have found.
inline constexpr std::string_view kMixedEngines = "mixed";

/// A request for retroreflective efficiency over a grid of directions.
struct RreRequest {
  std::vector<double> incidence_deg = {0.0};  ///< each in (-90, 90)
  /// Pieces in (-90, 90) over which incidences are chosen besides, the same for all designs and azimuths, until
  /// straight lines between the points are within target_error or kCurveTolerance; those requested then come in
  /// ascending order.
  std::vector<CurveSpan> incidence_spans;
  std::vector<double> azimuth_deg = {0.0};
  Engine engine = Engine::automatic;
  std::optional<std::uint64_t> rays;  ///< per point; else until target_error is reached
  /// Of RRE as a fraction: the standard error of Monte Carlo, and the power that the exact engine may leave in
  /// `truncated`. By default kUsualTargetError, or half of kCurveTolerance where incidences are chosen; 1e-10 where the
  /// exact engine is requested by name, or what only it can tell.
  std::optional<double> target_error;
  raytrace::Sampling::Kind sampling = raytrace::Sampling::Kind::stratified;  ///< plain: on Embree
  /// Least power followed, as a share of the incident. By default 1e-10 (Monte Carlo), or as little as target_error
  /// takes (exact).
  std::optional<double> cutoff;
  std::uint32_t seed = 1;
  bool derivatives = false;  ///< exact engine: of RRE by the parameters of the design
  bool footprint = false;    ///< exact engine: which regions of the entrance face send light back
  bool far_field = false;    ///< exact engine: the directions in which light leaves the entrance face
};

/// The target error, or what stands in its place where none is given.
double target_error_of(const RreRequest& request);

/// RRE at one of the wavelengths of a spectrum.
struct SpectralRre {
  double wavelength_nm = 0.0;
  double weight = 0.0;  ///< share of the flux that it stands for
  double rre = 0.0;
  double std_error = 0.0;
  std::string engine;  ///< that ran
};

struct RrePoint {
  std::size_t design = 0;
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  double wavelength_nm = 0.0;  ///< of a spectrum: its centroid
  double acceptance_half_angle_deg = 0.0;
  double rre = 0.0;
  double std_error = 0.0;  ///< of sampling alone: what `truncated` may add to `rre` is apart
  std::string engine;  ///< exact, stochastic, cell, embree or balls; of a spectrum kMixedEngines if wavelengths took
                       ///< different ones
  raytrace::Stokes stokes;  ///< of what is retroreflected, along raytrace::source_axis()
  raytrace::Ledger ledger;
  std::uint64_t beams = 0;                      ///< exact and stochastic engine: followed for this point
  std::uint32_t depth = 0;                      ///< exact engine: interfaces on the longest path
  bool missed_target = false;                   ///< `std_error` stayed above what was asked for at some wavelength
  std::vector<RreDerivative> derivatives = {};  ///< if they were requested
  std::vector<SpectralRre> by_wavelength = {};  ///< designs with a spectrum: what the point is the mean of
};

/// What was requested beyond RRE, for one direction.
struct ReturnedLight {
  RrePoint at;  ///< of the widest acceptance cone
  std::optional<Footprint> footprint;
  std::optional<FarField> far_field;
};

struct RreResult {
  std::vector<Design> designs;
  std::vector<std::vector<SpectralOptics>> light;  ///< by design: the wavelengths that were traced
  std::string engine = "none";                     ///< that ran; if several did: montecarlo, or mixed with exact
  std::string engine_requested;
  std::uint32_t seed = 1;
  std::vector<RrePoint> points;         ///< in the order design, wavelength, azimuth, incidence, acceptance
  std::vector<ReturnedLight> returned;  ///< one a direction, in the same order, if a footprint or far field was asked
  std::vector<EntranceFace> faces;      ///< one a design, if a footprint was asked
  std::uint64_t rays = 0;
  double elapsed_s = 0.0;
  std::vector<std::string> warnings;
  bool complete = true;
};

/// A checked request, ready to run: everything that can be wrong with the input has been found once this exists.
class RreStudy {
 public:
  /// \throw InputError for an engine that this version lacks, a direction out of range, an unknown material
  RreStudy(std::vector<Design> designs, RreRequest request);
  ~RreStudy();

  /// RRE of every design at every direction. \throw BudgetError if power was lost, or too many beams are needed
  RreResult run(Progress* progress = nullptr, const Cancellation* cancel = nullptr) const;

  // For who has designs traced by several processes. \pre no incidences are to be chosen

  /// The points of one of the designs alone. \throw BudgetError as run()
  RreResult run_design(std::size_t design, const Cancellation* cancel) const;
  /// What run() tells of the points of all designs, but for what was requested beyond RRE.
  RreResult result_of(std::vector<RrePoint> points) const;

 private:
  RreResult begun() const;
  void finish(RreResult& result) const;
  RreResult run(std::optional<std::size_t> design, Progress* progress, const Cancellation* cancel) const;

  struct Prepared;
  std::unique_ptr<Prepared> prepared_;
};

}  // namespace retrace::studies
