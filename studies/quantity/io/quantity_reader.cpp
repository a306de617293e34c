#include "studies/quantity/io/quantity_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/message_text.h"
#include "core/number_format.h"
#include "studies/photometry/io/standard_reader.h"
#include "studies/photometry/standards.h"
#include "studies/quantity/io/study_format.h"
#include "studies/quantity/photometric.h"

namespace retrace::studies {
namespace {

using schema::Document;

constexpr double kMaxDirections = 10000.0;

/// Returns the centres of `count` equal parts of a range. The mean of a function at these points approximates its mean
/// over the range to second order.
std::vector<double> middles(const Document& document, const std::string& at, const NumberRange& allowed) {
  const auto given = [&](const char* key, const NumberRange& range) {
    const double value = std::get<double>(document.named(at).at(key));
    if (!range.contains(value))
      document.fail(at + "." + key, fmt::format("must be {}, got {}", range.text(), shortest(value)));
    return value;
  };
  const double from = given("from", allowed);
  const double to = given("to", allowed);
  if (!(to > from))
    document.fail(at + ".to", fmt::format("must be greater than from ({}), got {}", shortest(from), shortest(to)));
  const double count = given("count", {.low = 1.0, .high = kMaxDirections});
  if (count != std::floor(count))
    document.fail(at + ".count", fmt::format("must be a whole number, got {}", shortest(count)));
  std::vector<double> values;
  for (double k = 0.5; k < count; ++k) values.push_back(from + (to - from) * k / count);
  return values;
}

std::optional<std::vector<double>> angles_of(const Document& document, const std::string& at,
                                             const NumberRange& allowed) {
  if (!document.has(at)) return std::nullopt;
  if (std::holds_alternative<schema::Named>(document.value(at))) return middles(document, at, allowed);
  return document.numbers(at);
}

/// Returns one quantity, or, for Reduction::each, one quantity for each direction.
Quantities fractions_of(const std::string& name, const FractionSpec& spec) {
  if (spec.reduction != Reduction::each) return {make_fraction(name, spec)};
  using Angles = std::optional<std::vector<double>>;
  const auto each_of = [](const Angles& angles) {
    std::vector<Angles> each;
    if (!angles) return std::vector<Angles>{angles};
    for (const double deg : *angles) each.push_back(std::vector{deg});
    return each;
  };
  Quantities all;
  for (const Angles& azimuth : each_of(spec.window.azimuth_deg))
    for (const Angles& incidence : each_of(spec.window.incidence_deg)) {
      FractionSpec one = spec;
      one.window.azimuth_deg = azimuth;
      one.window.incidence_deg = incidence;
      all.push_back(make_fraction(fmt::format("{}.{}", name, all.size() + 1), one));
    }
  return all;
}

Quantities read_fraction(const std::string& name, const Document& document, const std::string& at) {
  constexpr NumberRange incidence{.low = -90.0, .low_included = false, .high = 90.0, .high_included = false};
  FractionSpec spec;
  spec.window.incidence_deg = angles_of(document, at + ".incidence_deg", incidence);
  spec.window.azimuth_deg = angles_of(document, at + ".azimuth_deg", {});
  spec.window.by_solid_angle = document.text(at + ".weighting") == "solid_angle";
  spec.reduction = document.choice<Reduction>(at + ".over_directions");
  if (spec.window.by_solid_angle && spec.reduction != Reduction::mean)
    document.fail(at + ".weighting", "only allowed for over_directions = \"mean\"");
  const std::string kind = document.text(at + ".kind");
  if (kind == "ledger") spec.account = document.index(at + ".account");
  if (kind == "far_field") {
    spec.beyond_half_angle_deg = document.number(at + ".from_deg");
    spec.acceptance_half_angle_deg = document.number(at + ".to_deg");
    if (!(*spec.acceptance_half_angle_deg > *spec.beyond_half_angle_deg))
      document.fail(at + ".to_deg",
                    fmt::format("must be greater than from_deg ({}), got {}", shortest(*spec.beyond_half_angle_deg),
                                shortest(*spec.acceptance_half_angle_deg)));
  } else {
    spec.acceptance_half_angle_deg = document.number_if(at + ".acceptance_half_angle_deg");
  }
  return fractions_of(name, spec);
}

/// Resolves a request into settings. Errors in fields of the request are reported at the corresponding keys of the
/// quantity in the document.
/// \param at key of the quantity
PhotometrySettings settings_of(const PhotometryRequest& request, const Document& document, const std::string& at) {
  try {
    // The designs have not been read yet, so it is unknown whether they are coloured. The settings contain the dye for
    // designs that are not.
    PhotometrySettings settings = resolve(request, false);
    settings.colour = false;
    return settings;
  } catch (const InputError& error) {
    if (error.field().name.empty()) throw;
    const std::string& field = error.where().key;
    document.fail(at + "." + (field == "part_class" ? "class" : field), error.text());
  }
}

std::optional<std::string> optional_text(const Document& document, const std::string& key) {
  return document.has(key) ? std::optional(document.text(key)) : std::nullopt;
}

std::shared_ptr<const PhotometricTable> read_photometric_table(const Document& document, const std::string& at,
                                                               std::vector<design::NamedFile>& files) {
  PhotometryRequest request;
  // The value is the name of a shipped standard or otherwise the name of a file.
  request.standard = document.text(at + ".standard");
  if (find_standard(request.standard) == nullptr) {
    const std::string key = at + ".standard";
    files.push_back({document.file(key), key, document.where(key)});
    request.standard = files.back().file.string();
  }
  request.part_class = optional_text(document, at + ".class");
  request.colour = optional_text(document, at + ".colour");
  request.area_cm2 = document.number(at + ".area_cm2");
  if (document.has(at + ".rotation_deg")) request.rotation_deg = document.numbers(at + ".rotation_deg");
  request.window_deg = document.number_if(at + ".window_deg").value_or(request.window_deg);
  request.light = document.text(at + ".light");
  request.diffraction = document.text(at + ".far_field") == "diffracted";
  request.advice = false;
  request.dye = optional_text(document, at + ".dye");
  PhotometricTable table;
  table.request = settings_of(request, document, at);
  const PhotometrySettings& settings = table.request;
  for (const TestPoint& point : settings.test_plan.points)
    if (point.observation_deg > settings.window_deg)
      document.fail(at + ".window_deg", fmt::format("must be >= {}, an observation angle of the standard, got {}",
                                                    shortest(point.observation_deg), shortest(settings.window_deg)));
  const std::filesystem::path dye_file = dye_file_of(request.dye, false, settings.test_plan.colour);
  if (request.dye && dye_file == *request.dye)  // the user gave the dye as a file
    files.push_back({dye_file, at + ".dye", document.where(at + ".dye")});
  table.dye_unless_coloured = !request.dye;
  table.key =
      fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}", request.standard, request.part_class.value_or(""),
                  settings.test_plan.colour, settings.area_cm2, fmt::join(settings.rotation_deg, " "),
                  settings.window_deg, request.light, settings.diffraction, request.dye.value_or("(by colour)"));
  return std::make_shared<const PhotometricTable>(std::move(table));
}

