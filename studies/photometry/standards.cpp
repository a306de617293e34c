#include "studies/photometry/standards.h"

#include <algorithm>
#include <array>

namespace retrace::studies {
namespace {

raytrace::PhotometricApertures arcmin(double source, double receiver) {
  return {Angle::from_deg(source / 60.0), Angle::from_deg(receiver / 60.0)};
}

/// Returns twelve rotations over a full circle, for parts that may be mounted in any orientation.
std::vector<double> all_round() {
  std::vector<double> turns;
  for (int k = 0; k < 12; ++k) turns.push_back(30.0 * k);
  return turns;
}

}  // namespace

std::span<const ShippedStandard> shipped_standards() {
  // Apertures of 50 mm and 13 x 25 mm at 30.5 m. The rectangle is replaced by a disc of the same area.
  static const std::array<ShippedStandard, 6> all = {{
      {"r150",
       "UN R3 / R150",
       "UN Regulations 3 and 150, reflex reflectors",
       arcmin(10.0, 10.0),
       {0.0},
       "apertures of 10 minutes of arc; rotation 0; V = 5 and -5 instead of 0 if the face reflects the lamp to the "
       "receiver"},
      {"j594", "SAE J594 / FMVSS 108 XVI-a", "SAE J594 and FMVSS 108 table XVI-a, reflex reflectors", arcmin(5.6, 2.3),
       all_round(),
       "source of 50 mm and receiver of 13 x 25 mm at 30.5 m, according to a summary of J594-2018; minimum over a full "
       "rotation, as for parts that may be mounted in any orientation"},
      {"bicycle",
       "16 CFR 1512",
       "16 CFR 1512.16, bicycle reflectors",
       arcmin(10.0, 10.0),
       {0.0},
       "unconfirmed: apertures of 10 minutes of arc as in CIE 54.2, because those of the regulation are not known; "
       "rotation 0"},
      {"d4956",
       "ASTM D4956",
       "ASTM D4956-01, retroreflective sheeting for traffic control",
       arcmin(10.0, 10.0),
       {0.0},
       "unconfirmed: apertures of 10 minutes of arc as in CIE 54.2; rotation 0"},
      {"iso20471",
       "ISO 20471",
       "ISO 20471, separate performance retroreflective material of high visibility clothing",
       arcmin(10.0, 10.0),
       {0.0},
       "unconfirmed: apertures of 10 minutes of arc as in CIE 54.2; rotation 0"},
      {"stvzvo",
       "StVZVO 1998",
       "Austrian StVZVO 1998, sheeting of road signs (until 2013)",
       arcmin(10.0, 10.0),
       {0.0},
       "unconfirmed: apertures of 10 minutes of arc as in CIE 54.2; rotation 0"},
  }};
  return all;
}

const ShippedStandard* find_standard(std::string_view name) {
  const auto all = shipped_standards();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const ShippedStandard& standard) { return standard.name == name; });
  return found == all.end() ? nullptr : &*found;
}

raytrace::PhotometricApertures default_apertures() {
  return arcmin(10.0, 10.0);
}

}  // namespace retrace::studies
