#include "design/io/optics_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "core/number_format.h"

namespace retrace::design {
namespace {

using schema::Document;

constexpr std::size_t kMaxLayers = 200;

void refuse_heights(const Document& document, std::initializer_list<std::string_view> keys, std::string_view why) {
  for (const std::string_view key : keys)
    if (document.number(key) != 0.0) document.fail(key, fmt::format("{}, got {}", why, shortest(document.number(key))));
}

std::size_t count_opaque(const Document& document, std::string_view list) {
  std::size_t opaque = 0;
  for (std::size_t i = 0; i < document.count(list); ++i)
    if (!document.has(schema::path_of_entry(list, i) + ".thickness_nm")) ++opaque;
  return opaque;
}

}  // namespace

/// Checks that every rms height comes with its correlation length or period.
void check_lengths(const Document& document) {
  for (const auto& [height, length] : {std::pair(kRoughness, kRoughnessLength), {kWaviness, kWavinessLength}})
    if (document.number(height) > 0.0 && !(document.number(length) > 0.0))
      document.fail(length,
                    fmt::format("must be > 0 because {} is given{}, got {}", height.substr(height.find('.') + 1),
                                length == kRoughnessLength ? " (5 to 50 is common)" : "", document.number(length)));
}

void check_heights(const Document& document) {
  const std::string model = document.text_if("surface.model");
  if (model == "height_map")
    refuse_heights(document, {kRoughness, kWaviness},
                   "must be 0 for surface.model = \"height_map\", because the map contains roughness and waviness");
  if (model == "smooth" || model == "abg")
    refuse_heights(document, {kRoughness, kWaviness},
                   "must be 0 for this surface.model; leave surface.model out or use \"harvey_shack\"");
  if (model == "microfacet")
    refuse_heights(document, {kRoughness},
                   "must be 0 for surface.model = \"microfacet\", which supports only waviness");
}

void check_material(const Document& document) {
  if (document.text("body.material").empty())
    document.fail("body.material", "must be the name of a material, such as \"PMMA\", got \"\"");
}

namespace {

/// Checks that an absorption coefficient given as a function of wavelength is a valid curve.
void check_absorption_at(const Document& document, std::string_view key) {
  if (!document.is_list(key)) return;
  const std::vector<std::vector<double>> curve = document.rows(key);
  for (std::size_t k = 1; k < curve.size(); ++k)
    if (!(curve[k][0] > curve[k - 1][0]))
      document.fail(key, fmt::format("the wavelengths must be in ascending order, got {} nm after {} nm",
                                     shortest(curve[k][0]), shortest(curve[k - 1][0])));
  if (curve.size() < 2) document.fail(key, "must be a number or a list of two or more pairs, got a list of one pair");
}

/// Checks a shell in front of an infinite array. It must be plane-parallel and must not be tilted.
void check_unbounded_shell(const Document& document, const std::string& shell) {
  constexpr std::string_view why = "not allowed in front of an infinite array: the shell must be plane-parallel";
  for (const std::string_view name : {"outer_radius_mm", "inner_radius_mm"})
    if (document.has(schema::path_in(shell, name))) document.fail(schema::path_in(shell, name), why);
  for (const std::string_view name : {"wedge_deg", "tilt_deg"}) {
    const std::string key = schema::path_in(shell, name);
    for (const double angle_deg : document.numbers(key))
      if (angle_deg != 0.0)
        document.fail(key, "must be [0, 0] in front of an infinite array, got the angle " + shortest(angle_deg));
  }
}

}  // namespace

void check_absorption(const Document& document) {
  check_absorption_at(document, kAbsorption);
}

void check_shells(const Document& document) {
  constexpr std::size_t max_shells = 4;
  const std::size_t count = document.count("shell");
  if (count == 0) return;
  if (count > max_shells) document.fail("shell", fmt::format("must be at most {}, got {}", max_shells, count));
  if (document.text("idealisation.entrance") == "lossless")
    document.fail("shell", "not allowed together with idealisation.entrance = \"lossless\"");
  for (std::size_t k = 0; k < count; ++k) {
    const std::string shell = schema::path_of_entry("shell", k);
    for (const std::string_view name : {"outer_radius_mm", "inner_radius_mm"})
      if (const std::string key = schema::path_in(shell, name); document.number_if(key) == 0.0)
        document.fail(key, "must not be 0: leave it out for a plane surface, got 0");
    check_absorption_at(document, schema::path_in(shell, "absorption_per_mm"));
    if (document.text_if("array.extent") == "infinite") check_unbounded_shell(document, shell);
  }
}

void check_lines(const Document& document) {
  constexpr std::string_view key = "light.spectrum";
  if (!document.is_list(key)) return;
  std::vector<double> wavelengths_nm;
  for (const std::vector<double>& line : document.rows(key)) wavelengths_nm.push_back(line[0]);
  std::ranges::sort(wavelengths_nm);
  const auto twice = std::ranges::adjacent_find(wavelengths_nm);
  if (twice != wavelengths_nm.end())
    document.fail(key, fmt::format("must contain each wavelength only once, got {} twice", shortest(*twice)));
}

void check_stokes(const Document& document) {
  constexpr std::string_view key = "light.polarisation";
  if (!document.is_list(key)) return;
  const std::vector<double> given = document.numbers(key);
  constexpr double rounding = 1e-12;
  double degree2 = 0.0;
  for (std::size_t k = 1; k < given.size(); ++k) degree2 += given[k] / given[0] * (given[k] / given[0]);
  if (!(given[0] > 0.0 && degree2 <= 1.0 + rounding))
    document.fail(key, fmt::format("must be [i, q, u, v] with i > 0 and q^2 + u^2 + v^2 <= i^2, got [{}, {}, {}, {}]",
                                   shortest(given[0]), shortest(given[1]), shortest(given[2]), shortest(given[3])));
}

/// Checks that balls with a bowl behind them have a mirror.
void check_ball_mirror(const Document& document) {
  constexpr std::string_view key = "element.mirror_offset_mm";
  if (!document.has(key) || document.number(key) == 0.0 || document.count(kFacetLayers) > 0) return;
  if (document.text("body.facet_coating") == "aluminium" || document.text("idealisation.facets") == "mirror") return;
  document.fail(key,
                "a value above 0 requires a mirror: give body.facet_coating = \"aluminium\", or idealisation.facets = "
                "\"mirror\"");
}

void check_wet_back(const Document& document) {
  if (!document.has("wet_back")) return;
  constexpr std::string_view key = "wet_back.index";
  if (document.text("array.extent") == "infinite")
    document.fail(key,
                  "[wet_back] is not allowed for array.extent = \"infinite\", because all elements of an infinite "
                  "array are equal: give x_length_mm and y_length_mm instead");
  if (document.text("array.arrangement") == "single")
    document.fail(key, "[wet_back] is not allowed for array.arrangement = \"single\": give body.back_index");
  if (document.has("substrate")) document.fail(key, "[wet_back] is not allowed together with [substrate]");
  const auto given = [&](std::string_view list) { return fmt::format("{}", fmt::join(document.numbers(list), ", ")); };
  if (document.has("wet_back.rectangle_mm")) {
    const std::vector<double> r = document.numbers("wet_back.rectangle_mm");
    if (!(r[0] < r[2] && r[1] < r[3]))
      document.fail("wet_back.rectangle_mm",
                    "must be x_min, y_min, x_max, y_max with x_min < x_max and y_min < y_max, got " +
                        given("wet_back.rectangle_mm"));
  }
  if (document.has("wet_back.disc_mm") && !(document.numbers("wet_back.disc_mm")[2] > 0.0))
    document.fail("wet_back.disc_mm", "must have a radius > 0, got " + given("wet_back.disc_mm"));
}

void check_layers(const Document& document) {
  for (const std::string_view list : {kFacetLayers, kEntranceLayers}) {
    const std::size_t count = document.count(list);
    if (count > kMaxLayers) document.fail(list, fmt::format("must have at most {} layers, got {}", kMaxLayers, count));
    for (std::size_t i = 0; i < count; ++i) {
      const std::string key = schema::path_of_entry(list, i) + ".thickness_nm";
      if (document.has(key)) continue;
      if (list == kEntranceLayers)
        document.fail(key,
                      "is missing: a layer without thickness_nm is opaque, but light must pass through the layers on "
                      "the entrance face");
      const auto extinction = document.number_if(schema::path_of_entry(list, i) + ".extinction_coefficient");
      if (extinction && !(*extinction > 0.0))
        document.fail(key,
                      "is missing: it may be left out only for a metal or for a layer with extinction_coefficient > 0");
    }
  }
  if (const std::size_t opaque = count_opaque(document, kFacetLayers); opaque > 1)
    document.fail(kFacetLayers,
                  fmt::format("must have at most one layer without thickness_nm, which is opaque, got {}", opaque));
}

/// Checks that no coating is given by two keys, and that no coating is given together with a key that it makes
/// ineffective.
void check_coating(const Document& document) {
  if (document.count(kFacetLayers) > 0) {
    if (document.text("body.facet_coating") != "none")
      document.fail(kFacetLayers, "not allowed together with body.facet_coating: give the aluminium as a layer");
    if (document.text("idealisation.facets") == "mirror")
      document.fail(kFacetLayers, "not allowed together with idealisation.facets = \"mirror\"");
    if (document.text_if("element.kind") == "ball" && count_opaque(document, kFacetLayers) == 0)
      document.fail(kFacetLayers,
                    "one opaque layer (a layer without thickness_nm) is required for element.kind = \"ball\": the "
                    "layers behind balls must form a mirror");
  }
  if (document.count(kEntranceLayers) > 0 && document.text("idealisation.entrance") == "lossless")
    document.fail(kEntranceLayers, "not allowed together with idealisation.entrance = \"lossless\"");
}

}  // namespace retrace::design
