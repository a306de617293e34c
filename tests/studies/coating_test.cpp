// Tests of designs with layers on faces: documents, optical properties at each wavelength, and inspection.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/infinity.h"
#include "design/io/design_document.h"
#include "design/optical_model.h"
#include "materials/io/material_library.h"
#include "materials/io/spectrum_reader.h"
#include "studies/inspect/inspect.h"
#include "studies/inspect/io/inspect_files.h"
#include "studies/rre/rre.h"
#include "tests/studies/design_texts.h"
#include "tests/support/refusals.h"

namespace retrace::studies::coating_test {
namespace {

const materials::MaterialLibrary& library() {
  static const materials::MaterialLibrary shipped = materials::MaterialLibrary::shipped();
  return shipped;
}

std::string coating(const std::string& lines) {
  return with_line(11, "[coating]\n" + lines);
}

design::Design read(const std::string& lines, const std::vector<std::string>& overrides = {}) {
  return design::parse_design(coating(lines), "d.toml", overrides);
}

const std::string kProtected =
    "facets = [{ material = \"aluminium\", thickness_nm = 90 }, { refractive_index = 1.5, thickness_nm = 2000 }]\n";
const std::string kCoated = "entrance = [{ material = \"MgF2\", thickness_nm = 99.8 }]\n";

TEST(Coating, LayersAreReadFromTheBodyOutwards) {
  const design::Coating given = read(kProtected + kCoated).surface.coating;
  ASSERT_EQ(given.facets.size(), 2U);
  EXPECT_EQ(given.facets[0].material, "aluminium");
  EXPECT_EQ(given.facets[0].thickness_nm, 90.0);
  EXPECT_EQ(given.facets[1].material, "");
  EXPECT_EQ(given.facets[1].refractive_index, 1.5);
  EXPECT_EQ(given.facets[1].extinction_coefficient, 0.0);
  ASSERT_EQ(given.entrance.size(), 1U);
  EXPECT_FALSE(given.has_opaque_facets());
  EXPECT_TRUE(read(kProtected).needs_total_reflection());
  EXPECT_FALSE(read("facets = [{ material = \"silver\" }]").needs_total_reflection());
}

TEST(Coating, WhatIsWrongIsRefusedWithItsPlace) {
  const auto refused = [](const std::string& lines) { return complaint(coating(lines)); };
  const std::string many = "{ refractive_index = 1.5, thickness_nm = 1 }";
  std::string list = many;
  for (int k = 0; k < 200; ++k) list += ", " + many;
  expect_refusals(
      refused,
      {{"facets = 3", "d.toml:12: coating.facets"},
       {"facets = [{ thickness_nm = 100 }]", "d.toml:12: coating.facets[1]"},
       {"facets = [{ material = \"MgF2\", refractive_index = 1.4, thickness_nm = 100 }]",
        "d.toml:12: coating.facets[1].refractive_index"},
       {"facets = [{ material = \"MgF2\", extinction_coefficient = 0.1, thickness_nm = 100 }]",
        "d.toml:12: coating.facets[1].extinction_coefficient"},
       {"facets = [{ refractive_index = 0, thickness_nm = 100 }]", "d.toml:12: coating.facets[1].refractive_index"},
       {"facets = [{ refractive_index = 1.5, extinction_coefficient = -1, thickness_nm = 100 }]",
        "d.toml:12: coating.facets[1].extinction_coefficient"},
       {"entrance = [{ material = \"MgF2\", thickness_nm = -1 }]", "d.toml:12: coating.entrance[1].thickness_nm"},
       {"entrance = [{ material = \"silver\" }]", "d.toml:12: coating.entrance[1].thickness_nm"},
       {"facets = [{ refractive_index = 1.5 }]", "d.toml:12: coating.facets[1].thickness_nm"},
       {"facets = [{ material = \"silver\" }, { material = \"aluminium\" }]", "d.toml:12: coating.facets"},
       {"facets = [" + list + "]", "d.toml:12: coating.facets"}});
  EXPECT_EQ(refused("back = [{ material = \"MgF2\", thickness_nm = 1 }]"), "d.toml:12: coating.back");
  EXPECT_EQ(refused("facets = [{ material = \"MgF2\", thickness_um = 1 }]"),
            "d.toml:12: coating.facets[1].thickness_um");
}

TEST(Coating, WhatWouldNotCountIsRefused) {
  const auto refused = [](const std::string& set) { return complaint(coating(kProtected + kCoated), {set}); };
  expect_refusals(refused, {{"body.facet_coating=aluminium", "d.toml:12: coating.facets"},
                            {"idealisation.facets=mirror", "d.toml:12: coating.facets"},
                            {"idealisation.entrance=lossless", "d.toml:13: coating.entrance"},
                            {"body.facet_coating=none", ""}});
  // Balls can only have a mirror.
  const std::string balls = "[element]\nkind = \"ball\"\ndiameter_mm = 1\n[coating]\n";
  EXPECT_EQ(complaint(balls + kProtected), "d.toml:5: coating.facets");
  EXPECT_EQ(complaint(balls + kCoated), "d.toml:5: coating.entrance");
  EXPECT_EQ(
      complaint(balls + "facets = [{ material = \"fused-silica\", thickness_nm = 50 }, { material = \"silver\" }]\n"),
      "");
}

TEST(Coating, UnknownMaterialsAreRefusedWithTheirPlace) {
  const auto refused = [](const std::string& lines) {
    return refusal_of([&] { design::make_light_model(read(lines), library()); });
  };
  EXPECT_EQ(refused("facets = [{ material = \"gold\", thickness_nm = 5 }]"), "d.toml:12: coating.facets[1].material");
  EXPECT_EQ(refused("facets = [{ material = \"fused-silica\" }]"), "d.toml:12: coating.facets[1].thickness_nm");
  EXPECT_EQ(refused("entrance = [{ material = \"PMMA-Sultanova\", thickness_nm = 5 }]"), "");
}

TEST(Coating, DesignsAreWrittenAsTheyWereRead) {
  for (const std::string& lines :
       {kProtected + kCoated, kCoated, std::string("facets = [{ material = \"silver\" }]\n")}) {
    const design::Design design = read(lines);
    const design::Design again = design::parse_design(design::design_text(design), "again.toml");
    EXPECT_EQ(again.surface.coating.facets, design.surface.coating.facets);
    EXPECT_EQ(again.surface.coating.entrance, design.surface.coating.entrance);
  }
  // A single layer of aluminium is always written with the key facet_coating.
  const std::string text = design::design_text(read("facets = [{ material = \"aluminium\" }]\n" + kCoated));
  EXPECT_NE(text.find("facet_coating = \"aluminium\""), std::string::npos) << text;
  EXPECT_EQ(text.find("facets = "), std::string::npos) << text;
}

// Both ways to specify aluminium give the same results.
TEST(Coating, AnOpaqueLayerOfAluminiumIsTheFacetCoating) {
  const auto rre = [](const design::Design& design) {
    RreSettings request;
    request.incidence_deg = {0.0, 30.0};
    return RreStudy({design}, request).run();
  };
  const RreResult one = rre(set({"body.facet_coating=aluminium"}));
  const RreResult other = rre(read("facets = [{ material = \"aluminium\" }]"));
  ASSERT_EQ(one.points.size(), other.points.size());
  for (std::size_t k = 0; k < one.points.size(); ++k) {
    EXPECT_EQ(one.points[k].rre, other.points[k].rre);
    EXPECT_EQ(one.points[k].ledger.power, other.points[k].ledger.power);
  }
}

// Indices and thicknesses are converted for each wavelength, relative to the air around the part.
TEST(Coating, OpticsAreThoseOfEachWavelength) {
  const design::OpticalModel model =
      design::make_light_model(read(kProtected + kCoated, {"light.spectrum=[[450, 1], [650, 1]]"}), library());
  ASSERT_EQ(model.spectral.size(), 2U);
  for (const design::SpectralOptics& at : model.spectral) {
    const double air = materials::refractive_index(library().air().dispersion, at.wavelength_nm);
    const materials::LayerStack& facets = at.optics.facet_layers;
    ASSERT_EQ(facets.layers.size(), 2U);
    EXPECT_EQ(facets.layers[0].index,
              materials::complex_index(library().find_metal("aluminium").model, at.wavelength_nm) / air);
    EXPECT_NEAR(facets.layers[0].thickness, 90.0 / (at.wavelength_nm / air), 1e-12);
    EXPECT_EQ(facets.layers[1].index, 1.5);
    const materials::LayerStack& entrance = at.optics.entrance_layers;
    ASSERT_EQ(entrance.layers.size(), 1U);
    EXPECT_EQ(entrance.layers[0].index,
              materials::index_relative_to_air(library().find("MgF2"), library().air(), at.wavelength_nm));
  }
  EXPECT_EQ(design::make_light_model(read("facets = [{ material = \"silver\" }]"), library())
                .optics.facet_layers.layers[0]
                .thickness,
            kInfinity);
}

// Ten wavelengths give the mean over a lamp's spectrum with a thin layer as accurately as without a layer. The
// reference is a mean over a fine spectrum. A thick hard coat has more fringes than ten wavelengths can resolve, which
// causes a warning.
TEST(Coating, SpectraOfThinAndThickLayers) {
  const auto reflectance = [](const raytrace::Optics& optics) {
    return std::norm(
        materials::fresnel_layers(optics.entrance_layers, materials::StackSide::outside, 1.0, optics.index, 1.0).r_s);
  };
  const design::OpticalModel thin = design::make_light_model(read(kCoated, {"light.spectrum=D65"}), library());
  EXPECT_TRUE(thin.warnings.empty()) << thin.warnings.front().text;
  double mean = 0.0;
  for (const design::SpectralOptics& at : thin.spectral) mean += at.weight * reflectance(at.optics);
  const materials::CieTable cie = materials::shipped_cie_table();
  const materials::Spectrum flux = materials::resolved_spectrum(cie.illuminant_d65, &cie.photopic_efficiency);
  double fine = 0.0;
  for (std::size_t k = 0; k < flux.size(); ++k) {
    const design::Design at = read(kCoated, {"light.wavelength_nm=" + std::to_string(flux.wavelengths_nm[k])});
    fine += flux.weights[k] * reflectance(design::make_light_model(at, library()).optics);
  }
  EXPECT_NEAR(mean, fine, 2e-5 * fine);
  const design::OpticalModel thick = design::make_light_model(
      read("entrance = [{ refractive_index = 1.55, thickness_nm = 5000 }]", {"light.spectrum=D65"}), library());
  ASSERT_EQ(thick.warnings.size(), 1U);
  EXPECT_EQ(facts_of(thick.warnings[0]), "unresolved_fringes at d.toml");
}

TEST(Coating, ExtrapolatedLayersAreTold) {
  const design::OpticalModel model = design::make_light_model(
      read("facets = [{ material = \"silver\", thickness_nm = 20 }, { material = \"silver\", thickness_nm = 5 }]",
           {"light.wavelength_nm=200", "body.refractive_index=1.5"}),
      library());
  ASSERT_EQ(model.warnings.size(), 1U);
  EXPECT_EQ(facts_of(model.warnings[0]), "index_extrapolated at d.toml");
}

TEST(Coating, InspectionTellsTheStack) {
  const Inspection seen = inspect(read(kProtected + kCoated), library());
  ASSERT_TRUE(seen.coating.entrance && seen.coating.facets);
  const CoatingReport& entrance = *seen.coating.entrance;
  // The reflectance of a layer of 99.8 nm follows from the closed form for a single layer.
  const double n1 = 1.3777439516901744;
  const double air = materials::refractive_index(library().air().dispersion, 587.56);
  const double body = seen.refractive_index;
  const std::complex<double> turn =
      std::exp(std::complex<double>(0.0, 4.0 * std::numbers::pi * n1 * 99.8 * air / 587.56));
  const double front = (1.0 - n1) / (1.0 + n1);
  const double back = (n1 - body) / (n1 + body);
  const double expected = std::norm((front + back * turn) / (1.0 + front * back * turn));
  EXPECT_NEAR(entrance.reflectance, expected, 1e-7);
  EXPECT_NEAR(entrance.reflectance + entrance.transmittance, 1.0, 1e-12);
  EXPECT_EQ(entrance.absorptance, 0.0);
  EXPECT_NEAR(seen.coating.facets->reflectance + seen.coating.facets->transmittance + seen.coating.facets->absorptance,
              1.0, 1e-12);
  const std::string text = inspect_text(seen);
  EXPECT_NE(text.find("facets              aluminium 90 nm; n = 1.5 2000 nm, from the body outwards"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("entrance face       MgF2 99.8 nm, from the body outwards"), std::string::npos) << text;
  EXPECT_NE(text.find("total reflection    none: the layers on the facets absorb light"), std::string::npos) << text;
  EXPECT_NE(inspect_text(inspect(read(kCoated), library())).find("total reflection    up to "), std::string::npos);
  const auto json = nlohmann::json::parse(inspect_json(seen));
  EXPECT_EQ(json["coating"]["facets"]["layers"].size(), 2U);
  EXPECT_EQ(json["coating"]["entrance"]["reflectance"].get<double>(), entrance.reflectance);
  EXPECT_EQ(json["design"]["coating"]["entrance"][0]["material"], "MgF2");
  // The key `facet_coating` already describes aluminised facets, so there is no report of layers.
  EXPECT_FALSE(inspect(set({"body.facet_coating=aluminium"}), library()).coating.facets);
}

}  // namespace
}  // namespace retrace::studies::coating_test
