#pragma once

// What is designed: shape, substance, surface, light and detector, checked, with its defaults filled in. Every study
// begins with a Design.

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/schema/document.h"
#include "geometry/elements/element_choice.h"
#include "geometry/elements/part_spec.h"
#include "geometry/part/zones.h"
#include "raytrace/balls/ball_layer.h"
#include "raytrace/light/stokes.h"

namespace retrace::geometry {
class FacetPlanes;
}

namespace retrace::studies {

/// The optical idealisations a design may ask for, to be checked against theory.
struct Idealisation {
  bool mirror_facets = false;  ///< retro facets reflect everything at every angle
  bool lossless_entrance =
      false;  ///< entrance face refracts with T = 1 both ways; beyond the critical angle light ends
};

enum class HeightMapAxis { x, y };

struct SmoothTexture {};
/// Roughness and waviness, one of the two above 0.
struct HarveyShackTexture {
  double roughness_sq_nm = 0.0;        ///< rms height
  double correlation_length_um = 0.0;  ///< 1/e of a Gaussian autocorrelation
  double waviness_sq_nm = 0.0;
  double waviness_length_um = 0.0;  ///< period
  /// Of the roughness down the facet, where it is unlike correlation_length_um, which is level then; 0: the same
  double down_correlation_length_um = 0.0;
};
/// BSDF = a / (b + |dbeta|^g), per sr.
struct AbgTexture {
  double a = 0.0;
  double b = 0.0;
  double g = 0.0;
};
struct MicrofacetTexture {
  double waviness_sq_nm = 0.0;  ///< rms height, > 0
  double waviness_length_um = 0.0;
  bool ggx = false;  ///< longer tails of slopes than Gaussian
};
struct HeightMapTexture {
  std::string name;            ///< of the file, as given
  std::filesystem::path file;  ///< the same, from the working directory; checked only when it is read, by make_model()
  HeightMapAxis level_axis = HeightMapAxis::x;  ///< of the map; level on a facet: along the roof edge of a prism
  int form_degree = 1;                          ///< of the polynomial that is removed from the map, 1..8
};
/// What the retro facets are like, in the order of the words of `surface.model`.
using FacetTexture = std::variant<SmoothTexture, HarveyShackTexture, AbgTexture, MicrofacetTexture, HeightMapTexture>;

/// A term of a polynomial over a facet: height_um times the powers of places level and down the facet, in units of the
/// facet's radius.
struct FormTerm {
  int level = 0;
  int down = 0;            ///< both together at most 8
  double height_um = 0.0;  ///< out of the body
};
struct FormMap {
  std::string name;            ///< of the file, as given
  std::filesystem::path file;  ///< the same, from the working directory; checked only when it is read, by make_model()
  HeightMapAxis level_axis = HeightMapAxis::x;
  int degree = 4;  ///< of the polynomial that is taken from it, 2..8
};
/// By what the retro facets of elements depart from their planes, all alike: the sum of these.
struct FormOfFacets {
  double sink_um = 0.0;  ///< of a paraboloid, from its farthest corner to its middle, into the body
  std::vector<FormTerm> terms;
  std::optional<FormMap> map;

  bool is_plane() const { return sink_um == 0.0 && terms.empty() && !map; }
};

struct SpectralAbsorption {
  double wavelength_nm = 0.0;
  double per_mm = 0.0;  ///< Napierian, for power; >= 0

  bool operator==(const SpectralAbsorption&) const = default;
};
/// Napierian, for power: that of the material, a number per mm, or linear between two or more pairs that ascend.
using Absorption = std::variant<std::monostate, double, std::vector<SpectralAbsorption>>;

/// Light of more than one wavelength, as the design names it.
struct LightSpectrum {
  enum class Kind { illuminant_a, illuminant_d65, file, lines };
  struct Line {
    double wavelength_nm = 0.0;
    double power = 0.0;  ///< in any unit, >= 0
  };
  Kind kind = Kind::illuminant_a;
  std::string name;            ///< of a file, as given
  std::filesystem::path file;  ///< the same, from the working directory; empty if there is none
  std::vector<Line> lines;     ///< ascending
  bool photopic = true;        ///< shares are of the luminous flux; else of the power
};

/// A picture whose dark pixels say which elements are there.
struct ArrayMask {
  std::string name;            ///< of the file, as given
  std::filesystem::path file;  ///< the same, from the working directory
  double threshold = 0.7;      ///< pixels with grey < threshold * 255 are cut
};

/// A table of planes that single facets lie in, in place of the element's.
struct FacetPlanesFile {
  std::string name;            ///< as given
  std::filesystem::path file;  ///< the same, from the working directory; checked only when it is read, by part_of()
  std::shared_ptr<const geometry::FacetPlanes> planes = {};  ///< in place of the file's; null: they are read
};

/// Elements side by side, the plate in front of them, and what single elements differ in.
struct ElementArray {
  geometry::PartSpec part;
  std::optional<ArrayMask> mask;
  std::optional<FacetPlanesFile> facet_planes;  ///< finite parts only; not together with a mask
};

/// A mesh that is the whole part.
struct PartMesh {
  std::string name;                    ///< of the STL file, as given
  std::filesystem::path file;          ///< the same, from the working directory; read by part_of_design()
  bool allow_open = false;             ///< trace it although it is not closed: openings are closed by flat pieces
  std::optional<double> thickness_mm;  ///< as the mesh must have it
};

/// A plate whose flat back on z = 0 is its retro facet.
struct Plate {
  std::array<double, 2> size_mm = {};  ///< in x and y
  double thickness_mm = 0.0;
};

/// Which elements of an array are a zone's: one of these.
struct ElementsOfZone {
  std::vector<double> rows;       ///< numbers from 1, that of least y
  std::vector<double> columns;    ///< likewise, of least x
  std::optional<double> every;    ///< rows or columns begin anew after so many
  std::optional<ArrayMask> mask;  ///< dark under an element's centroid
  bool rest = false;              ///< that no other zone has
};

/// A plate with zones that have elements of their own: regions, or elements of one array.
struct ZonedPart {
  geometry::PartSpec base;                        ///< what zones have where they change nothing
  std::vector<std::vector<std::string>> changes;  ///< of each zone, each KEY=VALUE
  std::vector<ElementsOfZone> elements;           ///< of each zone; none where zones are regions
  geometry::ZonedSpec spec;                       ///< cells of masks are found by part_of_design()

