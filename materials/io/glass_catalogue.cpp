#include "materials/io/glass_catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "core/atomic_file.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/text.h"

namespace retrace::materials {
namespace {

constexpr std::size_t kMostCatalogueBytes = std::size_t{16} << 20;
constexpr std::size_t kMostCoefficients = 10;

/// Exponents of w in n^2, in the order of the coefficients.
constexpr std::array kSchott = {0, 2, -2, -4, -6, -8};
constexpr std::array kExtended = {0, 2, -2, -4, -6, -8, -10, -12};
constexpr std::array kExtended2 = {0, 2, -2, -4, -6, -8, 4, 6};
constexpr std::array kExtended3 = {0, 2, 4, -2, -4, -6, -8, -10, -12};

/// UTF-16 with its byte order mark as bytes, whose characters beyond ASCII are question marks; other text as it is.
std::string narrow(std::string_view text) {
  const bool is_little = text.starts_with("\xff\xfe");
  if (!is_little && !text.starts_with("\xfe\xff")) return std::string(text);
  std::string narrowed;
  for (std::size_t k = 2; k + 1 < text.size(); k += 2) {
    const char low = is_little ? text[k] : text[k + 1];
    const char high = is_little ? text[k + 1] : text[k];
    narrowed += high == '\0' && static_cast<unsigned char>(low) < 0x80 ? low : '?';
  }
  return narrowed;
}

bool same_letters(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::toupper(x) == std::toupper(y); });
}

PowerSeries series(std::span<const double> coefficients, std::span<const int> exponents) {
  PowerSeries made;
  for (std::size_t k = 0; k < exponents.size(); ++k) made.terms.push_back({coefficients[k], exponents[k]});
  return made;
}

/// Of pairs of strength and resonance; those without strength are left out, so that they have no pole.
Sellmeier sellmeier(std::span<const double> pairs, PowerSeries rest = {}) {
  Sellmeier made{.terms = {}, .rest = std::move(rest)};
  for (std::size_t k = 0; k + 1 < pairs.size(); k += 2)
    if (pairs[k] != 0.0) made.terms.push_back({pairs[k], pairs[k + 1]});
  return made;
}

}  // namespace

GlassCatalogue::GlassCatalogue(std::string_view text, std::string file) : file_(std::move(file)) {
  const std::string lines = narrow(text);
  int number = 0;
  for (const std::string_view line : split(lines, '\n')) {
    ++number;
    const std::vector<std::string_view> fields = words_in(line);
    Line read{number, {fields.begin(), fields.end()}};
    if (read.fields.empty()) continue;
    if (read.fields.front() == "NM") {
      if (read.fields.size() < 2) fail(read, "NM: must have a name");
      names_.push_back(read.fields[1]);
      glasses_.emplace_back();
    }
    if (!glasses_.empty()) glasses_.back().push_back(std::move(read));
  }
  if (glasses_.empty()) throw InputError({file_, 0, ""}, "holds no glass: no line begins with NM");
}

GlassCatalogue GlassCatalogue::read(const std::filesystem::path& file) {
  return {read_file(file, kMostCatalogueBytes), file.string()};
}

void GlassCatalogue::fail(const Line& line, std::string_view text) const {
  throw InputError({file_, line.number, ""}, text);
}

/// The fields from `first` on; those that are not there count as 0. \throw InputError if there are fewer than `least`
std::vector<double> GlassCatalogue::numbers(const Line& line, std::size_t first, std::size_t least,
                                            std::size_t most) const {
  std::vector<double> values;
  for (std::size_t k = first; k < line.fields.size() && values.size() < most; ++k) {
    const std::optional<double> value = number_in(line.fields[k]);
    if (!value)
      fail(line, fmt::format("{}: must be finite numbers, got {}", line.fields.front(), in_quotes(line.fields[k])));
    values.push_back(*value);
  }
  if (values.size() < least)
    fail(line, fmt::format("{}: must have at least {} numbers, got {}", line.fields.front(), least, values.size()));
  values.resize(most, 0.0);
  return values;
}

/// The formulas by their numbers, after the manual of OpticStudio, "The Glass Dispersion Formulas".
Dispersion GlassCatalogue::dispersion(const Line& name, const Line& coefficients) const {
  const std::vector<double> c = numbers(coefficients, 1, 1, kMostCoefficients);
  const std::span<const double> all = c;
  const double formula = numbers(name, 2, 1, 1).front();
  const auto constant = [](double n2) { return PowerSeries{{{n2 - 1.0, 0}}}; };
  // strength / (w^2 - resonance) as strength / resonance (w^2 / (w^2 - resonance) - 1).
  const auto pole = [](double strength, double resonance_um2, Sellmeier& into) {
    if (strength == 0.0) return;
    if (resonance_um2 == 0.0) {
      into.rest.terms.push_back({strength, -2});
      return;
    }
    into.terms.push_back({strength / resonance_um2, resonance_um2});
    into.rest.terms.push_back({-strength / resonance_um2, 0});
  };
  if (formula == 1.0) return series(all, kSchott);
  if (formula == 2.0) return sellmeier(all.first(6));
  if (formula == 3.0) return Herzberger{c[0], c[1], c[2], c[3], c[4], c[5]};
  if (formula == 4.0) {  // Sellmeier 2
    Sellmeier made = sellmeier(std::array{c[1], c[2] * c[2]}, PowerSeries{{{c[0], 0}}});
    pole(c[3], c[4] * c[4], made);
    return made;
  }
  if (formula == 5.0) return Conrady{c[0], c[1], c[2]};
  if (formula == 6.0) return sellmeier(all.first(8));  // Sellmeier 3
  if (formula == 7.0 || formula == 8.0) {              // Handbook of Optics 1 and 2
    Sellmeier made = sellmeier({}, constant(c[0]));
    made.rest.terms.push_back({-c[3], 2});
    if (formula == 7.0)
      pole(c[1], c[2], made);
    else if (c[1] != 0.0)
      made.terms.push_back({c[1], c[2]});
    return made;
  }
  if (formula == 9.0) return sellmeier(all.subspan(1, 4), constant(c[0]));  // Sellmeier 4
  if (formula == 10.0) return series(all, kExtended);
  if (formula == 11.0) return sellmeier(all.first(10));  // Sellmeier 5
  if (formula == 12.0) return series(all, kExtended2);
  if (formula == 13.0) return series(all, kExtended3);
  fail(name, fmt::format("NM: the dispersion formula must be 1 to 13, got {}", printable(name.fields[2])));
}

