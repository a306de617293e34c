#include <fmt/format.h>

#include <string>
#include <string_view>

#include "core/number_format.h"
#include "design/haze.h"
#include "design/io/entrance_checks.h"

namespace retrace::design {
namespace {

using schema::Document;

constexpr std::string_view kEntranceFace = "entrance";
constexpr std::string_view kThickLayers = "entrance.layers";
constexpr std::size_t kMaxThickLayers = 20;

std::string key_of(std::string_view name) {
  return "entrance." + std::string(name);
}

/// Checks that an amount above 0 is given together with the key that describes its properties.
void require_beside(const Document& document, std::string_view amount, std::string_view needed) {
  if (document.number(key_of(amount)) > 0.0 && !(document.number_if(key_of(needed)).value_or(-1.0) >= 0.0))
    document.fail(key_of(needed), fmt::format("is required, because {} is given", amount));
}

void check_haze(const Document& document) {
  const double haze = document.number("entrance.haze");
  if (!(haze > 0.0)) return;
  const double most = beyond_haze_angle(document.number("entrance.haze_spread_deg"));
  if (haze > most)
    document.fail(
        "entrance.haze",
        fmt::format("must be <= {}, the fraction of the lobe beyond 2.5 degrees for this haze_spread_deg, got {}",
                    fixed_apart(most, haze, 6), shortest(haze)));
}

void check_roughness_of_face(const Document& document) {
  if (!(document.number("entrance.roughness_sq_nm") > 0.0)) return;
  const double length_um = document.number("entrance.correlation_length_um");
  if (!(length_um > 0.0))
    document.fail("entrance.correlation_length_um",
                  "must be > 0 because roughness_sq_nm is given, got " + shortest(length_um));
  if (document.count(kThickLayers) > 0 || document.number("entrance.film_coverage") > 0.0)
    document.fail(
        "entrance.roughness_sq_nm",
        "must be 0 if layers or film_coverage are given, because layers and films fill the valleys of the roughness");
}

/// Returns the first key of the table [entrance] that makes the face scatter light. Returns an empty text if there is
/// none.
std::string_view scattering_key(const Document& document) {
  for (const std::string_view key : {"entrance.drop_coverage", "entrance.dust_coverage", "entrance.scratch_coverage",
                                     "entrance.haze", "entrance.roughness_sq_nm"})
    if (document.number(key) > 0.0) return key;
  return {};
}

}  // namespace

void check_entrance_face(const Document& document) {
  if (!document.has(kEntranceFace)) return;
  if (document.text("idealisation.entrance") == "lossless")
    document.fail(kEntranceFace, "not allowed together with idealisation.entrance = \"lossless\"");
  if (const std::size_t count = document.count(kThickLayers); count > kMaxThickLayers)
    document.fail(kThickLayers, fmt::format("must have at most {} layers, got {}", kMaxThickLayers, count));
  require_beside(document, "drop_coverage", "drop_contact_angle_deg");
  require_beside(document, "dust_coverage", "dust_albedo");
  require_beside(document, "dust_coverage", "dust_forward_fraction");
  require_beside(document, "scratch_coverage", "scratch_spread_deg");
  require_beside(document, "haze", "haze_spread_deg");
  const double spots = document.number("entrance.drop_coverage") + document.number("entrance.dust_coverage") +
                       document.number("entrance.scratch_coverage");
  if (spots > 1.0)
    document.fail(
        scattering_key(document),
        fmt::format("drop_coverage, dust_coverage and scratch_coverage must add up to at most 1, but their sum is {}",
                    shortest(spots)));
  check_haze(document);
  check_roughness_of_face(document);
  if (const std::string_view key = scattering_key(document); document.has("entrance_surface") && !key.empty())
    document.fail(
        key,
        "must be 0 together with an [entrance_surface]: curved entrance faces support only layers and film_coverage");
}

}  // namespace retrace::design