  bool has_masks() const {
    return std::ranges::any_of(elements, [](const ElementsOfZone& of_zone) { return of_zone.mask.has_value(); });
  }
};

/// What a design is the design of.
using Shape = std::variant<ElementArray, PartMesh, Plate, ZonedPart, raytrace::BallLayer>;

/// A face through which light enters, in place of the plane one.
struct EntranceFile {
  std::string name;            ///< of the file, as given
  std::filesystem::path file;  ///< the same, from the working directory; read by entrance_of_design()
  bool is_mesh = false;        ///< an STL file; else that of a turned part
  bool mesh_bottom = false;    ///< the mesh is the counterpart: its triangles that look down are the front
  /// Where in the part's plane the origin of the file's frame lies; the part's middle if it was not given.
  std::optional<std::array<double, 2>> centre_mm;
};

/// A catalogue of glasses.
struct GlassCatalogueFile {
  std::string name;            ///< as given
  std::filesystem::path file;  ///< the same, from the working directory; checked only when it is read, by make_model()
};

/// The same by a name that holds in every folder, for designs that are written elsewhere.
std::optional<GlassCatalogueFile> from_anywhere(const std::optional<GlassCatalogueFile>& catalogue);

/// What the part is made of, and what lies behind its retro facets.
struct Substance {
  std::string material = "PMMA";
  std::optional<GlassCatalogueFile> catalogue;  ///< which the material is of; none: the shipped ones
  std::optional<double> refractive_index;       ///< wins over the material; relative to air, >= 1
  std::optional<double> temperature_c;          ///< of part and air; none: that of the material's data
  Absorption absorption_per_mm;
  double back_index = 1.0;  ///< of what lies behind the facets, relative to air; 1..3

  bool is_coloured() const { return std::holds_alternative<std::vector<SpectralAbsorption>>(absorption_per_mm); }
};

/// Some elements of a finite array that have another medium behind them.
struct WetElements {
  double index = 1.333;  ///< of that medium, relative to air; 1..3
  geometry::ElementChoice where;
};

/// A layer of a coating, as the design names it.
struct CoatingLayer {
  std::string material;  ///< of the library, or a metal; empty: its index is given
  double refractive_index = 1.0;
  double extinction_coefficient = 0.0;
  std::optional<double> thickness_nm;  ///< none: opaque

  bool operator==(const CoatingLayer&) const = default;
};

/// Layers on the faces of a part, each list from the body outwards.
struct Coating {
  std::vector<CoatingLayer> facets;    ///< at most one is opaque
  std::vector<CoatingLayer> entrance;  ///< none is opaque

  /// Whether the facets are as `facet_coating = "aluminium"` says.
  bool has_aluminium_alone_on_facets() const;
  bool has_opaque_facets() const;
};

/// A layer on the entrance face that is thick against the coherence of light.
struct ThickCoatingLayer {
  double refractive_index = 1.0;
  double thickness_um = 0.0;
  double absorption_per_mm = 0.0;  ///< Napierian, for power
};

/// What the entrance face is like where it is not clean. Shares are of its area but for haze's.
struct EntranceState {
  std::vector<ThickCoatingLayer> layers;  ///< from the body outwards, on those of the coating
  double film_coverage = 0.0;
  double water_index = 1.333;
  double drop_coverage = 0.0;
  std::optional<double> drop_contact_angle_deg;  ///< there where its share is above 0, as what follows
  double dust_coverage = 0.0;
  std::optional<double> dust_albedo;
  std::optional<double> dust_forward_share;
  double scratch_coverage = 0.0;
  std::optional<double> scratch_spread_deg;
  std::optional<double> scratch_azimuth_deg;  ///< none: all directions alike
  double haze = 0.0;                          ///< share beyond 2.5 degrees
  std::optional<double> haze_spread_deg;
  double roughness_sq_nm = 0.0;
  double correlation_length_um = 0.0;

