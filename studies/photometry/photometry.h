#pragma once

// Coefficients of retroreflection at the test points of a standard, and the verdict. The command `retrace photometry`
// runs this study.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/progress.h"
#include "core/warning.h"
#include "design/design.h"
#include "design/engine_facts.h"
#include "materials/chromaticity.h"
#include "materials/spectrum.h"
#include "raytrace/light/aperture_kernel.h"
#include "studies/photometry/limits.h"

namespace retrace::studies {

/// Light that illuminates the part.
enum class PhotometricLight {
  illuminant_a,    ///< CIE A, as required by the standards, with the response of the eye
  illuminant_d65,  ///< CIE D65, with the response of the eye
  of_design        ///< light of the design's table [light]
};
/// Returns the name of the light: "a", "d65" or "design".
std::string_view light_name(PhotometricLight light);
/// Returns the light whose light_name() is `name`.
/// \throw InputError at the field `light` for an unknown name
PhotometricLight light_from_name(std::string_view name);

/// Default number of rays per direction of incidence.
inline constexpr std::uint64_t kDefaultRaysPerDirection = std::uint64_t{1} << 20;

/// Angles of a map of R_A over entrance and observation angle. Each list is in ascending order.
struct CoefficientGrid {
  std::vector<double> entrance_deg;     ///< in [-85, 85]; at least 2
  std::vector<double> observation_deg;  ///< inside the window of the far field; at least 2
  /// Presentation angles, in [-180, 180]. There is one map for each of them.
  std::vector<double> presentation_deg;
};

/// Design whose map is compared with that of the design of the study.
struct ComparedDesign {
  design::Design design;
  std::string dye;                                 ///< name of the dye of this design; empty: no dye
  materials::SpectralCurve dye_absorption_per_mm;  ///< absorption of this dye; empty: no dye
};

/// Settings of the study. resolve() in io/standard_reader.h makes them from a PhotometryRequest and reads the files of
/// the standard and of the dye.
struct PhotometrySettings {
  TestPlan test_plan;
  std::string limits_source;  ///< origin of the limits: the name of a standard or a file
  /// Area of the real part, to which R_I refers; > 0. The design defines only the structure of the part.
  double area_cm2 = 0.0;
  std::vector<double> rotation_deg = {0.0};  ///< rotations epsilon of the part; the minimum reading over them counts
  raytrace::PhotometricApertures apertures;
  double window_deg = 2.0;  ///< half-angle of the computed far field
  PhotometricLight light = PhotometricLight::illuminant_a;
  std::string dye;                                 ///< name of the dye; empty: no dye
  materials::SpectralCurve dye_absorption_per_mm;  ///< absorption of the dye; empty: no dye
  bool diffraction = true;
  raytrace::Engine engine = raytrace::Engine::automatic;  ///< any engine except stochastic and cell
  /// Minimum power of beams that are traced exactly, as a fraction of the power on one element.
  std::optional<double> cutoff;
  std::optional<std::uint64_t> rays;  ///< Monte Carlo: number of rays per direction; empty: kDefaultRaysPerDirection
  std::uint32_t seed = 1;
  bool pictures = false;  ///< true: maps and curves are computed
  /// Angles of a map of R_A over entrance and observation angle; empty: no such map. There is one map for each rotation
  /// and each presentation angle.
  std::optional<CoefficientGrid> map_grid;
  std::optional<ComparedDesign> compared;  ///< second design for which maps are computed; only together with map_grid
  /// True: the power in directions inside and outside of the window (see window_deg) is integrated. This check is slow.
  bool window_power = false;
  bool advice = true;   ///< true: if the design fails, the study searches for a change with which it passes
  bool colour = false;  ///< true: compute the chromaticity; not with PhotometricLight::of_design
};

/// Returns a diameter in minutes of arc, rounded so that the errors of the conversion from radians disappear.
double arcmin_of(Angle diameter);

/// Verdict on a reading, in order from best to worst. The worst of several verdicts counts.
enum class Verdict { pass, unconfirmed, undetermined, fail };
std::string_view verdict_name(Verdict verdict);
inline bool every_point_holds(Verdict verdict) {
  return verdict == Verdict::pass || verdict == Verdict::unconfirmed;
}

/// Test point with its reading.
struct PhotometricPoint {
  TestPoint test_point;
  /// Angle V of the measurement. It differs from V of the test point if the entrance face reflects the lamp back to the
  /// lamp there.
  double v_deg = 0.0;
  double rotation_deg = 0.0;  ///< rotation at which the reading is minimal
  double r_i_mcd_per_lx = 0.0;
  double r_a = 0.0;                   ///< cd/(lx m^2)
  double r_l = 0.0;                   ///< cd/(lx m^2)
  double std_error_mcd_per_lx = 0.0;  ///< standard error of ray tracing or of resampled beams
  double limit_mcd_per_lx = 0.0;
  /// True: the reading lacks significant diffraction and can therefore not be compared with the limit.
  bool lacks_diffraction = false;
  bool is_lower_bound = false;  ///< true: the value is a lower bound

