#include "studies/design/spectrum_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/message_text.h"
#include "core/number_format.h"

namespace retrace::studies {
namespace {

constexpr std::string_view kSpectrum = "spectrum";
constexpr std::array kWeightings = {Choice<bool>{"photopic", true}, Choice<bool>{"radiant", false}};

std::vector<LightSpectrum::Line> read_lines(TableReader& light) {
  std::vector<LightSpectrum::Line> lines;
  for (const auto& [wavelength_nm, power] :
       light.number_pairs(kSpectrum, "[wavelength_nm, power]", kPositive, kNotNegative))
    lines.push_back({wavelength_nm, power});
  const auto by_wavelength = [](const auto& a, const auto& b) { return a.wavelength_nm < b.wavelength_nm; };
  std::sort(lines.begin(), lines.end(), by_wavelength);
  for (std::size_t k = 1; k < lines.size(); ++k)
    if (lines[k].wavelength_nm == lines[k - 1].wavelength_nm)
      light.fail(kSpectrum,
                 fmt::format("must name each wavelength once, got {} twice", shortest(lines[k].wavelength_nm)));
  return lines;
}

/// A name or a file.
void read_word(TableReader& light, LightSpectrum& spectrum) {
  const std::string allowed = "\"A\", \"D65\", a file that ends in .csv or a list of [wavelength_nm, power]";
  if (!light.is_text(kSpectrum))
    light.fail(kSpectrum, fmt::format("must be {}, got {}", allowed, light.shown_value(kSpectrum)));
  const std::string word = light.text(kSpectrum).value_or("");
  if (word == "A" || word == "D65") {
    spectrum.kind = word == "A" ? LightSpectrum::Kind::illuminant_a : LightSpectrum::Kind::illuminant_d65;
  } else if (word.ends_with(".csv") && word.find('\0') == std::string::npos) {
    spectrum.kind = LightSpectrum::Kind::file;
    spectrum.name = word;
    spectrum.file = light.file(kSpectrum).value_or(word);
  } else {
    light.fail(kSpectrum, fmt::format("must be {}, got {}", allowed, in_quotes(word)));
  }
}

}  // namespace

std::optional<LightSpectrum> read_spectrum(TableReader& light) {
  if (!light.has(kSpectrum)) {
    light.refuse({"weighting"}, "only allowed together with spectrum");
    return std::nullopt;
  }
  light.refuse({"wavelength_nm"}, "not allowed together with spectrum: one of the two says what the light is");
  LightSpectrum spectrum;
  spectrum.location = light.where(kSpectrum);
  if (light.list_size(kSpectrum)) {
    spectrum.kind = LightSpectrum::Kind::lines;
    spectrum.lines = read_lines(light);
  } else {
    read_word(light, spectrum);
  }
  spectrum.photopic = light.choice("weighting", std::span<const Choice<bool>>(kWeightings)).value_or(true);
  return spectrum;
}

}  // namespace retrace::studies
