#pragma once

// Coefficients of retroreflection at the test points of a standard, and the verdict. The study behind `retrace
// photometry`.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "materials/chromaticity.h"
#include "materials/spectrum.h"
#include "raytrace/observers/aperture_kernel.h"
#include "studies/design/design.h"
#include "studies/photometry/limits.h"
#include "studies/rre/rre.h"

namespace retrace::studies {

/// What a part is lit by.
enum class PhotometricLight {
  illuminant_a,    ///< CIE A, which the standards ask, seen by the eye
  illuminant_d65,  ///< CIE D65, seen by the eye
  of_design        ///< what the design's [light] says
};
/// "a", "d65" or "design"
std::string_view light_name(PhotometricLight light);
/// \throw InputError for a name that is none of them
PhotometricLight light_from_name(std::string_view name);

/// Default number of rays per direction of incidence.
inline constexpr std::uint64_t kUsualRaysOfDirection = std::uint64_t{1} << 20;

/// What is asked: the coefficients of retroreflection of a part at the test points of a standard.
struct PhotometryRequest {
  TestProgramme programme;
  std::string limits_source;                 ///< of the programme: a name or a file
  double area_cm2 = 0.0;                     ///< of the part, > 0; the design shows how it is made
  std::vector<double> rotation_deg = {0.0};  ///< epsilon; the least value over them counts
  raytrace::PhotometricApertures apertures;
  double window_deg = 2.0;  ///< half angle of the far field that is computed; 0.05 to 10
  PhotometricLight light = PhotometricLight::illuminant_a;
  std::string dye;                                 ///< what the dye is called; empty: none
  materials::SpectralCurve dye_absorption_per_mm;  ///< empty: none
  bool diffraction = true;
  Engine engine = Engine::automatic;  ///< neither stochastic nor cell
  std::optional<double> cutoff;       ///< least power of beams that are followed exactly, as a share of an element's
  std::optional<std::uint64_t> rays;  ///< Monte Carlo: number of rays per direction; empty: kUsualRaysOfDirection
  std::uint32_t seed = 1;
  bool pictures = false;      ///< maps and curves
  bool window_power = false;  ///< power in the window and outside of it, by integrations: a check that takes long
  bool advice = true;         ///< what to change if it fails
  bool colour = false;        ///< the chromaticity of the returned light; none of the design's own light
};

/// Returns a diameter in minutes of arc, rounded so that the errors of the conversion from radians disappear.
double arcmin_of(Angle diameter);

/// From best to worst: the worst of several decides.
enum class Verdict { pass, unconfirmed, undetermined, fail };
std::string_view verdict_name(Verdict verdict);
inline bool every_point_holds(Verdict verdict) {
  return verdict == Verdict::pass || verdict == Verdict::unconfirmed;
}

/// A test point and what was found there.
struct PhotometricPoint {
  TestPoint asked;
  double v_deg = 0.0;         ///< at which it was measured: that of the test point unless the face mirrors there
  double rotation_deg = 0.0;  ///< at which the value is least
  double r_i_mcd_per_lx = 0.0;
  double r_a = 0.0;                   ///< cd/(lx m^2)
  double r_l = 0.0;                   ///< cd/(lx m^2)
  double std_error_mcd_per_lx = 0.0;  ///< of rays, and of beams that are resampled
  double limit_mcd_per_lx = 0.0;
  bool lacks_diffraction = false;  ///< although it would count: the value says nothing against the limit
  bool is_lower_bound = false;     ///< the part reaches the value at least

  double margin() const { return r_i_mcd_per_lx / limit_mcd_per_lx - 1.0; }
  /// Pass, fail or undetermined: without diffraction that counts, and nearer to the limit than two standard errors.
  Verdict verdict() const;
};

/// One direction of incidence.
struct PhotometricDirection {
  double v_deg = 0.0, h_deg = 0.0, rotation_deg = 0.0;
  double incidence_deg = 0.0, azimuth_deg = 0.0;
  double rre = 0.0;        ///< geometric, of the design's widest cone; of the light that is weighed
  double std_error = 0.0;  ///< of it
  double truncated = 0.0;  ///< by how much it may be too low
  /// Power within the window and outside of it, through the entrance face, at one wavelength; nothing by Monte Carlo,
  /// or where cells are so large that it would take long.
  struct Split {
    double wavelength_nm = 0.0;
    double window = 0.0;
    double outside = 0.0;
    double geometric = 0.0;  ///< what both must add up to
  };
  std::optional<Split> split;
};

/// R_A around the return, for one direction of incidence.
struct FarFieldMap {
  double v_deg = 0.0;
  double h_deg = 0.0;
  double half_width_deg = 0.0;
  std::size_t columns = 0;  ///< and rows
  std::vector<double> r_a;  ///< row by row from below, as source and receiver see it
};

/// R_A over the observation angle at one entrance angle.
struct ObservationCurve {
  double entrance_deg = 0.0;  ///< beta2
  std::vector<double> observation_deg;
  std::vector<double> r_a;
};

/// A change of the design that passes, or comes nearest to it.
struct PhotometricChange {
  std::string key;  ///< of the design file
  double from = 0.0;
  double to = 0.0;
  std::vector<PhotometricPoint> points;  ///< the whole table again
  Verdict verdict = Verdict::fail;

