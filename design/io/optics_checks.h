#pragma once

// Checks of keys of a design that depend on each other: material, texture, layers and light. Checks of the part are in
// design_rules.cpp.

#include <string_view>

#include "core/schema/document.h"

namespace retrace::design {

inline constexpr std::string_view kRoughness = "surface.roughness_sq_nm";
inline constexpr std::string_view kRoughnessLength = "surface.correlation_length_um";
inline constexpr std::string_view kWaviness = "surface.waviness_sq_nm";
inline constexpr std::string_view kWavinessLength = "surface.waviness_length_um";

/// Checks that every roughness comes with its correlation length and every waviness with its period.
/// \throw InputError that names file, line and key, like all following functions
void check_lengths(const schema::Document& document);
/// Checks that the texture's model uses every height that is given.
void check_heights(const schema::Document& document);

inline constexpr std::string_view kAbsorption = "body.absorption_per_mm";

/// Checks that a material is given.
void check_material(const schema::Document& document);
/// Checks that an absorption by wavelength is a valid curve.
void check_absorption(const schema::Document& document);
/// Checks the number of shells and their radii, which must not be 0, and that the rest of the design allows shells.
void check_shells(const schema::Document& document);
/// Checks that each line of a spectrum occurs only one time.
void check_lines(const schema::Document& document);
/// Checks that the Stokes parameters are physically possible.
void check_stokes(const schema::Document& document);

inline constexpr std::string_view kFacetLayers = "coating.facets";
inline constexpr std::string_view kEntranceLayers = "coating.entrance";

/// Checks that balls with a bowl behind them have a mirror.
void check_ball_mirror(const schema::Document& document);
/// Checks that wet elements belong to a finite array on a plane, and that the region that selects them is not empty.
void check_wet_back(const schema::Document& document);
/// Checks that at most one layer on the facets is opaque, and no layer on the entrance face.
void check_layers(const schema::Document& document);
/// Checks that no coating is given by two keys, and that no coating is given together with a key that it makes
/// ineffective.
void check_coating(const schema::Document& document);

}  // namespace retrace::design
