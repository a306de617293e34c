#include "studies/design/spectrum_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/number_format.h"

namespace retrace::studies {
namespace {

constexpr std::string_view kSpectrum = "light.spectrum";

std::vector<LightSpectrum::Line> lines_of(const schema::Document& document) {
  std::vector<LightSpectrum::Line> lines;
  for (const std::vector<double>& line : document.rows(kSpectrum)) lines.push_back({line[0], line[1]});
  std::ranges::sort(lines, {}, &LightSpectrum::Line::wavelength_nm);
  const auto twice = std::ranges::adjacent_find(lines, {}, &LightSpectrum::Line::wavelength_nm);
  if (twice != lines.end())
    document.fail(kSpectrum,
                  fmt::format("must name each wavelength once, got {} twice", shortest(twice->wavelength_nm)));
  return lines;
}

/// A name or a file.
void read_word(const schema::Document& document, LightSpectrum& spectrum) {
  const std::string word = document.text(kSpectrum);
  spectrum.kind = word == "A"     ? LightSpectrum::Kind::illuminant_a
                  : word == "D65" ? LightSpectrum::Kind::illuminant_d65
                                  : LightSpectrum::Kind::file;
  if (spectrum.kind != LightSpectrum::Kind::file) return;
  spectrum.name = word;
  spectrum.file = document.file(kSpectrum);
}

}  // namespace

std::optional<LightSpectrum> read_spectrum(const schema::Document& document) {
  if (!document.has(kSpectrum)) return std::nullopt;
  LightSpectrum spectrum;
  spectrum.kind = LightSpectrum::Kind::lines;
  if (document.is_list(kSpectrum))
    spectrum.lines = lines_of(document);
  else
    read_word(document, spectrum);
  spectrum.photopic = document.text("light.weighting") == "photopic";
  return spectrum;
}

}  // namespace retrace::studies