  double margin() const { return r_i_mcd_per_lx / limit_mcd_per_lx - 1.0; }
  /// Returns pass, fail or undetermined. A reading is undetermined if it lacks significant diffraction, or if it is
  /// within two standard errors of the limit.
  Verdict verdict() const;
};

/// Result for one direction of incidence.
struct PhotometricDirection {
  double v_deg = 0.0, h_deg = 0.0, rotation_deg = 0.0;
  double incidence_deg = 0.0, azimuth_deg = 0.0;
  /// RRE for the design's widest acceptance cone, without diffraction, at the wavelengths of the photometer.
  double rre = 0.0;
  double std_error = 0.0;  ///< standard error of the RRE
  double truncated = 0.0;  ///< maximum power that the RRE may lack because weak beams were truncated
  /// Power that leaves the entrance face in directions inside and outside of the window (cone with the half-angle
  /// window_deg), at one wavelength. It is not computed by Monte Carlo. It is also not computed for large cells,
  /// because this would take too long.
  struct Split {
    double wavelength_nm = 0.0;
    double window = 0.0;
    double outside = 0.0;
    double geometric = 0.0;  ///< power without diffraction; the sum of `window` and `outside` must be equal to it
  };
  std::optional<Split> split;
};

/// Map of R_A around the direction back to the source, for one direction of incidence.
struct FarFieldMap {
  double v_deg = 0.0;
  double h_deg = 0.0;
  double half_width_deg = 0.0;
  std::size_t columns = 0;  ///< number of columns, and of rows
  std::vector<double> r_a;  ///< values as seen from the source, row by row, bottom row first
};

/// Coefficient of retroreflection R_A of one design over entrance and observation angle, at one rotation of the part
/// and one presentation angle.
struct CoefficientMap {
  std::size_t design = 0;  ///< 0: design of the study; 1: PhotometrySettings::compared
  double rotation_deg = 0.0;
  double presentation_deg = 0.0;
  std::vector<double> entrance_deg;     ///< ascending
  std::vector<double> observation_deg;  ///< ascending
  /// R_A in cd/(lx m^2): all observation angles of the first entrance angle, then of the next one.
  std::vector<double> r_a;
  std::vector<double> std_error;   ///< standard errors of `r_a`, in the same order
  bool lacks_diffraction = false;  ///< true: diffraction is significant but not included

  std::size_t index(std::size_t entrance, std::size_t observation) const {
    return entrance * observation_deg.size() + observation;
  }
  /// Arranges values of the map by angles, with the indices [entrance][observation].
  /// \param values `r_a` or `std_error`
  std::vector<std::vector<double>> rows(const std::vector<double>& values) const;
};

/// Curve of R_A over the observation angle, for one entrance angle.
struct ObservationCurve {
  double entrance_deg = 0.0;  ///< angle beta2
  std::vector<double> observation_deg;
  std::vector<double> r_a;
};

/// Change of one parameter with which a failing design passes. If no change is sufficient, this is the best of the
/// changes that were tried.
struct PhotometricChange {
  std::string key;  ///< key of the design file
  double from = 0.0;
  double to = 0.0;
  std::vector<PhotometricPoint> points;  ///< readings of the changed design at all test points
  Verdict verdict = Verdict::fail;

