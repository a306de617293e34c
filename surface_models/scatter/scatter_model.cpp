#include "surface_models/scatter/scatter_model.h"

namespace retrace::surface_models {
namespace {

/// Frame of a facet. z is its normal; x and y are those of the mean surface, rotated together with the normal.
class FacetFrame {
 public:
  explicit FacetFrame(const Facet& facet) : is_tilted_(facet.is_tilted) {
    if (is_tilted_) facet_from_mean_ = Eigen::Quaterniond::FromTwoVectors(facet.normal, Vec3::UnitZ());
  }
  Vec3 to_facet(const Vec3& v) const { return is_tilted_ ? facet_from_mean_ * v : v; }
  Vec3 to_mean(const Vec3& v) const { return is_tilted_ ? facet_from_mean_.conjugate() * v : v; }
  ScatterEvent to_facet(ScatterEvent event) const {
    event.direction_in = to_facet(event.direction_in);
    return event;
  }

 private:
  bool is_tilted_;
  Eigen::Quaterniond facet_from_mean_ = Eigen::Quaterniond::Identity();
};

/// Draws the direction of scattered light in the facet's frame. Returns nothing if the light is specular.
template <class Model>
std::optional<Vec2> sample_scattered(const Model& model, const ScatterEvent& event, const Facet& facet, Lobe lobe,
                                     RandomStream& random) {
  if constexpr (requires { model.scattered_fraction(event, facet, lobe); }) {
    if (random.next() >= model.scattered_fraction(event, facet, lobe)) return std::nullopt;
    return model.draw_scattered(event, facet, lobe, random);
  } else {
    return model.sample_scattered(event, facet, lobe, random);
  }
}

/// Returns the density of scattered directions over the direction cosines in the facet's frame.
template <class Model>
double density(const Model& model, const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec3& direction) {
  const FacetFrame frame(facet);
  const Vec3 seen = frame.to_facet(direction);
  if (!is_on_side(seen, lobe)) return 0.0;
  return model.scattered_density(frame.to_facet(event), facet, lobe, seen.head<2>());
}

}  // namespace

Facet sample_facet(const ScatterModel& model, const ScatterEvent& event, RandomStream& random) {
  return std::visit([&](const auto& m) { return m.sample_facet(event, random); }, model);
}

std::optional<ScatterSample> sample(const ScatterModel& model, const ScatterEvent& event, const Facet& facet, Lobe lobe,
                                    RandomStream& random) {
  const auto specular = specular_direction(event, facet.normal, lobe);
  if (!specular) return std::nullopt;
  return std::visit(
      [&](const auto& m) -> std::optional<ScatterSample> {
        ScatterSample drawn{*specular, *specular, 1.0, true};
        const FacetFrame frame(facet);
        if (const auto beta = sample_scattered(m, frame.to_facet(event), facet, lobe, random)) {
          drawn.direction = frame.to_mean(direction_of(*beta, lobe));
          drawn.is_specular = false;
        }
        if (!is_on_side(drawn.direction, lobe)) return std::nullopt;
        if (facet.is_tilted) drawn.weight = m.unmasked_fraction(drawn.direction);
        return drawn;
      },
      model);
}

std::optional<ScatterSplit> sample_split(const ScatterModel& model, const ScatterEvent& event, const Facet& facet,
                                         Lobe lobe, double min_fraction, RandomStream& random) {
  const auto specular = specular_direction(event, facet.normal, lobe);
  if (!specular) return std::nullopt;
  return std::visit(
      [&](const auto& m) -> std::optional<ScatterSplit> {
        if constexpr (requires { m.scattered_fraction(event, facet, lobe); }) {
          const FacetFrame frame(facet);
          const ScatterEvent seen = frame.to_facet(event);
          const double share = m.scattered_fraction(seen, facet, lobe);
          if (share < min_fraction || 1.0 - share < min_fraction) return std::nullopt;
          const auto beta = m.draw_scattered(seen, facet, lobe, random);
          if (!beta) return std::nullopt;
          const auto part = [&](const Vec3& direction, double weight,
                                bool is_specular) -> std::optional<ScatterSample> {
            if (!is_on_side(direction, lobe)) return std::nullopt;
            const double unmasked = facet.is_tilted ? m.unmasked_fraction(direction) : 1.0;
            return ScatterSample{direction, *specular, weight * unmasked, is_specular};
          };
          return ScatterSplit{part(*specular, 1.0 - share, true),
                              part(frame.to_mean(direction_of(*beta, lobe)), share, false)};
        }
        return std::nullopt;
      },
      model);
}

const HarveyShack* first_order_model(const ScatterModel& model) {
  const auto* rough = std::get_if<HarveyShack>(&model);
  return rough != nullptr && rough->is_between_dielectrics() ? rough : nullptr;
}

DiffractionMeans diffraction_means(const HarveyShack& model, const ScatterEvent& event, const Facet& facet,
                                   const materials::FresnelCoefficients& fresnel) {
  return model.diffraction_means(FacetFrame(facet).to_facet(event), facet, fresnel);
}

std::optional<DiffractedOnce> sample_diffracted_once(const HarveyShack& model, const ScatterEvent& event,
                                                     const Facet& facet, const Vec3& s_axis,
                                                     const Polarisation2& coherency, RandomStream& random,
                                                     double& unmasked) {
  const FacetFrame frame(facet);
  auto drawn = model.draw_diffracted_once(frame.to_facet(event), facet, frame.to_facet(s_axis), coherency, random);
  if (!drawn) return std::nullopt;
  drawn->direction = frame.to_mean(drawn->direction);
  drawn->s_axis = frame.to_mean(drawn->s_axis);
  if (!is_on_side(drawn->direction, drawn->lobe)) return std::nullopt;
  unmasked = facet.is_tilted ? model.unmasked_fraction(drawn->direction) : 1.0;
  return drawn;
}

std::optional<ScatterSample> sample_diffracted_again(const HarveyShack& model, const ScatterEvent& event,
                                                     const Facet& facet, Lobe lobe, RandomStream& random) {
  const auto specular = specular_direction(event, facet.normal, lobe);
  if (!specular) return std::nullopt;
  const FacetFrame frame(facet);
  ScatterSample drawn{*specular, *specular, 1.0, true};
  if (const auto beta = model.draw_scattered(frame.to_facet(event), facet, lobe, random, 2)) {
    drawn.direction = frame.to_mean(direction_of(*beta, lobe));
    drawn.is_specular = false;
  }
  if (!is_on_side(drawn.direction, lobe)) return std::nullopt;
  if (facet.is_tilted) drawn.weight = model.unmasked_fraction(drawn.direction);
  return drawn;
}

double specular_fraction(const ScatterModel& model, const ScatterEvent& event, const Facet& facet, Lobe lobe) {
  if (!specular_direction(event, facet.normal, lobe)) return 0.0;
  return std::visit([&](const auto& m) { return m.specular_fraction(FacetFrame(facet).to_facet(event), facet, lobe); },
                    model);
}

double mean_field_fraction(const ScatterModel& model, const ScatterEvent& event, Lobe lobe) {
  if (std::holds_alternative<Microfacet>(model)) return 0.0;
  if (const auto* abg = std::get_if<Abg>(&model)) return abg->min_specular_fraction();
  return specular_fraction(model, event, {}, lobe);
}

bool has_phases(const ScatterModel& model) {
  const auto* const heights = std::get_if<HarveyShack>(&model);
  return heights != nullptr && heights->roughness().is_isotropic();
}

PhaseTexture phase_texture(const ScatterModel& model, const ScatterEvent& event, Lobe lobe) {
  return std::get<HarveyShack>(model).phase_texture(event, lobe);
}

double evaluate(const ScatterModel& model, const ScatterEvent& event, const Facet& facet, Lobe lobe,
                const Vec3& direction) {
  if (!is_on_side(direction, lobe)) return 0.0;
  return std::visit(
      [&](const auto& m) {
        const double unmasked = facet.is_tilted ? m.unmasked_fraction(direction) : 1.0;
        return unmasked * density(m, event, facet, lobe, direction);
      },
      model);
}

double pdf(const ScatterModel& model, const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec3& direction) {
  const double cos_out = std::abs(direction.dot(facet.normal));
  return std::visit([&](const auto& m) { return cos_out * density(m, event, facet, lobe, direction); }, model);
}

void require_in_range(const ScatterModel& model, double index, double wavelength_nm) {
  if (const auto* rough = std::get_if<HarveyShack>(&model)) rough->require_in_range(index, wavelength_nm);
}

Warnings warnings(const ScatterModel& model, double index, double wavelength_nm) {
  return std::visit([&](const auto& m) { return m.warnings(index, wavelength_nm); }, model);
}

}  // namespace retrace::surface_models