  /// Whether it sends light to more directions than a plane does.
  bool scatters() const {
    return drop_coverage > 0.0 || dust_coverage > 0.0 || scratch_coverage > 0.0 || haze > 0.0 || roughness_sq_nm > 0.0;
  }
  bool is_clean() const { return layers.empty() && film_coverage == 0.0 && !scatters(); }
};

/// What the retro facets do beside reflecting, layers on the faces, and the state of the entrance face.
struct Surface {
  Coating coating;
  EntranceState entrance;
  bool absorbing_walls = false;  ///< of elements and of the border
  FacetTexture texture;
  FormOfFacets form;

  bool is_smooth() const { return std::holds_alternative<SmoothTexture>(texture); }
};

/// The light that falls on the part.
struct Light {
  std::variant<double, LightSpectrum> colour = 587.56;  ///< one wavelength in vacuum, in nm, or a spectrum
  /// Along the axes of raytrace::source_axis(); i = 1.
  raytrace::Stokes polarisation = raytrace::kUnpolarised;

  /// Null for one wavelength.
  const LightSpectrum* spectrum() const { return std::get_if<LightSpectrum>(&colour); }
  /// \pre no spectrum
  double wavelength_nm() const { return std::get<double>(colour); }
};

/// What counts as returned.
struct Detector {
  std::vector<double> acceptance_half_angle_deg = {0.5};  ///< in air; ascending, each in (0, 90]
};

/// Everything a design file says, checked and with its defaults filled in.
struct Design {
  std::string source;  ///< file name as given, "-" for standard input
  std::string title;   ///< empty if none was given
  Shape shape;
  std::optional<EntranceFile> entrance;  ///< none: the plane z = thickness_mm; balls and endless arrays have none
  Substance substance;
  std::optional<WetElements> wet_back;
  Surface surface;
  Light light;
  Detector detector;
  Idealisation idealisation;
  /// What the file says; none of a design that is not from a file.
  std::shared_ptr<const schema::Document> document;

  /// Every file that a key names, from the working directory: what is read beside the source.
  std::vector<std::filesystem::path> files() const;
  /// Returns a warning for each key of the design file that has no effect because of another key.
  std::vector<std::string> warnings() const;
  /// Where a key was given, or would be missed.
  InputLocation where(std::string_view key) const;
  /// The same of what decides the texture of the facets.
  InputLocation where_texture() const;
  /// The same of what decides their form.
  InputLocation where_form() const;
  /// Of what makes them other than smooth planes: the texture, or the form where there is none.
  InputLocation where_facets() const { return surface.is_smooth() ? where_form() : where_texture(); }
  std::string_view entrance_key() const;
  /// The key is now what `place` says, for messages.
  void set_where(const std::string& key, InputLocation place);

  // The shape, if it is of that kind; otherwise null.
  const ElementArray* elements() const { return std::get_if<ElementArray>(&shape); }
  const raytrace::BallLayer* balls() const { return std::get_if<raytrace::BallLayer>(&shape); }
  const PartMesh* mesh() const { return std::get_if<PartMesh>(&shape); }
  const ZonedPart* zoned() const { return std::get_if<ZonedPart>(&shape); }
  /// What single elements differ in; null without it.
  const ArrayMask* mask() const;
  const FacetPlanesFile* facet_planes() const;
  /// \pre elements()
  const geometry::PartSpec& part() const { return std::get<ElementArray>(shape).part; }
  geometry::PartSpec& part() { return std::get<ElementArray>(shape).part; }
  /// Whether its array is infinite. False for balls, whose layer is infinite if it has a pitch.
  bool is_endless() const { return elements() != nullptr && part().array.extent == geometry::Extent::infinite; }
  /// Of its plate, as the design gives it; 0 if it does not.
  double thickness_mm() const;

  /// What messages call the source.
  std::string source_name() const { return source == "-" ? "standard input" : source; }
  /// Where what makes the entrance face scatter was given. \pre surface.entrance.scatters()
  InputLocation where_entrance_scatters() const;
  /// Whether the retro facets rely on total reflection.
  bool needs_total_reflection() const { return !idealisation.mirror_facets && !surface.coating.has_opaque_facets(); }
};

/// What a question takes of designs beside elements on a plane behind a plane face.
struct Takes {
  std::string_view what;  ///< asks, such as "retrace job"
  bool balls = false;
  bool solids = false;  ///< meshes and plates are supported
  bool zones = false;   ///< parts of zones are supported, even if `solids` is false
  bool substrates = true;
  bool entrances = false;
  bool wet_backs = false;
};
/// \throw InputError for a design that is not taken
void check_taken(const Design& design, const Takes& takes);

}  // namespace retrace::studies
