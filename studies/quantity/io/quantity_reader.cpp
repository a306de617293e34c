#include "studies/quantity/io/quantity_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/message_text.h"
#include "core/number_format.h"
#include "studies/photometry/io/standard_reader.h"
#include "studies/photometry/standards.h"
#include "studies/quantity/photometric.h"

namespace retrace::studies {
namespace {

enum class Kind { share, plain, photometry };
struct KindOf {
  Kind kind = Kind::plain;
  PlainQuantity plain = PlainQuantity::elements_full;
  bool far_field = false;
  bool any_account = false;
};

constexpr KindOf plain(PlainQuantity which) {
  return {Kind::plain, which, false, false};
}

constexpr std::array kKinds = {
    TomlChoice<KindOf>{"rre", {Kind::share, PlainQuantity::elements_full, false, false}},
    TomlChoice<KindOf>{"ledger", {Kind::share, PlainQuantity::elements_full, false, true}},
    TomlChoice<KindOf>{"far_field", {Kind::share, PlainQuantity::elements_full, true, false}},
    TomlChoice<KindOf>{"photometry", {Kind::photometry, PlainQuantity::elements_full, false, false}},
    TomlChoice<KindOf>{"elements_full", plain(PlainQuantity::elements_full)},
    TomlChoice<KindOf>{"elements_partial", plain(PlainQuantity::elements_partial)},
    TomlChoice<KindOf>{"element_depth_mm", plain(PlainQuantity::element_depth_mm)},
    TomlChoice<KindOf>{"lens_thickness_mm", plain(PlainQuantity::lens_thickness_mm)},
    TomlChoice<KindOf>{"facet_area_mm2", plain(PlainQuantity::facet_area_mm2)},
    TomlChoice<KindOf>{"effective_area_mm2", plain(PlainQuantity::effective_area_mm2)},
    TomlChoice<KindOf>{"entrance_area_mm2", plain(PlainQuantity::entrance_area_mm2)},
    TomlChoice<KindOf>{"full_element_share", plain(PlainQuantity::full_element_share)},
    TomlChoice<KindOf>{"tir_limit_deg", plain(PlainQuantity::tir_limit_deg)},
    TomlChoice<KindOf>{"tool_fit_mm", plain(PlainQuantity::tool_fit_mm)},
    TomlChoice<KindOf>{"machining_time_h", plain(PlainQuantity::machining_time_h)},
    TomlChoice<KindOf>{"machining_time_per_element_s", plain(PlainQuantity::machining_time_per_element_s)},
    TomlChoice<KindOf>{"area_rate_mm2_per_h", plain(PlainQuantity::area_rate_mm2_per_h)},
    TomlChoice<KindOf>{"process_sa_nm", plain(PlainQuantity::process_sa_nm)},
    TomlChoice<KindOf>{"root_radius_um", plain(PlainQuantity::root_radius_um)}};
constexpr std::array kReductions = {TomlChoice<Reduction>{"mean", Reduction::mean},
                                    TomlChoice<Reduction>{"least", Reduction::least}};
constexpr std::array kWeightings = {TomlChoice<bool>{"uniform", false}, TomlChoice<bool>{"solid_angle", true}};
constexpr std::array kFigures = {TomlChoice<PhotometricFigure>{"margin", PhotometricFigure::margin},
                                 TomlChoice<PhotometricFigure>{"r_i_mcd_per_lx", PhotometricFigure::r_i_mcd_per_lx},
                                 TomlChoice<PhotometricFigure>{"r_a", PhotometricFigure::r_a}};
constexpr std::array kPoints = {TomlChoice<bool>{"worst", false}, TomlChoice<bool>{"each", true}};
constexpr std::array kLights = {TomlChoice<bool>{"a", false}, TomlChoice<bool>{"design", true}};
constexpr std::array kFarFields = {TomlChoice<bool>{"geometric", false}, TomlChoice<bool>{"diffracted", true}};
constexpr NumberRange kIncidence{.low = -90.0, .low_included = false, .high = 90.0, .high_included = false};
constexpr NumberRange kAnyAngle{};
constexpr NumberRange kHalfAngle{.low = 0.0, .low_included = false, .high = 90.0};
constexpr double kMostDirections = 10000.0;

/// The middles of `count` equal parts of a range: their mean is that over the range to second order.
std::vector<double> middles(TomlTable window, const NumberRange& allowed) {
  const double from = window.required_number("from", allowed);
  const double to = window.required_number("to", allowed);
  if (!(to > from)) window.fail("to", fmt::format("must be > from ({}), got {}", shortest(from), shortest(to)));
  const double count = window.required_number("count", {.low = 1.0, .high = kMostDirections});
  if (count != std::floor(count)) window.fail("count", fmt::format("must be a whole number, got {}", shortest(count)));
  window.finish();
  std::vector<double> values;
  for (double k = 0.5; k < count; ++k) values.push_back(from + (to - from) * k / count);
  return values;
}

std::optional<std::vector<double>> read_angles(TomlTable& quantity, std::string_view key, const NumberRange& allowed) {
  if (quantity.shape_of(key) == TomlTable::Shape::table) return middles(quantity.table(key), allowed);
  return quantity.number_or_numbers(key, allowed);
}

std::size_t read_account(TomlTable& quantity) {
  return quantity.required_choice("account", raytrace::kAccountNames);
}

ShareSpec read_share(TomlTable& quantity, const KindOf& kind) {
  ShareSpec spec;
  spec.window.incidence_deg = read_angles(quantity, "incidence_deg", kIncidence);
  spec.window.azimuth_deg = read_angles(quantity, "azimuth_deg", kAnyAngle);
  spec.window.by_solid_angle = quantity.choice("weighting", all(kWeightings)).value_or(false);
  spec.reduction = quantity.choice("over_directions", all(kReductions)).value_or(Reduction::mean);
  if (spec.window.by_solid_angle && spec.reduction == Reduction::least)
    quantity.fail("weighting", "means nothing for the least of all directions");
  if (kind.any_account) spec.account = read_account(quantity);
  if (kind.far_field) {
    spec.beyond_half_angle_deg = quantity.required_number("from_deg", kHalfAngle);
    spec.acceptance_half_angle_deg = quantity.required_number("to_deg", kHalfAngle);
    if (!(*spec.acceptance_half_angle_deg > *spec.beyond_half_angle_deg))
      quantity.fail("to_deg", fmt::format("must be > from_deg ({}), got {}", shortest(*spec.beyond_half_angle_deg),
                                          shortest(*spec.acceptance_half_angle_deg)));
  } else {
    spec.acceptance_half_angle_deg = quantity.number("acceptance_half_angle_deg", kHalfAngle);
  }
  return spec;
}

/// \throw InputError that says `--class` as the key `class` of the quantity
template <class Work>
auto with_keys(const TomlTable& quantity, Work work) {
  try {
    return work();
  } catch (const InputError& error) {
    const std::string text = error.what();
    const std::size_t end = text.find(": ");
    if (!text.starts_with("--") || end == std::string::npos) throw;
    std::string key = text.substr(2, end - 2);
    std::replace(key.begin(), key.end(), '-', '_');
    quantity.fail(key, text.substr(end + 2));
  }
}

std::shared_ptr<const PhotometricTable> read_photometric_table(TomlTable& quantity,
                                                               std::vector<std::filesystem::path>& files) {
  PhotometricTable table;
  StandardChoice choice;
  // A word is a shipped standard; anything else a file.
  const std::optional<std::string> standard = quantity.text("standard");
  if (!standard) quantity.fail("standard", "missing, must be r150, j594, bicycle or the name of a limits file");
  choice.standard = *standard;
  if (find_standard(*standard) == nullptr) {
    files.push_back(*quantity.file("standard"));
    choice.standard = files.back().string();
  }
  choice.part_class = quantity.text("class");
  choice.colour = quantity.text("colour");
  table.request = with_keys(quantity, [&] { return photometry_request(choice); });
  PhotometryRequest& request = table.request;
  request.area_cm2 = quantity.required_number("area_cm2", {.low = 0.0, .low_included = false, .high = 1e6});
  if (const auto turns = quantity.number_or_numbers("rotation_deg")) request.rotation_deg = *turns;
  request.window_deg = quantity.number("window_deg", {.low = 0.05, .high = 10.0}).value_or(request.window_deg);
  for (const TestPoint& point : request.programme.points)
    if (point.observation_deg > request.window_deg)
      quantity.fail("window_deg", fmt::format("must be >= {}, an observation angle of the standard, got {}",
                                              shortest(point.observation_deg), shortest(request.window_deg)));
  request.own_light = quantity.choice("light", all(kLights)).value_or(false);
  request.diffraction = quantity.choice("far_field", all(kFarFields)).value_or(true);
  request.advice = false;
  const std::optional<std::string> dye = quantity.text("dye");
  const std::filesystem::path dye_file =
      with_keys(quantity, [&] { return dye_file_of(dye, false, request.programme.colour); });
  if (dye && dye_file == *dye) files.push_back(dye_file);  // not a shipped one
  set_dye(request, dye, dye_file);
  table.dye_unless_coloured = !dye;
  table.key = fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}", choice.standard, choice.part_class.value_or(""),
                          request.programme.colour, request.area_cm2, fmt::join(request.rotation_deg, " "),
                          request.window_deg, request.own_light, request.diffraction, dye.value_or("(by colour)"));
  return std::make_shared<const PhotometricTable>(std::move(table));
}

