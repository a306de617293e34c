#include "studies/design/texture_reader.h"

#include <fmt/format.h>

namespace retrace::studies {
namespace {

using Model = FacetTexture::Model;

constexpr std::array kModels = {Choice<Model>{"smooth", Model::smooth},
                                Choice<Model>{"harvey_shack", Model::harvey_shack}, Choice<Model>{"abg", Model::abg},
                                Choice<Model>{"microfacet", Model::microfacet},
                                Choice<Model>{"height_map", Model::height_map}};
constexpr std::array kSlopeDistributions = {Choice<bool>{"beckmann", false}, Choice<bool>{"ggx", true}};
constexpr std::array kLevelAxes = {Choice<HeightMapAxis>{"x", HeightMapAxis::x},
                                   Choice<HeightMapAxis>{"y", HeightMapAxis::y}};
constexpr std::array kForms = {Choice<int>{"plane", 1}, Choice<int>{"poly2", 2}, Choice<int>{"poly3", 3},
                               Choice<int>{"poly4", 4}, Choice<int>{"poly5", 5}, Choice<int>{"poly6", 6},
                               Choice<int>{"poly7", 7}, Choice<int>{"poly8", 8}};
constexpr std::array kWalls = {Choice<bool>{"smooth", false}, Choice<bool>{"absorbing", true}};
// Beyond the optics of surfaces; keeps squares and exponentials finite.
constexpr Range kHeight{.low = 0.0, .high = 1e5};
constexpr Range kLength{.low = 0.0, .high = 1e6};

/// A height and the length that belongs to it: one without the other says nothing.
void read_height(TableReader& surface, std::string_view height_key, std::string_view length_key, double& height_nm,
                 double& length_um) {
  height_nm = surface.number(height_key, kHeight).value_or(0.0);
  length_um = surface.number(length_key, kLength).value_or(0.0);
  if (height_nm > 0.0 && !(length_um > 0.0))
    surface.fail(length_key, fmt::format("must be > 0 where {} is given, got {}", height_key, length_um));
}

/// A measured map and how it lies on the facets.
void read_height_map(TableReader& surface, FacetTexture& texture) {
  if (texture.model != Model::height_map) {
    surface.refuse({"height_map", "height_map_level_axis", "height_map_form"},
                   "only allowed for model = \"height_map\"");
    return;
  }
  const std::optional<std::filesystem::path> file = surface.file("height_map");
  if (!file) surface.fail("height_map", "missing, must name the file of a measured map");
  texture.height_map = *surface.text("height_map");
  texture.height_map_file = *file;
  texture.location = surface.where("height_map");
  texture.height_map_level_axis =
      surface.choice("height_map_level_axis", std::span<const Choice<HeightMapAxis>>(kLevelAxes))
          .value_or(HeightMapAxis::x);
  texture.height_map_form_degree = surface.choice("height_map_form", std::span<const Choice<int>>(kForms)).value_or(1);
}

}  // namespace

FacetTexture read_texture(TableReader& surface) {
  FacetTexture texture;
  read_height(surface, "roughness_sq_nm", "correlation_length_um", texture.roughness_sq_nm,
              texture.correlation_length_um);
  read_height(surface, "waviness_sq_nm", "waviness_length_um", texture.waviness_sq_nm, texture.waviness_length_um);
  const bool has_roughness = texture.roughness_sq_nm > 0.0;
  const bool has_waviness = texture.waviness_sq_nm > 0.0;
  const Model usual = has_roughness || has_waviness ? Model::harvey_shack
                      : surface.has("height_map")   ? Model::height_map
                                                    : Model::smooth;
  texture.model = surface.choice("model", std::span<const Choice<Model>>(kModels)).value_or(usual);
  texture.location =
      surface.where(surface.has("model") ? "model" : (has_roughness ? "roughness_sq_nm" : "waviness_sq_nm"));
  texture.absorbing_walls = surface.choice("walls", std::span<const Choice<bool>>(kWalls)).value_or(false);
  if (texture.model == Model::abg) {
    texture.abg_a = surface.required_number("abg_a", kPositive);
    texture.abg_b = surface.required_number("abg_b", kPositive);
    texture.abg_g = surface.required_number("abg_g", kPositive);
  } else {
    surface.refuse({"abg_a", "abg_b", "abg_g"}, "only allowed for model = \"abg\"");
  }
  read_height_map(surface, texture);
  if (texture.model == Model::microfacet)
    texture.ggx =
        surface.choice("slope_distribution", std::span<const Choice<bool>>(kSlopeDistributions)).value_or(false);
  else
    surface.refuse({"slope_distribution"}, "only allowed for model = \"microfacet\"");
  if (texture.model == Model::height_map)
    surface.refuse_unless_zero({"roughness_sq_nm", "waviness_sq_nm"},
                               "must be 0 for model = \"height_map\", whose map holds both");
  if (texture.model == Model::smooth || texture.model == Model::abg)
    surface.refuse_unless_zero({"roughness_sq_nm", "waviness_sq_nm"},
                               "must be 0 for this model; leave the model out or use \"harvey_shack\"");
  if (texture.model == Model::microfacet)
    surface.refuse_unless_zero({"roughness_sq_nm"}, "must be 0 for model = \"microfacet\", which has waviness only");
  const bool has_heights = has_roughness || has_waviness;
  if (!has_heights && (texture.model == Model::harvey_shack || texture.model == Model::microfacet))
    texture.model = Model::smooth;
  return texture;
}

}  // namespace retrace::studies