void GlassCatalogue::add_thermo_optic(const Line& line, Material& glass) const {
  if (line.fields.size() == 1) return;
  const std::vector<double> t = numbers(line, 1, 6, 7);
  if (line.fields.size() > 7) glass.temperature_c = t[6];
  if (std::ranges::all_of(std::span(t).first(5), [](double value) { return value == 0.0; })) return;  // none are known
  glass.thermo_optic = ThermoOptic{.d0_per_k = t[0],
                                   .d1_per_k2 = t[1],
                                   .d2_per_k3 = t[2],
                                   .e0_um2_per_k = t[3],
                                   .e1_um2_per_k2 = t[4],
                                   .resonance_um = t[5],
                                   .source = file_};
}

void GlassCatalogue::add_range(const Line& line, Material& glass) const {
  const std::vector<double> range_um = numbers(line, 1, 2, 2);
  if (!(range_um[0] > 0.0 && range_um[1] > range_um[0]))
    fail(line, fmt::format("LD: must be wavelengths that ascend from above 0, got {} and {}", shortest(range_um[0]),
                           shortest(range_um[1])));
  glass.valid_from_nm = 1e3 * range_um[0];
  glass.valid_to_nm = 1e3 * range_um[1];
}

/// From internal transmittances: -ln(T) / thickness. Of a wavelength that stands there twice the thicker sample counts;
/// what lets nothing pass, or has no thickness, tells none.
SpectralCurve GlassCatalogue::absorption(const std::vector<Line>& lines) const {
  struct Sample {
    double thickness_mm = 0.0;
    double per_mm = 0.0;
  };
  std::map<double, Sample> samples;
  for (const Line& line : lines) {
    if (line.fields.front() != "IT" || line.fields.size() < 4) continue;
    const std::vector<double> it = numbers(line, 1, 3, 3);
    if (!(it[0] > 0.0)) fail(line, fmt::format("IT: the wavelength must be > 0, got {}", shortest(it[0])));
    if (!(it[1] >= 0.0 && it[1] <= 1.0))
      fail(line, fmt::format("IT: the transmittance must be >= 0 and <= 1, got {}", shortest(it[1])));
    if (!(it[2] >= 0.0)) fail(line, fmt::format("IT: the thickness must be >= 0, got {}", shortest(it[2])));
    if (it[1] == 0.0 || it[2] == 0.0) continue;
    Sample& sample = samples[1e3 * it[0]];
    if (it[2] > sample.thickness_mm) sample = {it[2], std::max(0.0, -std::log(it[1])) / it[2]};
  }
  SpectralCurve curve;
  for (const auto& [wavelength_nm, sample] : samples) {
    curve.wavelengths_nm.push_back(wavelength_nm);
    curve.values.push_back(sample.per_mm);
  }
  return curve;
}

Material GlassCatalogue::glass_of(const std::vector<Line>& lines) const {
  const Line& name = lines.front();
  Material glass;
  glass.name = printable(name.fields[1]);
  glass.source = file_;
  const Line* coefficients = nullptr;
  for (const Line& line : lines) {
    if (line.fields.front() == "CD") coefficients = &line;
    if (line.fields.front() == "TD") add_thermo_optic(line, glass);
    if (line.fields.front() == "LD") add_range(line, glass);
  }
  if (coefficients == nullptr) fail(name, fmt::format("{}: has no line CD of coefficients", glass.name));
  if (!(glass.valid_to_nm > 0.0))
    fail(name, fmt::format("{}: has no line LD of the wavelengths that its formula is for", glass.name));
  glass.dispersion = dispersion(name, *coefficients);
  if (SpectralCurve curve = absorption(lines); curve.values.size() == 1)
    glass.absorption_per_mm = curve.values.front();
  else if (!curve.values.empty())
    glass.absorption_per_mm = std::move(curve);
  return glass;
}

void GlassCatalogue::require(std::string_view name, const InputLocation& where) const {
  if (std::ranges::any_of(names_, [&](const std::string& other) { return same_letters(other, name); })) return;
  const std::vector<std::string_view> known(names_.begin(), names_.end());
  const std::string_view meant = closest(name, known);
  throw InputError(
      where, fmt::format("no glass of that name among the {} of {}, got {}{}", names_.size(), printable(file_),
                         in_quotes(name), meant.empty() ? "" : fmt::format("; did you mean {}?", in_quotes(meant))));
}

Material GlassCatalogue::glass(std::string_view name) const {
  const auto found = std::ranges::find_if(names_, [&](const std::string& other) { return same_letters(other, name); });
  return glass_of(glasses_[static_cast<std::size_t>(found - names_.begin())]);
}

}  // namespace retrace::materials