  bool passes() const { return every_point_holds(verdict); }
};

/// A bound on the colour and how the returned light stands to it.
struct ColourPoint {
  ColourBoundary asked;
  double margin = 0.0;     ///< most - of_x x - of_y y: >= 0 holds
  double std_error = 0.0;  ///< of the margin
};

/// The colour of the light that comes back in one geometry: the one that is nearest to its boundaries, or farthest past
/// them, of those that are asked.
struct PhotometricColour {
  double observation_deg = 0.0;
  double v_deg = 0.0, h_deg = 0.0, rotation_deg = 0.0;
  std::optional<materials::Chromaticity> chromaticity;  ///< none if nothing comes back
  materials::Chromaticity std_error;                    ///< of x and of y
  std::vector<ColourPoint> boundaries;                  ///< none if the standard's are not known
  bool lacks_diffraction = false;                       ///< although it would count
  bool is_of_another_light = false;                     ///< than CIE A, which the boundaries are of
  std::string reason;                                   ///< why the verdict is undetermined; empty if it is not

  /// What the boundaries say together; nothing if there are none.
  std::optional<Verdict> verdict() const;
};

struct PhotometryResult {
  Design design;
  PhotometryRequest request;
  std::string engine;
  std::vector<double> wavelengths_nm;
  bool has_diffraction = true;
  std::vector<PhotometricPoint> points;
  std::vector<PhotometricPoint> measured;  ///< the same before lower bounds took the place of values
  /// Of each point all that its measured value is the least of: one for each V beside it and each turn of the part.
  std::vector<std::vector<PhotometricPoint>> readings;
  std::vector<PhotometricDirection> directions;
  Verdict verdict = Verdict::fail;
  std::string reason;                       ///< why points are undetermined; empty if none is
  std::optional<PhotometricColour> colour;  ///< has a verdict of its own
  std::optional<PhotometricChange>
      change;  ///< for a failing design: a change with which it passes, or else the best change tried
  std::vector<FarFieldMap> maps;
  std::vector<ObservationCurve> curves;
  double elapsed_s = 0.0;
  std::vector<std::string> warnings;
  bool complete = true;

  /// Every point and the area hold, and the colour is none that fails.
  bool passes() const { return every_point_holds(verdict) && !(colour && colour->verdict() == Verdict::fail); }
};

/// Approximate systematic error of preliminary readings, as a fraction of the value. The standard error does not
/// include it. It results from the small number of wavelengths and from weak beams, whose interference is ignored. If
/// the light of the design is used, the number of wavelengths is not reduced.
inline constexpr double kSystematicErrorOfFirstAnswer = 0.02;

/// Preliminary readings at the test points, from a much faster and less accurate computation.
struct PhotometricFirstAnswer {
  std::vector<PhotometricPoint> points;  ///< one for each test point; their verdicts must not be used
  std::vector<double> wavelengths_nm;
  bool lacks_diffraction = false;  ///< true if diffraction is omitted although the request includes it
};

/// What points say together: one that fails decides, then one that is undetermined. Points of recalled limits, and
/// programmes that are not complete, confirm nothing.
Verdict verdict_of(const std::vector<PhotometricPoint>& points, const TestProgramme& programme);

/// Whether a part is as small and as large as a programme asks: pass, unconfirmed if it holds a recalled limit, or
/// fail.
Verdict area_verdict(const TestProgramme& programme, double area_cm2);

/// A checked request, ready to run.
class PhotometryStudy {
 public:
  /// \throw InputError for numbers out of range, an observation angle outside the window, an unknown material
  PhotometryStudy(Design design, PhotometryRequest request);
  ~PhotometryStudy();

  /// Returns true if light is traced as beams, and false if it is traced as rays. If beam tracing needs too many beams,
  /// it may later be replaced by ray tracing.
  bool follows_beams() const;
  /// Returns the cut-off power of beams, as a fraction of the power that falls on one element. It is that of the
  /// request or the default.
  double cutoff() const;

  /// \throw BudgetError if power was lost
  PhotometryResult run(Progress* progress = nullptr, const Cancellation* cancel = nullptr) const;

  /// Computes preliminary readings with fewer wavelengths and either fewer rays or a higher cut-off power of beams. The
  /// call may run in parallel with run() and does not change the result of run(). Returns nothing if it was cancelled.
  /// \param ray_share number of rays divided by the number of rays of run(); > 0 and at most 1
  /// \throw BudgetError if the memory is not enough for both computations
  std::optional<PhotometricFirstAnswer> first_answer(double ray_share, const Cancellation* cancel = nullptr) const;

 private:
  struct Prepared;
  std::unique_ptr<Prepared> prepared_;
};

}  // namespace retrace::studies
