#pragma once

// Rules of designs that tie keys of material, texture, layers and light; those of parts are in design_rules.cpp.

#include <string_view>

#include "core/schema/document.h"

namespace retrace::studies {

inline constexpr std::string_view kRoughness = "surface.roughness_sq_nm";
inline constexpr std::string_view kRoughnessLength = "surface.correlation_length_um";
inline constexpr std::string_view kWaviness = "surface.waviness_sq_nm";
inline constexpr std::string_view kWavinessLength = "surface.waviness_length_um";
inline constexpr std::string_view kAbsorption = "body.absorption_per_mm";
inline constexpr std::string_view kFacetLayers = "coating.facets";
inline constexpr std::string_view kEntranceLayers = "coating.entrance";
inline constexpr std::string_view kEntranceFace = "entrance";
inline constexpr std::string_view kThickLayers = "entrance.layers";

/// A roughness or waviness has its length. All of these: \throw InputError naming file, line and key
void check_lengths(const schema::Document& document);
/// The model of the texture takes the heights that are given.
void check_heights(const schema::Document& document);
/// A material is named.
void check_material(const schema::Document& document);
/// An absorption by wavelength is a curve.
void check_absorption(const schema::Document& document);
/// Each line of a spectrum is named once.
void check_lines(const schema::Document& document);
/// Stokes parameters are those of light.
void check_stokes(const schema::Document& document);
/// A bowl behind balls has a mirror.
void check_ball_mirror(const schema::Document& document);
/// Elements with another medium behind them are some of a finite array on a plane, and their region has a size.
void check_wet_back(const schema::Document& document);
/// At most one layer is opaque, and none of those on the entrance face.
void check_layers(const schema::Document& document);
/// Layers stand beside nothing that would not count.
void check_coating(const schema::Document& document);
/// What the entrance face is like is complete, and nothing that a face cannot be at once. In entrance_checks.cpp.
void check_entrance_face(const schema::Document& document);

}  // namespace retrace::studies
