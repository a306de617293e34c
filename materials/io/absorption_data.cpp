#include "materials/io/absorption_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"

namespace retrace::materials {

void AbsorptionData::Defects::add(int at_line, std::string_view why) {
  if (count++ > 0) return;
  line = at_line;
  reason = why;
}

void AbsorptionData::add_zero(int line, double wavelength_nm, std::string_view reason) {
  zeros_.add(line, reason);
  add(line, wavelength_nm, 0.0);
}

void AbsorptionData::omit(int line, std::string_view reason) {
  omitted_.add(line, reason);
}

void AbsorptionData::warn(const Defects& blemishes, std::string_view one, std::string_view several,
                          Material& material) const {
  if (blemishes.count == 0) return;
  const std::string effect = blemishes.count == 1
                                 ? fmt::format("this sample {}", one)
                                 : fmt::format("this sample and {} more {}", blemishes.count - 1, several);
  material.warnings.push_back(
      {"absorption_sample_ignored",
       InputError({file_, blemishes.line, key_}, fmt::format("{}; {}", blemishes.reason, effect)).what()});
}

void AbsorptionData::finish(Material& material) {
  std::stable_sort(samples_.begin(), samples_.end(),
                   [](const Sample& a, const Sample& b) { return a.wavelength_nm < b.wavelength_nm; });
  SpectralCurve curve;
  for (std::size_t k = 0; k < samples_.size();) {
    const Sample& first = samples_[k];
    const std::size_t begin = k;
    bool is_one = true;
    for (; k < samples_.size() && samples_[k].wavelength_nm == first.wavelength_nm; ++k)
      is_one &= samples_[k].per_mm == first.per_mm;
    if (is_one) {
      curve.wavelengths_nm.push_back(first.wavelength_nm);
      curve.values.push_back(first.per_mm);
      continue;
    }
    for (std::size_t j = begin; j < k; ++j)
      omit(samples_[j].line,
           fmt::format("must have one value for a wavelength, got several at {} nm", shortest(first.wavelength_nm)));
  }
  warn(zeros_, "counts as 0", "count as 0", material);
  warn(omitted_, "is ignored", "are ignored", material);
  if (curve.values.empty() && omitted_.count > 0)
    material.warnings.push_back(
        {"no_absorption_data",
         InputError({file_, 0, key_},
                    "has no usable sample of the absorption; 0 is used instead unless body.absorption_per_mm is given")
             .what()});
  if (curve.values.size() == 1)
    material.absorption_per_mm = curve.values.front();
  else if (!curve.values.empty())
    material.absorption_per_mm = std::move(curve);
}

}  // namespace retrace::materials
