#include "studies/rays/io/ray_documents.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/json_text.h"
#include "core/number_format.h"
#include "design/io/design_json.h"
#include "studies/rays/ray_accounts.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;

Json triple(const Vec3& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

Json source_json(const RayResult& result) {
  Json json;
  if (result.emitter) {
    const Emitter& emitter = *result.emitter;
    json = {{"emitter", kEmitterNames[static_cast<std::size_t>(emitter.kind)]}};
    if (emitter.period_mm)
      json["period_mm"] = {(*emitter.period_mm)[0].norm(), (*emitter.period_mm)[1].norm()};
    else
      json["disc_mm"] = emitter.disc_mm;
    json["half_angle_deg"] = emitter.half_angle_deg;
  } else if (!result.source_name.empty()) {
    json = {{"file", result.source_name}, {"spectral_identifier", static_cast<int>(result.source.spectrum)}};
  }
  json["has_stokes"] = result.source.has_stokes;
  json["at_mm"] = triple(result.placement.at_mm);
  json["x_axis"] = triple(result.placement.part_from_source.col(0));
  json["z_axis"] = triple(result.placement.part_from_source.col(2));
  return json;
}

/// Returns the power of an account of the ledger, or the power of rays that miss the part for kMissedAccount.
double power_in(const raytrace::RayLedger& ledger, std::size_t account) {
  return account == kMissedAccount ? ledger.missed : ledger.ledger.power[account];
}

std::uint64_t rays_in(const raytrace::RayLedger& ledger, std::size_t account) {
  return account == kMissedAccount ? ledger.rays_missed : ledger.leaving[account];
}

/// Accounts of light that is no longer traced. They are listed only if their power is not 0.
constexpr raytrace::Account kUntracedAccounts[] = {raytrace::Account::shell_reflected, raytrace::Account::stopped};

std::string_view name_of(raytrace::Account account) {
  return raytrace::kAccountNames[static_cast<std::size_t>(account)];
}

const char* unit_of(RayPower power) {
  return power == RayPower::luminous_lm ? "lm" : "W";
}

}  // namespace

std::string rays_json(const RayResult& result) {
  const raytrace::RayLedger& ledger = result.ledger;
  Json json = {
      {"design", design::to_json(result.design)}, {"seed", result.request.seed}, {"source", source_json(result)}};
  json["split"] = result.request.split;
  json["cutoff"] = result.request.cutoff;
  json["acceptance_half_angle_deg"] = result.acceptance_half_angle_deg;
  json["wavelengths_nm"] = Json::array({result.shortest_nm, result.longest_nm});
  json["rays"] = ledger.rays;
  json["power_unit"] = unit_of(result.power);
  json["power"] = ledger.incident;
  Json shares;
  Json leaving;
  for (std::size_t k = 0; k < kRayAccounts.size(); ++k) {
    shares[std::string(kRayAccounts[k])] = ledger.incident > 0.0 ? power_in(ledger, k) / ledger.incident : 0.0;
    if (rays_in(ledger, k) > 0) leaving[std::string(kRayAccounts[k])] = rays_in(ledger, k);
  }
  for (const raytrace::Account account : kUntracedAccounts)
    if (ledger.ledger[account] > 0.0) shares[std::string(name_of(account))] = ledger.ledger[account] / ledger.incident;
  json["ledger"] = shares;
  json["std_error"] = ledger.std_error();
  json["leaving"] = leaving.is_null() ? Json::object() : leaving;
  if (!result.out_name.empty()) json["out"] = {{"file", result.out_name}, {"rays", result.rays_out}};
  json["elapsed_s"] = result.elapsed_s;
  return result_text("retrace.rays/1", std::move(json), result.warnings, result.complete);
}

std::string rays_table(const RayResult& result) {
  const raytrace::RayLedger& ledger = result.ledger;
  const char* const unit = unit_of(result.power);
  std::string table = fmt::format("{} rays of {:.6g} {}\n", ledger.rays, ledger.incident, unit);
  table += fmt::format("{:<20}{:>10}{:>14}{:>12}\n", "account", "share_%", fmt::format("power_{}", unit), "rays_out");
  const auto add = [&](std::string_view account, double power, std::uint64_t rays) {
    const double share = ledger.incident > 0.0 ? power / ledger.incident : 0.0;
    if (power == 0.0 && rays == 0) return;
    table += fmt::format("{:<20}{:>10}{:>14.6g}{:>12}\n", account, fixed(100.0 * share, 4), power, rays);
  };
  for (std::size_t k = 0; k < kRayAccounts.size(); ++k) add(kRayAccounts[k], power_in(ledger, k), rays_in(ledger, k));
  for (const raytrace::Account account : kUntracedAccounts) add(name_of(account), ledger.ledger[account], 0);
  return table + fmt::format("{:<20}{:>10}\n", "std_error", fixed(100.0 * ledger.std_error(), 4));
}

}  // namespace retrace::studies