  bool passes() const { return every_point_holds(verdict); }
};

/// Properties of the tangent-plane model of a curved entrance surface (docs/theory/fronts.md): the number of traced
/// elements, and the differences between the model and rays refracted at the exact surface.
struct EntranceModel {
  std::size_t elements = 0;           ///< number of elements of the part that receive light
  std::size_t traced_elements = 0;    ///< number of traced elements; the others are interpolated
  double path_rms_waves = 0.0;        ///< root mean square difference of optical paths, in wavelengths
  double angle_rms_arcmin = 0.0;      ///< root mean square angle between light of the model and rays
  double max_angle_arcmin = 0.0;      ///< maximum angle between light of the model and rays
  double allowed_angle_arcmin = 0.0;  ///< if `max_angle_arcmin` is larger, diffraction is left out
};

/// Reasons, other than obstacles of the exact engine, why photometric readings do not include diffraction.
enum class Undiffracted {
  not_requested,
  unequal_cells,     ///< the cells of the part differ too much from each other
  strong_curvature,  ///< the entrance surface deviates too much from its tangent planes within an element
  too_many_beams,    ///< the exact engine exceeds its budget of beams
  shells,            ///< the part is behind shells, and cameras trace shells by rays
  monte_carlo        ///< the request selects Monte Carlo, which traces rays without phases
};
/// Reason why photometric readings do not include diffraction.
using NoDiffraction = std::variant<Undiffracted, raytrace::Obstacle>;
/// Returns the reason as a clause for use in messages, such as "balls are traced by rays".
std::string text_of(const NoDiffraction& reason);

/// Reason of an undetermined verdict.
struct UndeterminedReason {
  enum class Cause {
    none,           ///< there is no reason, because the verdict is determined
    noise,          ///< a value is within two standard errors of its limit
    diffraction,    ///< diffraction is significant, but the result does not include it
    no_light,       ///< no light returns in the measured geometry
    another_light,  ///< the limits are defined for CIE A, but the study uses another light
  };
  Cause cause = Cause::none;
  std::optional<NoDiffraction> no_diffraction;  ///< set only if `cause` is `diffraction`
  std::string text;                             ///< message for the user, one line; empty if the verdict is determined
};

/// Boundary of the allowed colours, and distance of the returned light's colour from it.
struct ColourPoint {
  ColourBoundary boundary;
  double margin = 0.0;     ///< limit - x_coefficient * x - y_coefficient * y; >= 0 if the boundary is satisfied
  double std_error = 0.0;  ///< standard error of the margin
};

/// Colour of the returned light. If it is measured in several geometries, this is the colour with the smallest margin
/// to its boundaries.
struct PhotometricColour {
  double observation_deg = 0.0;
  double v_deg = 0.0, h_deg = 0.0, rotation_deg = 0.0;
  std::optional<materials::Chromaticity> chromaticity;  ///< none if no light returns
  materials::Chromaticity std_error;                    ///< standard errors of x and y
  std::vector<ColourPoint> boundaries;                  ///< empty if the boundaries of the standard are not known
  /// True: diffraction is significant but not included in the result.
  bool lacks_diffraction = false;
  bool uses_other_illuminant = false;  ///< true: the light is not CIE A, for which the boundaries are defined
  UndeterminedReason reason;

  /// Returns the verdict on all boundaries. Returns nothing if there are no boundaries.
  std::optional<Verdict> verdict() const;
};

struct PhotometryResult {
  design::Design design;
  PhotometrySettings request;
  std::string engine;
  std::vector<double> wavelengths_nm;
  bool has_diffraction = true;
  /// Model of a curved entrance surface, with the largest deviation from this surface over all readings. Empty if the
  /// entrance face is plane or if rays are traced.
  std::optional<EntranceModel> entrance_model;
  std::vector<PhotometricPoint> points;
  std::vector<PhotometricPoint> measured;  ///< readings at the test points, before lower bounds replaced some of them
  /// All readings of each test point, one for each measured angle V and each rotation of the part. Their minimum is the
  /// value in `measured`.
  std::vector<std::vector<PhotometricPoint>> readings;
  std::vector<PhotometricDirection> directions;
  Verdict verdict = Verdict::fail;
  UndeterminedReason reason;                ///< reason why points are undetermined; empty if all are determined
  std::optional<PhotometricColour> colour;  ///< colour with its own verdict
  /// Proposed change of a failing design: one with which the design passes, or else the best one that was tried.
  std::optional<PhotometricChange> change;
  std::vector<FarFieldMap> maps;
  std::vector<ObservationCurve> curves;
  /// Maps over entrance and observation angle, by design, rotation and presentation angle. Empty if they were not
  /// requested, or if the run was cancelled before all of them were finished.
  std::vector<CoefficientMap> coefficient_maps;
  std::size_t map_directions = 0;         ///< number of directions of light of all maps
  std::size_t traced_map_directions = 0;  ///< number of traced directions; equivalent ones count once
  double elapsed_s = 0.0;
  Warnings warnings;
  bool complete = true;