Quantities read_photometric(TomlTable& quantity, const std::string& name, std::vector<std::filesystem::path>& files) {
  const PhotometricFigure figure = quantity.choice("figure", all(kFigures)).value_or(PhotometricFigure::margin);
  const auto table = read_photometric_table(quantity, files);
  const std::size_t points = table->request.programme.points.size();
  Quantities result;
  if (quantity.shape_of("points") == TomlTable::Shape::text) {
    if (!*quantity.choice("points", all(kPoints))) return {make_photometric(name, table, {}, figure)};
    for (std::size_t k = 0; k < points; ++k)
      result.push_back(make_photometric(fmt::format("{}.{}", name, k + 1), table, k, figure));
    return result;
  }
  const std::optional<double> point = quantity.number("points", {.low = 1.0, .high = static_cast<double>(points)});
  if (point && *point != std::floor(*point))
    quantity.fail("points", fmt::format("must be a whole number, got {}", shortest(*point)));
  return {make_photometric(name, table, point ? std::optional(static_cast<std::size_t>(*point) - 1) : std::nullopt,
                           figure)};
}

KindOf required_kind(TomlTable& quantity) {
  const auto kind = quantity.choice("kind", all(kKinds));
  if (kind) return *kind;
  std::vector<std::string_view> words;
  for (const TomlChoice<KindOf>& each : kKinds) words.push_back(each.word);
  quantity.fail("kind", "missing, must be " + alternatives(words));
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

Quantities read_quantity(TomlTable quantity, std::vector<std::filesystem::path>& files) {
  const KindOf kind = required_kind(quantity);
  const std::string name = quantity.text("name").value_or(quantity.text("kind").value_or(""));
  if (!is_name(name))
    quantity.fail("name",
                  fmt::format("must be of letters, digits, \"_\" and \".\", at most 64, got {}", in_quotes(name)));
  Quantities result;
  switch (kind.kind) {
    case Kind::share:
      result.push_back(make_share(name, read_share(quantity, kind)));
      break;
    case Kind::plain:
      result.push_back(make_plain(name, kind.plain));
      break;
    case Kind::photometry:
      result = read_photometric(quantity, name, files);
      break;
  }
  quantity.finish();
  return result;
}

}  // namespace retrace::studies
