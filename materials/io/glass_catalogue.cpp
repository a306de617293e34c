#include "materials/io/glass_catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "core/atomic_file.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/text.h"
#include "materials/io/absorption_data.h"

namespace retrace::materials {
namespace {

constexpr std::size_t kMaxCatalogueBytes = std::size_t{16} << 20;
constexpr std::size_t kMaxCoefficients = 10;
/// Maximum amount by which measurement noise may raise a transmittance above 1.
constexpr double kNoiseOfTransmittance = 0.01;

/// Exponents of w in n^2, in the order of the coefficients.
constexpr std::array kSchott = {0, 2, -2, -4, -6, -8};
constexpr std::array kExtended = {0, 2, -2, -4, -6, -8, -10, -12};
constexpr std::array kExtended2 = {0, 2, -2, -4, -6, -8, 4, 6};
constexpr std::array kExtended3 = {0, 2, 4, -2, -4, -6, -8, -10, -12};

/// Converts UTF-16 text with a byte order mark to ASCII. Characters outside ASCII become question marks. Other text is
/// returned unchanged, except that a byte order mark is removed.
std::string narrow(std::string_view text) {
  const bool is_little = text.starts_with("\xff\xfe");
  if (!is_little && !text.starts_with("\xfe\xff")) return std::string(without_byte_order_mark(text));
  std::string narrowed;
  for (std::size_t k = 2; k + 1 < text.size(); k += 2) {
    const char low = is_little ? text[k] : text[k + 1];
    const char high = is_little ? text[k + 1] : text[k];
    narrowed += high == '\0' && static_cast<unsigned char>(low) < 0x80 ? low : '?';
  }
  return narrowed;
}

/// Returns true if a word has the form of a record's code: two capital letters.
bool is_code(std::string_view word) {
  return word.size() == 2 && std::ranges::all_of(word, [](char c) { return c >= 'A' && c <= 'Z'; });
}

PowerSeries series(std::span<const double> coefficients, std::span<const int> exponents) {
  PowerSeries made;
  for (std::size_t k = 0; k < exponents.size(); ++k) made.terms.push_back({coefficients[k], exponents[k]});
  return made;
}

/// Returns the Sellmeier formula with the given pairs of strength and resonance. Pairs with the strength 0 are omitted,
/// because they would cause a pole in the formula.
Sellmeier sellmeier(std::span<const double> pairs, PowerSeries rest = {}) {
  Sellmeier made{.terms = {}, .power_terms = std::move(rest)};
  for (std::size_t k = 0; k + 1 < pairs.size(); k += 2)
    if (pairs[k] != 0.0) made.terms.push_back({pairs[k], pairs[k + 1]});
  return made;
}

}  // namespace

GlassCatalogue::GlassCatalogue(std::string_view text, std::string file) : file_(std::move(file)) {
  const std::string lines = narrow(text);
  std::vector<Record> before_glasses;
  std::vector<Record>* records = &before_glasses;
  int number = 0;
  for (const std::string_view line : split(lines, '\n')) {
    ++number;
    const std::vector<std::string_view> words = words_in(line);
    if (words.empty()) continue;
    if (words.front() == "NM") records = &glasses_.emplace_back();
    if (is_code(words.front())) records->emplace_back();
    if (records->empty()) continue;  // skips text before the first record
    for (const std::string_view word : words) records->back().push_back({std::string(word), number});
  }
  if (glasses_.empty()) throw InputError({file_, 0, ""}, "the file contains no glass: no line begins with NM");
  for (const std::vector<Record>& glass : glasses_) {
    const Record& name = glass.front();
    if (name.size() < 2) fail(name.front().line, "NM", "must contain the name of the glass");
    names_.push_back(name[1].text);
  }
}

GlassCatalogue GlassCatalogue::read(const std::filesystem::path& file) {
  return {read_file(file, kMaxCatalogueBytes), file.string()};
}

void GlassCatalogue::fail(int line, std::string_view key, std::string_view text) const {
  throw InputError({file_, line, std::string(key)}, text);
}

/// Returns the numbers of a record, beginning with field `first`. If there are fewer than `max_count` numbers, zeros
/// are appended.
/// \throw InputError if the record has fewer than `min_count` numbers
std::vector<double> GlassCatalogue::numbers(const Record& record, std::size_t first, std::size_t min_count,
                                            std::size_t max_count) const {
  const std::string& code = record.front().text;
  std::vector<double> values;
  for (std::size_t k = first; k < record.size() && values.size() < max_count; ++k) {
    const std::optional<double> value = number_in(record[k].text);
    if (!value) fail(record[k].line, code, "must be finite numbers, got " + in_quotes(record[k].text));
    values.push_back(*value);
  }
  if (values.size() < min_count)
    fail(record.front().line, code,
         fmt::format("must have at least {} {}, got {}", min_count, min_count == 1 ? "number" : "numbers",
                     values.size()));
  values.resize(max_count, 0.0);
  return values;
}

/// Refuses a record that consists of several lines and has too many numbers. The last line has no code and was
/// therefore joined to this record, but it probably belongs to a different record.
void GlassCatalogue::require_no_more(const Record& record, std::size_t max_count) const {
  if (record.size() <= max_count + 1 || record.back().line == record.front().line) return;
  fail(record.back().line, record.front().text,
       fmt::format(
           "must have at most {} numbers including its continuation lines, got {}; a line without a code continues the "
           "previous record",
           max_count, record.size() - 1));
}

/// Refuses a record whose last coefficient is a strength without a resonance, unless this strength is 0.
/// \param first number of the first coefficient that is a strength, counted from 1
/// \param end number of the coefficient after the last resonance
void GlassCatalogue::require_whole_pairs(const Record& record, std::size_t first, std::size_t end) const {
  if (record.size() <= first || record.size() >= end || (record.size() - first) % 2 == 0) return;
  if (number_in(record.back().text) == 0.0) return;
  fail(
      record.back().line, "CD",
      fmt::format("coefficients {} to {} must be pairs of strength and resonance, but the number of coefficients is {}",
                  first, end - 1, record.size() - 1));
}

/// Returns the record with this code, or null if there is none.
/// \throw InputError if two different records have this code
const GlassCatalogue::Record* GlassCatalogue::find(const std::vector<Record>& records, std::string_view code) const {
  const Record* found = nullptr;
  for (const Record& record : records) {
    if (record.front().text != code) continue;
    if (found != nullptr && *found != record)
      fail(record.front().line, code,
           fmt::format("a glass may have only one such record, but line {} contains a different one",
                       found->front().line));
    found = &record;
  }
  return found;
}

/// Returns the dispersion formula with a given number (manual of OpticStudio, "The Glass Dispersion Formulas").
Dispersion GlassCatalogue::dispersion(const Record& name, const Record& coefficients) const {
  require_no_more(coefficients, kMaxCoefficients);
  const std::vector<double> c = numbers(coefficients, 1, 1, kMaxCoefficients);
  const std::span<const double> all = c;
  const double formula = numbers(name, 2, 1, 1).front();
  const auto constant = [](double n2) { return PowerSeries{{{n2 - 1.0, 0}}}; };
  // Adds the term strength / (w^2 - resonance), written as strength / resonance (w^2 / (w^2 - resonance) - 1).
  const auto pole = [](double strength, double resonance_um2, Sellmeier& into) {
    if (strength == 0.0) return;
    if (resonance_um2 == 0.0) {
      into.power_terms.terms.push_back({strength, -2});
      return;
    }
    into.terms.push_back({strength / resonance_um2, resonance_um2});
    into.power_terms.terms.push_back({-strength / resonance_um2, 0});
  };
  // Formulas with pairs of strength and resonance. Each entry contains the number of the formula, the number of the
  // coefficient that is the first strength, and the number of the coefficient after the last resonance.
  static constexpr std::array<std::array<std::size_t, 3>, 7> pairs = {
      {{2, 1, 7}, {4, 2, 6}, {6, 1, 9}, {7, 2, 4}, {8, 2, 4}, {9, 2, 6}, {11, 1, 11}}};
  for (const auto& [number, first, end] : pairs)
    if (formula == static_cast<double>(number)) require_whole_pairs(coefficients, first, end);
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
    made.power_terms.terms.push_back({-c[3], 2});
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
  fail(name[2].line, "NM", "the dispersion formula must be 1 to 13, got " + printable(name[2].text));
}

void GlassCatalogue::add_thermo_optic(const Record& record, Material& glass) const {
  if (record.size() == 1) return;
  require_no_more(record, 7);
  const std::vector<double> t = numbers(record, 1, 6, 7);
  if (record.size() > 7) glass.temperature_c = t[6];
  // all coefficients are 0: they are unknown
  if (std::ranges::all_of(std::span(t).first(5), [](double value) { return value == 0.0; })) return;
  glass.thermo_optic = thermo_optic_of(t, file_);
}

void GlassCatalogue::add_range(const Record& record, Material& glass) const {
  require_no_more(record, 2);
  const std::vector<double> range_um = numbers(record, 1, 2, 2);
  if (!(range_um[0] > 0.0 && range_um[1] > range_um[0]))
    fail(record.front().line, "LD",
         fmt::format("must be two wavelengths above 0 in ascending order, got {} and {}", shortest(range_um[0]),
                     shortest(range_um[1])));
  glass.valid_from_nm = 1e3 * range_um[0];
  glass.valid_to_nm = 1e3 * range_um[1];
}

/// Computes the absorption, -ln(T) / thickness, from the internal transmittances T and adds it to the glass. If there
/// are several samples at one wavelength, only the sample with the largest thickness is used. Samples with T = 0 or
/// with the thickness 0 do not determine the absorption and are ignored.
void GlassCatalogue::add_absorption(const std::vector<Record>& records, Material& glass) const {
  AbsorptionData data(file_, "IT");
  struct Sample {
    int line = 0;
    double wavelength_nm = 0.0;
    double transmittance = 0.0;
    double thickness_mm = 0.0;
  };
  std::vector<Sample> samples;
  std::map<double, double> thickest_mm;  // by wavelength in nm
  for (const Record& record : records) {
    if (record.front().text != "IT" || record.size() < 4) continue;
    const int line = record.front().line;
    try {
      require_no_more(record, 3);
      const std::vector<double> it = numbers(record, 1, 3, 3);
      if (!(it[0] > 0.0)) {
        data.omit(line, fmt::format("the wavelength must be > 0, got {}", shortest(it[0])));
      } else if (!(it[1] >= 0.0 && it[1] <= 1.0 + kNoiseOfTransmittance)) {
        data.omit(line, fmt::format("the transmittance must be >= 0 and <= 1, got {}", shortest(it[1])));
      } else if (!(it[2] >= 0.0)) {
        data.omit(line, fmt::format("the thickness must be >= 0, got {}", shortest(it[2])));
      } else if (it[1] > 0.0 && it[2] > 0.0) {
        samples.push_back({line, 1e3 * it[0], it[1], it[2]});
        double& thickest = thickest_mm[samples.back().wavelength_nm];
        thickest = std::max(thickest, it[2]);
      }
    } catch (const InputError& error) {
      data.omit(error.where().line, error.text());
    }
  }
  for (const Sample& sample : samples) {
    if (sample.thickness_mm < thickest_mm.at(sample.wavelength_nm)) continue;
    if (sample.transmittance <= 1.0)
      data.add(sample.line, sample.wavelength_nm, std::max(0.0, -std::log(sample.transmittance)) / sample.thickness_mm);
    else
      data.add_zero(sample.line, sample.wavelength_nm,
                    fmt::format("the transmittance must be <= 1, got {}", shortest(sample.transmittance)));
  }
  data.finish(glass);
}

/// Adds a warning if n_d of the record NM differs from the index of the formula.
void GlassCatalogue::check_nd(const Record& name, Material& glass) const {
  // field of n_d, which follows the code, the name, the number of the formula and the glass code
  constexpr std::size_t at = 4;
  if (name.size() <= at) return;
  const std::optional<double> stated = number_in(name[at].text);
  const std::string doubt =
      stated ? nd_contradiction(glass, *stated) : fmt::format("n_d must be a number, got {}", in_quotes(name[at].text));
  if (!doubt.empty())
    glass.warnings.push_back({"index_disagrees", InputError({file_, name[at].line, "NM"}, doubt).what()});
}

Material GlassCatalogue::glass_of(const std::vector<Record>& records) const {
  const Record& name = records.front();
  const int line = name.front().line;
  Material glass;
  glass.name = printable(name[1].text);
  glass.source = file_;
  const Record* const coefficients = find(records, "CD");
  if (coefficients == nullptr)
    fail(line, glass.name, "the glass has no line CD, which gives the coefficients of the formula");
  if (const Record* const thermo_optic = find(records, "TD")) add_thermo_optic(*thermo_optic, glass);
  const Record* const range = find(records, "LD");
  if (range == nullptr)
    fail(line, glass.name, "the glass has no line LD, which gives the wavelength range of the formula");
  add_range(*range, glass);
  glass.dispersion = dispersion(name, *coefficients);
  check_nd(name, glass);
  add_absorption(records, glass);
  return glass;
}

void GlassCatalogue::require(std::string_view name, const InputLocation& where) const {
  if (std::ranges::any_of(names_, [&](const std::string& other) { return lower_case(other) == lower_case(name); }))
    return;
  const std::vector<std::string_view> known(names_.begin(), names_.end());
  const std::string_view meant = closest_match(name, known);
  throw InputError(
      where, fmt::format("must be the name of one of the {} glasses in {}, got {}{}", names_.size(), printable(file_),
                         in_quotes(name), meant.empty() ? "" : fmt::format("; did you mean {}?", in_quotes(meant))));
}

Material GlassCatalogue::glass(std::string_view name) const {
  const auto found =
      std::ranges::find_if(names_, [&](const std::string& other) { return lower_case(other) == lower_case(name); });
  return glass_of(glasses_[static_cast<std::size_t>(found - names_.begin())]);
}

}  // namespace retrace::materials
