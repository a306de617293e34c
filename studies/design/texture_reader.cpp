#include "studies/design/texture_reader.h"

#include <fmt/format.h>

namespace retrace::studies {
namespace {

using Model = FacetTexture::Model;

constexpr std::array kModels = {Choice<Model>{"smooth", Model::smooth},
                                Choice<Model>{"harvey_shack", Model::harvey_shack}, Choice<Model>{"abg", Model::abg},
                                Choice<Model>{"microfacet", Model::microfacet}};
constexpr std::array kSlopeDistributions = {Choice<bool>{"beckmann", false}, Choice<bool>{"ggx", true}};
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

}  // namespace

FacetTexture read_texture(TableReader& surface) {
  FacetTexture texture;
  read_height(surface, "roughness_sq_nm", "correlation_length_um", texture.roughness_sq_nm,
              texture.correlation_length_um);
  read_height(surface, "waviness_sq_nm", "waviness_length_um", texture.waviness_sq_nm, texture.waviness_length_um);
  const bool has_roughness = texture.roughness_sq_nm > 0.0;
  const bool has_waviness = texture.waviness_sq_nm > 0.0;
  const Model usual = has_roughness || has_waviness ? Model::harvey_shack : Model::smooth;
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
  if (texture.model == Model::microfacet)
    texture.ggx =
        surface.choice("slope_distribution", std::span<const Choice<bool>>(kSlopeDistributions)).value_or(false);
  else
    surface.refuse({"slope_distribution"}, "only allowed for model = \"microfacet\"");
  if (texture.model == Model::smooth || texture.model == Model::abg)
    surface.refuse_unless_zero({"roughness_sq_nm", "waviness_sq_nm"},
                               "must be 0 for this model; leave the model out or use \"harvey_shack\"");
  if (texture.model == Model::microfacet)
    surface.refuse_unless_zero({"roughness_sq_nm"}, "must be 0 for model = \"microfacet\", which has waviness only");
  const bool has_heights = has_roughness || has_waviness;
  if (!has_heights && texture.model != Model::abg) texture.model = Model::smooth;
  return texture;
}

}  // namespace retrace::studies