Quantities read_photometric(const std::string& name, const Document& document, const std::string& at,
                            std::vector<design::NamedFile>& files) {
  const auto figure = document.choice<PhotometricFigure>(at + ".figure");
  const auto table = read_photometric_table(document, at, files);
  const std::size_t points = table->request.test_plan.points.size();
  if (const auto point = document.number_if(at + ".points")) {
    const NumberRange there{.low = 1.0, .high = static_cast<double>(points)};
    if (!there.contains(*point))
      document.fail(at + ".points", fmt::format("must be {}, got {}", there.text(), shortest(*point)));
    return {make_photometric(name, table, {static_cast<std::size_t>(*point) - 1, {}}, figure)};
  }
  if (document.text(at + ".points") == "worst") return {make_photometric(name, table, {}, figure)};
  if (document.text(at + ".points") == "each_reading") return make_photometric_readings(name, table, figure);
  Quantities each;
  for (std::size_t k = 0; k < points; ++k)
    each.push_back(make_photometric(fmt::format("{}.{}", name, k + 1), table, {k, {}}, figure));
  return each;
}

bool is_name(const std::string& text) {
  constexpr std::size_t longest = 64;
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
  };
  return !text.empty() && text.size() <= longest && !(text.front() >= '0' && text.front() <= '9') &&
         std::all_of(text.begin(), text.end(), fits);
}

}  // namespace

Quantities read_quantity(const Document& document, const std::string& at, std::vector<design::NamedFile>& files) {
  const std::string kind = document.text(at + ".kind");
  const std::string name = optional_text(document, at + ".name").value_or(document.text_as_written(at + ".kind"));
  if (!is_name(name))
    document.fail(
        at + ".name",
        fmt::format("must be at most 64 letters, digits, \"_\" and \".\", and must not begin with a digit, got {}",
                    in_quotes(name)));
  if (kind == "photometry") return read_photometric(name, document, at, files);
  const std::size_t plain = document.index(at + ".kind");
  if (plain < kFirstPlainKind) return read_fraction(name, document, at);
  return {make_plain(name, static_cast<PlainQuantity>(plain - kFirstPlainKind))};
}

}  // namespace retrace::studies