  /// Returns the designs of the coefficient maps: the design of the study and, if there is one, the compared design.
  std::vector<design::Design> map_designs() const;
  /// Returns true if the limits of the standard are limits of R_I instead of R_A.
  bool limits_are_r_i() const;
  /// Returns true if every point and the area satisfy their limits, and if the colour does not fail.
  bool passes() const { return every_point_holds(verdict) && !(colour && colour->verdict() == Verdict::fail); }
};

/// Approximate systematic error of preliminary readings, as a fraction of the value. It is not part of the standard
/// error. It results from the small number of wavelengths and from weak beams, whose interference is ignored. With the
/// design's own light, the number of wavelengths is not reduced.
inline constexpr double kSystematicErrorOfFirstAnswer = 0.02;

/// Preliminary readings at the test points, from a much faster and less accurate computation.
struct PhotometricFirstAnswer {
  std::vector<PhotometricPoint> points;  ///< one reading for each test point; verdicts of these points must not be used
  std::vector<double> wavelengths_nm;
  bool lacks_diffraction = false;  ///< true if diffraction is omitted although the request includes it
};

/// Returns the common verdict of several points. It is `fail` if any point fails, otherwise `undetermined` if any point
/// is undetermined. If limits are unconfirmed or the test plan is incomplete, the verdict is at most `unconfirmed`.
Verdict verdict_of(const std::vector<PhotometricPoint>& points, const TestPlan& test_plan);

/// Compares the area of a part with the limits of a test plan. Returns pass, fail, or `unconfirmed` if the part
/// satisfies a limit that is unconfirmed.
Verdict area_verdict(const TestPlan& test_plan, double area_cm2);

/// Photometric study of a design. The constructor checks the settings, and run() computes the readings.
class PhotometryStudy {
 public:
  /// \throw InputError if an observation angle is outside the window, if the apertures of source and receiver are
  /// points, if the engine does not support the design, or if a material is unknown
  /// \pre All settings except the engine and the cut-off are in the ranges of the fields of PhotometryRequest. The
  /// constructor checks the engine and the cut-off itself.
  PhotometryStudy(design::Design design, PhotometrySettings settings);
  ~PhotometryStudy();

  /// Returns true if light is traced as beams, and false if it is traced as rays. If beam tracing needs too many beams,
  /// it may later be replaced by ray tracing.
  bool uses_beams() const;
  /// Returns the cut-off power of beams, as a fraction of the power that falls on one element. It is the value in the
  /// request, or the default value.
  double cutoff() const;

  /// Computes the readings.
  /// \throw BudgetError if power is lost because a ray inside the part missed every face, or if a budget is exhausted
  PhotometryResult run(Progress* progress = nullptr, const Cancellation* cancel = nullptr) const;

  /// Computes preliminary readings with fewer wavelengths and either fewer rays or a higher cut-off power of beams. The
  /// call may run in parallel with run() and does not change the result of run(). Returns nothing if the computation
  /// was cancelled.
  /// \param ray_fraction number of rays divided by the number of rays of run(); > 0 and at most 1
  /// \throw BudgetError if the memory is not enough for both computations
  std::optional<PhotometricFirstAnswer> first_answer(double ray_fraction, const Cancellation* cancel = nullptr) const;

 private:
  struct Prepared;
  std::unique_ptr<Prepared> prepared_;
};

}  // namespace retrace::studies
