#include "studies/design/texture_reader.h"

#include <fmt/format.h>

#include <initializer_list>

#include "core/number_format.h"

namespace retrace::studies {
namespace {

using Model = FacetTexture::Model;
using schema::Document;

constexpr std::string_view kRoughness = "surface.roughness_sq_nm";
constexpr std::string_view kWaviness = "surface.waviness_sq_nm";

/// A height and the length that belongs to it: one without the other says nothing.
void read_height(const Document& document, std::string_view height_key, std::string_view length_key, double& height_nm,
                 double& length_um) {
  height_nm = document.number(height_key);
  length_um = document.number(length_key);
  if (height_nm > 0.0 && !(length_um > 0.0))
    document.fail(length_key, fmt::format("must be > 0 where {} is given, got {}",
                                          height_key.substr(height_key.find('.') + 1), length_um));
}

void refuse_heights(const Document& document, std::initializer_list<std::string_view> keys, std::string_view why) {
  for (const std::string_view key : keys)
    if (document.number(key) != 0.0) document.fail(key, fmt::format("{}, got {}", why, shortest(document.number(key))));
}

/// What a model takes no heights for.
void check_heights(const Document& document, Model model) {
  if (model == Model::height_map)
    refuse_heights(document, {kRoughness, kWaviness}, "must be 0 for model = \"height_map\", whose map holds both");
  if (model == Model::smooth || model == Model::abg)
    refuse_heights(document, {kRoughness, kWaviness},
                   "must be 0 for this model; leave the model out or use \"harvey_shack\"");
  if (model == Model::microfacet)
    refuse_heights(document, {kRoughness}, "must be 0 for model = \"microfacet\", which has waviness only");
}

/// A measured map and how it lies on the facets.
void read_height_map(const Document& document, FacetTexture& texture) {
  texture.height_map = document.text("surface.height_map");
  texture.height_map_file = document.file("surface.height_map");
  texture.height_map_level_axis = document.choice<HeightMapAxis>("surface.height_map_level_axis");
  texture.height_map_form_degree = static_cast<int>(document.index("surface.height_map_form")) + 1;
}

Model model_of(const Document& document, bool has_heights) {
  if (document.value("surface.model").index() != 0) return document.choice<Model>("surface.model");
  return has_heights ? Model::harvey_shack : Model::smooth;
}

}  // namespace

FacetTexture read_texture(const Document& document) {
  FacetTexture texture;
  read_height(document, kRoughness, "surface.correlation_length_um", texture.roughness_sq_nm,
              texture.correlation_length_um);
  read_height(document, kWaviness, "surface.waviness_length_um", texture.waviness_sq_nm, texture.waviness_length_um);
  const bool has_heights = texture.roughness_sq_nm > 0.0 || texture.waviness_sq_nm > 0.0;
  texture.model = model_of(document, has_heights);
  texture.absorbing_walls = document.text("surface.walls") == "absorbing";
  if (texture.model == Model::abg) {
    texture.abg_a = document.number("surface.abg_a");
    texture.abg_b = document.number("surface.abg_b");
    texture.abg_g = document.number("surface.abg_g");
  }
  if (texture.model == Model::height_map) read_height_map(document, texture);
  if (texture.model == Model::microfacet) texture.ggx = document.text("surface.slope_distribution") == "ggx";
  check_heights(document, texture.model);
  if (!has_heights && (texture.model == Model::harvey_shack || texture.model == Model::microfacet))
    texture.model = Model::smooth;
  return texture;
}

}  // namespace retrace::studies
