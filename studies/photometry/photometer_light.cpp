// Members of Photometer that choose the traced wavelengths for each direction of light. The choice depends on the
// knees: the wavelengths at which total reflection begins or ends at a facet.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/number_format.h"
#include "core/task_progress.h"
#include "design/cell_interference_of_design.h"
#include "design/light_and_index.h"
#include "design/total_reflection.h"
#include "materials/io/material_library.h"
#include "materials/knee_rule.h"
#include "materials/spectral_bands.h"
#include "studies/photometry/photometer.h"

namespace retrace::studies {
namespace {

/// Minimum number of spans of the spectrum for which knees are computed. Pictures, searches and preliminary values use
/// fewer spans and ignore knees.
constexpr std::size_t kMinSpansForKnees = 4;
/// Maximum wavelength step of the table of refractive indices. With this step, the error of linear interpolation is at
/// most 5e-6.
constexpr double kIndexStepNm = 10.0;
/// Fraction of the flux at each end of the spectrum in which knees are ignored.
constexpr double kIgnoredFluxFraction = 2e-3;
/// Minimum distance between two knees. Knees that are closer are merged into one.
constexpr double kMinDistanceNm = 4.0;
constexpr std::size_t kMaxKnees = 4;
/// Knees are rounded to multiples of this step, so that settings with almost equal knees are traced together.
constexpr double kRoundingNm = 0.01;

struct IndexAt {
  double wavelength_nm = 0.0;
  double index = 1.0;
  double back_index = 1.0;
};

/// Returns a table of refractive indices at wavelengths in steps of at most kIndexStepNm. The table excludes both ends
/// of the spectrum, each of which has the fraction kIgnoredFluxFraction of the flux. Wavelengths for which the material
/// has no data are omitted.
/// \param flux spectrum whose weights add up to 1
std::vector<IndexAt> index_table(const design::Design& design, const materials::Spectrum& flux) {
  double low_nm = flux.wavelengths_nm.front(), high_nm = flux.wavelengths_nm.back();
  double sum = 0.0;
  for (std::size_t k = 0; k < flux.size(); ++k) {
    if (sum < kIgnoredFluxFraction) low_nm = flux.wavelengths_nm[k];
    if (sum < 1.0 - kIgnoredFluxFraction) high_nm = flux.wavelengths_nm[k];
    sum += flux.weights[k];
  }
  const materials::MaterialLibrary library = materials::MaterialLibrary::shipped();
  Warnings ignored;
  // The model of a rough surface is slow to build and does not change the refractive indices.
  design::Design smooth = design;
  smooth.surface.texture = design::SmoothTexture{};
  const design::OpticsOfDesign optics(smooth, library, ignored);
  const auto steps = static_cast<int>(std::ceil((high_nm - low_nm) / kIndexStepNm));
  std::vector<IndexAt> table;
  for (int k = 0; k <= steps; ++k) try {
      const double w = std::lerp(low_nm, high_nm, static_cast<double>(k) / std::max(1, steps));
      const raytrace::Optics at = optics.at(w);
      table.push_back({w, at.index, at.back_index});
    } catch (const InputError&) {
      continue;
    }
  return table;
}

/// Merges knees that are closer than kMinDistanceNm into one at their mean wavelength. The distance is doubled until
/// at most kMaxKnees remain.
std::vector<double> joined(std::vector<double> knees_nm) {
  std::sort(knees_nm.begin(), knees_nm.end());
  for (double distance_nm = kMinDistanceNm;; distance_nm *= 2.0) {
    std::vector<double> joined;
    for (std::size_t first = 0; first < knees_nm.size();) {
      std::size_t last = first;
      double sum = 0.0;
      for (; last < knees_nm.size() && knees_nm[last] - knees_nm[first] < distance_nm; ++last) sum += knees_nm[last];
      joined.push_back(kRoundingNm * std::round(sum / static_cast<double>(last - first) / kRoundingNm));
      first = last;
    }
    if (joined.size() <= kMaxKnees) return joined;
  }
}

/// Returns the knees of a part for light from one direction, in ascending order. A knee is a wavelength at which total
/// reflection begins or ends at a facet.
std::vector<double> knees_of(const geometry::PartSpec& part, const geometry::Vec3& to_source,
                             const std::vector<IndexAt>& table) {
  std::vector<double> knees_nm;
  std::vector<double> before;
  for (std::size_t k = 0; k < table.size(); ++k) {
    std::vector<double> margins =
        design::total_reflection_margins(part, to_source, table[k].index, table[k].back_index);
    for (std::size_t m = 0; k > 0 && m < margins.size(); ++m)
      if ((before[m] < 0.0) != (margins[m] < 0.0))
        knees_nm.push_back(
            std::lerp(table[k - 1].wavelength_nm, table[k].wavelength_nm, before[m] / (before[m] - margins[m])));
    before = std::move(margins);
  }
  return joined(std::move(knees_nm));
}

}  // namespace

double Photometer::Lamp::transmittance(double wavelength_nm) const {
  return absorption_per_mm.values.empty() ? 1.0 : std::exp(-absorption_per_mm.at(wavelength_nm) * path_length_mm);
}

materials::SpectralCurve Photometer::Lamp::remaining_power() const {
  materials::SpectralCurve left = power;
  for (std::size_t k = 0; k < left.values.size(); ++k) left.values[k] *= transmittance(left.wavelengths_nm[k]);
  return left;
}

/// Chooses the wavelengths by the flux that remains after absorption in the body, because a dyed body may absorb most
/// of the lamp's light. The weights exclude this absorption because the tracer applies it.
materials::Spectrum Photometer::Lamp::light(const std::vector<double>& knees_nm) const {
  const materials::SpectralCurve left = remaining_power();
  double before = 0.0;
  double behind = 0.0;
  for (std::size_t k = 0; k < left.values.size(); ++k) {
    const double w = left.wavelengths_nm[k];
    const double flux = power.values[k] * response.at(w);
    before += flux;
    behind += flux * transmittance(w);
  }
  materials::Spectrum light = knees_nm.empty()
                                  ? materials::traced_spectrum(materials::resolved_spectrum(left, &response), parts)
                                  : materials::knee_rule(left, response, parts, knees_nm);
  for (std::size_t k = 0; k < light.size(); ++k)
    light.weights[k] *= behind / before / transmittance(light.wavelengths_nm[k]);
  return light;
}

std::optional<raytrace::CellInterference> Photometer::cell_interference(std::size_t wavelength) const {
  const design::CellSpread* const spread = design_.cell_spread();
  if (spread == nullptr) return std::nullopt;
  raytrace::CellInterference cells = design::interference_of(*spread, model_.spectral[wavelength].optics.index);
  const bool has_band = lamp_ || (design_.light.spectrum() != nullptr &&
                                  design_.light.spectrum()->kind != design::LightSpectrum::Kind::lines);
  if (!has_band) return cells;
  const materials::Spectrum flux =
      lamp_ ? materials::resolved_spectrum(lamp_->remaining_power(), &lamp_->response) : design::flux_of(design_);
  cells.band_nm = materials::spectral_bands({wavelengths_nm(), weights_}, flux)[wavelength];
  return cells;
}

std::map<std::vector<double>, std::vector<std::size_t>> Photometer::settings_by_knees(
    const std::vector<PhotometerSetting>& settings) const {
  std::map<std::vector<double>, std::vector<std::size_t>> groups;
  const bool may_have_knees = lamp_ && lamp_->parts >= kMinSpansForKnees && effort_ == Effort::full &&
                              design_.elements() && !design_.part().substrate && !design_.entrance &&
                              !design_.has_deflecting_shells() && !design_.substance.refractive_index &&
                              design_.needs_total_reflection();
  std::vector<IndexAt> table;
  if (may_have_knees) table = index_table(design_, materials::resolved_spectrum(lamp_->power, &lamp_->response));
  for (std::size_t k = 0; k < settings.size(); ++k) {
    std::vector<double> knees_nm;
    if (!table.empty()) knees_nm = knees_of(design_.part(), frame_of(settings[k]).to_source, table);
    groups[std::move(knees_nm)].push_back(k);
  }
  return groups;
}

Photometer Photometer::with_knees(const std::vector<double>& knees_nm) const try {
  Photometer changed = *this;
  const materials::Spectrum light = lamp_->light(knees_nm);
  const materials::MaterialLibrary library = materials::MaterialLibrary::shipped();
  Warnings ignored;
  const design::OpticsOfDesign optics(design_, library, ignored);
  changed.weights_ = light.weights;
  changed.model_.spectral.clear();
  for (std::size_t k = 0; k < light.size(); ++k)
    changed.model_.spectral.push_back(
        {light.wavelengths_nm[k], light.weights[k], optics.at(light.wavelengths_nm[k], model_.wet_elements)});
  return changed;
} catch (const InputError&) {
  return *this;  // keeps the old wavelengths: the material has no data at one of the new ones
}

std::vector<PhotometerSetting> Photometer::with_reference_axis(std::vector<PhotometerSetting> settings) const {
  for (PhotometerSetting& setting : settings) {
    setting.reference_axis = design_.reference_axis();
    if (design_.inclination() != nullptr && !(frame_of(setting).to_source.z() > 0.0))
      throw InputError(
          design_.where("entrance_surface.incidence_deg"),
          fmt::format("light from V = {}, H = {} degrees comes from behind the part: the angle between this "
                      "direction and the axes of the elements must be less than 90 degrees",
                      shortest(setting.v_deg), shortest(setting.h_deg)));
  }
  return settings;
}

std::optional<std::vector<PhotometerReading>> Photometer::measure(const std::vector<PhotometerSetting>& requested,
                                                                  Progress* progress,
                                                                  const Cancellation* cancel) const {
  const std::vector<PhotometerSetting> settings = with_reference_axis(requested);
  std::vector<PhotometerReading> readings(settings.size());
  std::size_t done = 0;
  for (const auto& [knees_nm, indices] : settings_by_knees(settings)) {
    std::vector<PhotometerSetting> own;
    for (const std::size_t index : indices) own.push_back(settings[index]);
    const auto share = [&](std::size_t count) {
      return static_cast<double>(count) / static_cast<double>(settings.size());
    };
    PartProgress part(progress, share(done), share(done + own.size()));
    auto measured = knees_nm.empty() ? measure_in_one_light(own, &part, cancel)
                                     : with_knees(knees_nm).measure_in_one_light(own, &part, cancel);
    if (!measured) return std::nullopt;
    for (std::size_t k = 0; k < indices.size(); ++k) readings[indices[k]] = std::move((*measured)[k]);
    done += own.size();
  }
  return readings;
}

}  // namespace retrace::studies
