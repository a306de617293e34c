#include "studies/closed_loop/as_machined.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/error.h"
#include "core/number_format.h"
#include "core/toml_file.h"
#include "studies/design/design_reader.h"

namespace retrace::studies {
namespace {

namespace fs = std::filesystem;
using namespace fabrication;

constexpr double kArcminPerRad = 180.0 * 60.0 / std::numbers::pi;

// Sa of facets by the motion that made them, in nm: Hamilton et al. (2017), Figure 15, for roughing; mean of five
// facets finished by plunging in Milliken (2017), Table 3.4.
constexpr double kPloughSaNm = 468.19;
constexpr double kRoughPlungeSaNm = 114.55;
constexpr double kFinishPlungeSaNm = 48.9;
// Of those five facets the roughness below an 80 um cut-off has a mean Sa of 19.7 nm, the waviness above of 29.9 nm.
constexpr double kRoughnessShare = 19.7 / 48.9;
constexpr double kWavinessShare = 29.9 / 48.9;
// Oscillation across the feed: 42.4 per mm at 10 mm/min (Milliken, 3.3.5), so 7.07 Hz.
constexpr double kFeedMarksHz = 7.07;
constexpr double kCorrelationLengthUm = 5.0;                // assumed: the profilometer resolved no less
const double kSqPerSa = std::sqrt(0.5 * std::numbers::pi);  // of Gaussian heights

double sa_of(const Job& job) {
  switch (job.strategy) {
    case Strategy::unidirectional:
      return std::sqrt(0.5 * (kPloughSaNm * kPloughSaNm + kRoughPlungeSaNm * kRoughPlungeSaNm));
    case Strategy::bidirectional:
      return kRoughPlungeSaNm;
    case Strategy::two_step:
      return kFinishPlungeSaNm;
  }
  return 0.0;
}

/// [body] of the design that the job was made from, if it lies beside the job.
std::string body_of(const VerificationRun& run, std::vector<std::string>& warnings) {
  const fs::path file = fs::path(run.request.job).parent_path() / run.job.design;
  std::error_code error;
  if (!run.job.design.empty() && fs::is_regular_file(file, error)) {
    const Design design = read_design(file);
    std::string body = fmt::format("thickness_mm = {}\n", shortest(design.part.thickness_mm));
    if (design.refractive_index)
      body += fmt::format("refractive_index = {}\n", shortest(*design.refractive_index));
    else
      body += fmt::format("material = {}\n", toml_text(design.material));
    if (design.absorption_per_mm) body += fmt::format("absorption_per_mm = {}\n", shortest(*design.absorption_per_mm));
    return body;
  }
  warnings.push_back("the job's design is not beside it: the as-machined part is given a plate of 2 mm of PMMA");
  return "thickness_mm = 2\nmaterial = \"PMMA\"\n";
}

std::string_view arrangement_word(geometry::Arrangement arrangement) {
  switch (arrangement) {
    case geometry::Arrangement::aligned:
      return "aligned";
    case geometry::Arrangement::offset:
      return "offset";
    case geometry::Arrangement::checker:
      return "checker";
    default:
      return "single";
  }
}

std::string array_text(const Job& job) {
  const Array& a = job.array;
  std::string text = fmt::format("arrangement = \"{}\"\n", arrangement_word(a.arrangement));
  if (a.arrangement == geometry::Arrangement::single) return text;
  text += fmt::format("x_length_mm = {}\ny_length_mm = {}\n", shortest(a.x_length_mm), shortest(a.y_length_mm));
  const auto put = [&](const char* key, double value) {
    if (value != 0.0) text += fmt::format("{} = {}\n", key, shortest(value));
  };
  put("x_gap_mm", a.x_gap_mm);
  put("y_gap_mm", a.y_gap_mm);
  put("x_offset_mm", a.x_offset_mm);
  put("y_offset_mm", a.y_offset_mm);
  if (a.arrangement == geometry::Arrangement::offset)
    text += fmt::format("overlap_percent = {}\nshifted_rows = \"{}\"\npartial_elements = \"omit\"\n",
                        shortest(a.overlap_percent), a.shifted_rows == geometry::RowParity::odd ? "odd" : "even");
  return text;
}

}  // namespace

PredictedTexture predicted_texture(const Job& job) {
  PredictedTexture texture;
  texture.sa_nm = sa_of(job);
  texture.roughness_sq_nm = kRoughnessShare * texture.sa_nm * kSqPerSa;
  texture.waviness_sq_nm = kWavinessShare * texture.sa_nm * kSqPerSa;
  texture.correlation_length_um = kCorrelationLengthUm;
  const double feed_mm_per_min =
      job.strategy == Strategy::two_step ? job.process.finishing_feed_mm_per_min : job.process.roughing_feed_mm_per_min;
  texture.waviness_length_um = 1e3 * feed_mm_per_min / 60.0 / kFeedMarksHz;
  return texture;
}

AsMachined as_machined(const VerificationRun& run) {
  AsMachined part;
  double worst_along_arcmin = 0.0;
  double spread_arcmin = 0.0;
  std::int64_t cut = 0;
  std::vector<std::array<double, 2>> tilts;
  for (const ElementResult& element : run.result.elements) {
    if (!element.figures.is_cut) continue;
    ++cut;
    std::array<double, 2> tilt{};
    for (std::size_t f = 0; f < 2; ++f) {
      // A facet that rises above the design up its slope leans into the groove and closes it.
      tilt[f] = -std::atan(element.figures.facets[f].slope_up) * kArcminPerRad;
      part.facet_tilt_arcmin[f] += tilt[f];
      worst_along_arcmin =
          std::max(worst_along_arcmin, std::abs(std::atan(element.figures.facets[f].slope_along)) * kArcminPerRad);
    }
    tilts.push_back(tilt);
  }
  if (cut == 0) throw InputError({"", 0, "--as-machined"}, "the programs cut no element of the job");
  for (double& tilt : part.facet_tilt_arcmin) tilt /= static_cast<double>(cut);
  for (const auto& tilt : tilts)
    for (std::size_t f = 0; f < 2; ++f)
      spread_arcmin = std::max(spread_arcmin, std::abs(tilt[f] - part.facet_tilt_arcmin[f]));
  // Facet 1 lies at -x of a moulded part; a blank that is cut directly is turned about y.
  if (run.job.workpiece.kind == WorkpieceKind::direct) std::swap(part.facet_tilt_arcmin[0], part.facet_tilt_arcmin[1]);
  constexpr double shown_arcmin = 0.05;
  if (worst_along_arcmin > shown_arcmin)
    part.warnings.push_back(
        fmt::format("facets are turned by up to {} arcmin along the root, which a design cannot say: "
                    "it is left out",
                    fixed(worst_along_arcmin, 2)));
  if (spread_arcmin > shown_arcmin)
    part.warnings.push_back(
        fmt::format("facets of single elements differ from the mean by up to {} arcmin", fixed(spread_arcmin, 2)));
  const auto missing = static_cast<std::int64_t>(run.result.elements.size()) - cut;
  if (missing > 0 || !run.job.array.pattern.empty())
    part.warnings.push_back("elements that are not cut are there in the as-machined design");
  part.root_radius_um = run.result.root_radius_um;
  part.texture = predicted_texture(run.job);
  part.body = body_of(run, part.warnings);
  return part;
}

std::string as_machined_toml(const VerificationRun& run, const AsMachined& part) {
  const auto nonzero = [](double v) { return std::abs(v) < 1e-6 ? 0.0 : v; };
  std::string text = "schema = \"retrace.design/1\"\n";
  text += fmt::format("title = {}\n", toml_text((run.job.title.empty() ? "Part" : run.job.title) + ", as machined"));
  text += fmt::format("\n[element]\nkind = \"rtp\"\nbase_mm = {}\nwidth_mm = {}\napex_angle_deg = {}\n",
                      shortest(run.job.element.base_mm), shortest(run.job.element.width_mm),
                      shortest(run.job.element.apex_angle_deg));
  text += "\n[array]\n" + array_text(run.job);
  text += "\n[body]\n" + part.body;
  text += fmt::format(
      "\n# Facets as the programs leave them; the mean over the elements.\n[surface]\n"
      "facet_tilt_arcmin = [{}, {}]\n",
      shortest(nonzero(part.facet_tilt_arcmin[0])), shortest(nonzero(part.facet_tilt_arcmin[1])));
  if (part.root_radius_um > 0.0) text += fmt::format("root_radius_um = {}\n", shortest(part.root_radius_um));
  const PredictedTexture& t = part.texture;
  text += fmt::format(
      "# Sa {} nm, as published for facets that were made by such motions; feed marks at 7.07 Hz.\n"
      "roughness_sq_nm = {}\ncorrelation_length_um = {}\nwaviness_sq_nm = {}\nwaviness_length_um = {}\n",
      fixed(t.sa_nm, 1), fixed(t.roughness_sq_nm, 3), shortest(t.correlation_length_um), fixed(t.waviness_sq_nm, 3),
      fixed(t.waviness_length_um, 3));
  text += "\n[detector]\nacceptance_half_angle_deg = [0.05, 0.5]\n";
  return text;
}

}  // namespace retrace::studies
