#include "studies/photometry/colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/task_progress.h"
#include "materials/io/spectrum_reader.h"

namespace retrace::studies {
namespace {

// Number of spans into which each colour matching function is divided, with two wavelengths each.
constexpr std::size_t kColourParts = 4;
// Distance to a boundary, in standard errors, below which a colour is undetermined.
constexpr double kErrorsOfAColour = 2.0;
// Difference between the seeds for consecutive colour matching functions (x, y, z). It is odd, so that all seeds are
// different.
constexpr std::uint32_t kSeedStep = 0x85ebca6bU;

/// Tristimulus values of the returned light in one geometry, and their standard errors.
struct MeasuredTristimulus {
  materials::Tristimulus values{};
  materials::Tristimulus errors{};
  bool lacks_diffraction = false;
};

/// Measures the tristimulus values in each geometry of `settings`, in their order. Returns nothing if the measurement
/// was cancelled.
std::optional<std::vector<MeasuredTristimulus>> measured_tristimulus(const design::Design& design,
                                                                     const PhotometrySettings& request,
                                                                     const Photometer& photometer,
                                                                     const std::vector<PhotometerSetting>& settings,
                                                                     Progress* progress, const Cancellation* cancel) {
  const materials::Tristimulus sent =
      materials::tristimulus(lamp_power(request.light), materials::shipped_colour_matching());
  std::vector<MeasuredTristimulus> measured(settings.size());
  for (std::size_t k = 0; k < sent.size(); ++k) {
    Photometer one(design, request_of_response(request, k), kColourParts, static_cast<PhotometricResponse>(k));
    if (!photometer.is_exact()) one.use_monte_carlo();
    const auto count = static_cast<double>(sent.size());
    PartProgress part(progress, static_cast<double>(k) / count, static_cast<double>(k + 1) / count);
    const auto readings = one.measure(settings, &part, cancel);
    if (!readings) return std::nullopt;
    for (std::size_t s = 0; s < settings.size(); ++s) {
      measured[s].values[k] = sent[k] * (*readings)[s].r_a.front();
      measured[s].errors[k] = sent[k] * (*readings)[s].r_a_error.front();
      measured[s].lacks_diffraction = measured[s].lacks_diffraction || (*readings)[s].lacks_diffraction;
    }
  }
  return measured;
}

/// Returns the standard error of m = of_x x + of_y y. The derivatives of m with respect to X, Y and Z are (of_x - m,
/// of_y - m, -m) / (X + Y + Z).
double error_of(double of_x, double of_y, const materials::Chromaticity& at, const MeasuredTristimulus& measured) {
  const double sum = measured.values[0] + measured.values[1] + measured.values[2];
  const double mean = of_x * at.x + of_y * at.y;
  return std::hypot((of_x - mean) * measured.errors[0], (of_y - mean) * measured.errors[1], mean * measured.errors[2]) /
         sum;
}

PhotometricColour colour_of(const PhotometerSetting& setting, const MeasuredTristimulus& measured,
                            const std::vector<ColourBoundary>& boundaries) {
  PhotometricColour colour;
  colour.observation_deg = setting.observation_deg.front();
  colour.v_deg = setting.v_deg;
  colour.h_deg = setting.h_deg;
  colour.rotation_deg = setting.rotation_deg;
  colour.lacks_diffraction = measured.lacks_diffraction;
  const bool is_dark = !(measured.values[0] + measured.values[1] + measured.values[2] > 0.0);
  if (!is_dark) {
    const materials::Chromaticity at = materials::chromaticity(measured.values);
    colour.chromaticity = at;
    colour.std_error = {error_of(1.0, 0.0, at, measured), error_of(0.0, 1.0, at, measured)};
    for (const ColourBoundary& b : boundaries)
      colour.boundaries.push_back({b, b.limit - b.x_coefficient * at.x - b.y_coefficient * at.y,
                                   error_of(b.x_coefficient, b.y_coefficient, at, measured)});
  } else {
    for (const ColourBoundary& b : boundaries) colour.boundaries.push_back({b, 0.0, 0.0});
  }
  return colour;
}

/// Returns the minimum of the margins to all boundaries.
double min_margin(const PhotometricColour& colour) {
  double least = std::numeric_limits<double>::infinity();
  for (const ColourPoint& point : colour.boundaries) least = std::min(least, point.margin);
  return least;
}

bool is_near(const ColourPoint& point) {
  return std::abs(point.margin) < kErrorsOfAColour * point.std_error;
}

/// Returns why the verdict on a colour is undetermined. Returns an empty reason for any other verdict.
UndeterminedReason reason_of(const PhotometricColour& colour, const Photometer& photometer) {
  using Cause = UndeterminedReason::Cause;
  if (colour.verdict() != Verdict::undetermined) return {};
  if (!colour.chromaticity) return {Cause::no_light, std::nullopt, "no light is returned in this direction"};
  if (colour.lacks_diffraction) {
    const NoDiffraction why = photometer.why_undiffracted();
    return {Cause::diffraction, why, fmt::format("diffraction is not included, because {}", text_of(why))};
  }
  if (colour.uses_other_illuminant)
    return {Cause::another_light, std::nullopt, "the colour boundaries are defined only for CIE illuminant A"};
  return {Cause::noise, std::nullopt,
          "the colour is within two standard errors of a boundary: " + photometer.remedy_for_noise()};
}

}  // namespace

PhotometrySettings request_of_response(const PhotometrySettings& request, std::size_t response) {
  PhotometrySettings one = request;
  one.rays = std::max<std::uint64_t>(1, request.rays.value_or(kDefaultRaysPerDirection) / 3);
  one.seed = request.seed + kSeedStep * static_cast<std::uint32_t>(response + 1);
  return one;
}

std::optional<Verdict> PhotometricColour::verdict() const {
  if (boundaries.empty()) return std::nullopt;
  const auto any = [&](const auto& holds) { return std::any_of(boundaries.begin(), boundaries.end(), holds); };
  if (!chromaticity || lacks_diffraction || uses_other_illuminant) return Verdict::undetermined;
  if (any([](const ColourPoint& p) { return p.margin < 0.0 && !is_near(p); })) return Verdict::fail;
  if (any(is_near)) return Verdict::undetermined;
  const bool is_recalled = any([](const ColourPoint& p) { return p.boundary.status == LimitStatus::recalled; });
  return is_recalled ? Verdict::unconfirmed : Verdict::pass;
}

std::optional<PhotometricColour> measured_colour(const design::Design& design, const PhotometrySettings& request,
                                                 const Photometer& photometer, const std::vector<double>& v_deg,
                                                 Progress* progress, const Cancellation* cancel) {
  const std::vector<ColourBoundary>& boundaries = request.test_plan.boundaries;
  const TestPoint& first = request.test_plan.points.front();
  const double observation_deg = boundaries.empty() ? first.observation_deg : boundaries.front().observation_deg;
  const double h_deg = boundaries.empty() ? first.h_deg : boundaries.front().h_deg;
  std::vector<PhotometerSetting> settings;
  for (const double v : v_deg)
    for (const double rotation_deg : request.rotation_deg)
      settings.push_back({v, h_deg, rotation_deg, {observation_deg}, 0, false});
  const auto measured = measured_tristimulus(design, request, photometer, settings, progress, cancel);
  if (!measured) return std::nullopt;
  std::optional<PhotometricColour> worst;
  for (std::size_t s = 0; s < settings.size(); ++s) {
    PhotometricColour colour = colour_of(settings[s], (*measured)[s], boundaries);
    colour.uses_other_illuminant = request.light != PhotometricLight::illuminant_a;
    if (!worst || min_margin(colour) < min_margin(*worst)) worst = std::move(colour);
  }
  worst->reason = reason_of(*worst, photometer);
  return worst;
}

}  // namespace retrace::studies
