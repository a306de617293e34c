#pragma once

// Contents of a design file: shape, material, surface, light and detector. They have been checked, and defaults are
// filled in. Every study begins with a Design.

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/schema/document.h"
#include "core/warning.h"
#include "geometry/elements/element_choice.h"
#include "geometry/elements/part_spec.h"
#include "geometry/entrance/entrance_shape.h"
#include "geometry/part/zones.h"
#include "raytrace/balls/ball_layer.h"
#include "raytrace/light/stokes.h"

namespace retrace::geometry {
class FacetPlanes;
}

namespace retrace::design {

/// Optical idealisations that a design may request, for comparison with theory.
struct Idealisation {
  bool mirror_facets = false;  ///< true: retro facets reflect all light at every angle
  /// True if the entrance face transmits all light. Light from inside beyond the critical angle is then lost.
  bool lossless_entrance = false;
};

enum class HeightMapAxis { x, y };

struct SmoothTexture {};
/// Roughness with a Gaussian autocorrelation of heights, and periodic waviness. At least one of the two rms heights is
/// above 0.
struct HarveyShackTexture {
  double roughness_sq_nm = 0.0;        ///< rms height of the roughness
  double correlation_length_um = 0.0;  ///< distance at which the Gaussian autocorrelation is 1/e
  double waviness_sq_nm = 0.0;
  double waviness_length_um = 0.0;  ///< period of the waviness
  /// Correlation length along the line of steepest descent of the facet, if it differs from correlation_length_um. In
  /// this case, correlation_length_um applies to the horizontal direction. If the value is 0, correlation_length_um
  /// applies to both directions.
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
  bool ggx = false;  ///< true: GGX distribution of slopes, with longer tails than a Gaussian
};
struct HeightMapTexture {
  std::string name;  ///< name of the file, as given
  /// Path of the file, relative to the working directory; make_model() checks the file when it reads it.
  std::filesystem::path file;
  /// Axis of the map that is horizontal on a facet. For a prism, it is parallel to the roof edge.
  HeightMapAxis horizontal_axis = HeightMapAxis::x;
  int form_degree = 1;  ///< degree of the polynomial that is removed from the map, 1..8
};
/// Surface texture of the retro facets. The alternatives have the same order as the words of `surface.model`.
using SurfaceFinish = std::variant<SmoothTexture, HarveyShackTexture, AbgTexture, MicrofacetTexture, HeightMapTexture>;

/// Term of a polynomial over a facet: height_um * x^x_power * y^y_power. x is the horizontal coordinate and y the
/// coordinate down the facet, both in units of the facet's radius.
struct FormTerm {
  int x_power = 0;
  int y_power = 0;         ///< x_power + y_power is at most 8
  double height_um = 0.0;  ///< coefficient; positive is out of the body
};
struct FormMap {
  std::string name;  ///< name of the file, as given
  /// Path of the file, relative to the working directory; make_model() checks the file when it reads it.
  std::filesystem::path file;
  HeightMapAxis horizontal_axis = HeightMapAxis::x;
  int degree = 4;  ///< degree of the polynomial that is fitted to the map, 2..8
};
/// Deviation of the retro facets from planes. It is the sum of the three members, and it is equal for all facets.
struct FormOfFacets {
  /// Sag of a paraboloid into the body, from the farthest corner of the facet to the facet's centre.
  double sink_um = 0.0;
  std::vector<FormTerm> terms;
  std::optional<FormMap> map;

  bool is_plane() const { return sink_um == 0.0 && terms.empty() && !map; }
};

struct SpectralAbsorption {
  double wavelength_nm = 0.0;
  double per_mm = 0.0;  ///< Napierian absorption coefficient for power; >= 0

  bool operator==(const SpectralAbsorption&) const = default;
};
/// Napierian absorption coefficient for power. The alternatives are the value of the material, a number per mm, and a
/// table with linear interpolation. The wavelengths of the table ascend.
using Absorption = std::variant<std::monostate, double, std::vector<SpectralAbsorption>>;

/// Light of more than one wavelength, as the design specifies it.
struct LightSpectrum {
  enum class Kind { illuminant_a, illuminant_d65, file, lines };
  struct Line {
    double wavelength_nm = 0.0;
    double power = 0.0;  ///< in any unit, >= 0
  };
  Kind kind = Kind::illuminant_a;
  std::string name;            ///< name of the file, as given; empty if there is none
  std::filesystem::path file;  ///< path of the file, relative to the working directory; empty if there is none
  std::vector<Line> lines;     ///< in ascending order of wavelength
  bool photopic = true;        ///< true: results are fractions of the luminous flux; false: of the power
};

/// Image that selects elements of an array: the array has elements where pixels are dark.
struct ArrayMask {
  std::string name;            ///< name of the file, as given
  std::filesystem::path file;  ///< path of the file, relative to the working directory
  double threshold = 0.7;      ///< pixels with grey < threshold * 255 are dark and have elements
};

/// File with planes of individual facets. They replace the nominal planes of the facets.
struct FacetPlanesFile {
  std::string name;  ///< name of the file, as given
  /// Path of the file, relative to the working directory; part_of() checks the file when it reads it.
  std::filesystem::path file;
  /// Planes that replace those of the file. If the pointer is null, the file is read.
  std::shared_ptr<const geometry::FacetPlanes> planes = {};
};

/// Description of an outline: the keys of the table [outline].
struct OutlineKeys {
  /// Keys that are set in the table, and their values, in the order of the file format. The margin and the tolerance
  /// are not included, because geometry::PlanRegion stores them.
  std::vector<std::pair<std::string, schema::Value>> values;
  /// Path of the DXF or STEP file, relative to the working directory; empty if the outline is not in a file.
  std::filesystem::path file;
};

/// Returns the keys after making the path of the file absolute. A design that is written to another folder needs an
/// absolute path.
OutlineKeys with_absolute_path(OutlineKeys outline);

/// Random differences between the cells of an infinite array whose light interferes. The differences are Gaussian and
/// independent from cell to cell.
struct CellSpread {
  double depth_nm = 0.0;    ///< standard deviation of the depth of a cell
  double spacing_nm = 0.0;  ///< standard deviation of the position of a cell, along x and along y
};

/// Array of elements, the plate in front of them, and differences between individual elements.
struct ElementArray {
  geometry::PartSpec part;
  std::optional<ArrayMask> mask;
  std::optional<FacetPlanesFile> facet_planes;  ///< planes of individual facets; only for finite parts without a mask
  /// Keys that determine `part.array.outline`. If there are no such keys, documents of the design describe the outline
  /// by the sides and arcs of its borders.
  OutlineKeys outline = {};
  /// Spread of the cells if the fields of different cells are added. Empty: their intensities are added.
  std::optional<CellSpread> cell_spread = {};
};

/// Part whose shape is given by a mesh.
struct PartMesh {
  std::string name;            ///< name of the STL file, as given
  std::filesystem::path file;  ///< path of the file, relative to the working directory; part_of_design() reads the file
  /// True if a mesh that is not closed is traced. Its openings are then closed by flat patches.
  bool allow_open = false;
  std::optional<double> thickness_mm;  ///< thickness that the mesh must have; not checked if empty
};

/// Plate whose flat back, the plane z = 0, is its retro facet.
struct Plate {
  std::array<double, 2> size_mm = {};  ///< size in x and y
  double thickness_mm = 0.0;
};

/// Elements of an array that belong to a zone. Only one of the members rows, columns, mask and rest is used.
struct ElementsOfZone {
  std::vector<double> rows;       ///< numbers of rows, from 1 at the smallest y
  std::vector<double> columns;    ///< numbers of columns, from 1 at the smallest x
  std::optional<double> every;    ///< period after which the numbers of rows or columns repeat
  std::optional<ArrayMask> mask;  ///< elements whose centroid is on a dark pixel
  bool is_remainder = false;      ///< true: all elements that belong to no other zone
};

/// Change of a key of the design in a zone.
struct ZoneChange {
  std::string key;   ///< such as "element.aperture_mm"
  std::string text;  ///< KEY=VALUE, as in the file
};

/// Plate with zones of different elements. The zones are either regions of the plate or sets of elements of one array.
struct ZonedPart {
  geometry::PartSpec base;                       ///< elements of the design, before the changes of a zone are applied
  std::vector<std::vector<ZoneChange>> changes;  ///< changes of each zone
  std::vector<ElementsOfZone> elements;          ///< elements of each zone; empty if the zones are regions
  geometry::ZonedSpec spec;                      ///< zones in detail; part_of_design() adds the cells that masks select
  OutlineKeys outline = {};                      ///< keys that determine `spec.outline`

  bool has_masks() const {
    return std::ranges::any_of(elements, [](const ElementsOfZone& of_zone) { return of_zone.mask.has_value(); });
  }
};

/// Shape that a design describes.
using Shape = std::variant<ElementArray, PartMesh, Plate, ZonedPart, raytrace::BallLayer>;

/// File that contains a curved entrance face.
struct EntranceFile {
  std::string name;  ///< name of the file, as given
  /// Path of the file, relative to the working directory; entrance_of_design() reads the file.
  std::filesystem::path file;
  bool is_mesh = false;  ///< true: an STL file; false: the file of a turned part
  /// True if the mesh is a counterpart that is located above the entrance face. The entrance face then consists of the
  /// triangles of the mesh that face downward.
  bool mesh_bottom = false;
};

/// Curved entrance face that is described by keys of the design instead of a file.
struct EntranceForm {
  geometry::EntranceShape shape;
  double rotation_deg = 0.0;  ///< rotation about the axis of the face, before the face is inclined
  geometry::EntranceInclination inclination;
  /// True if the design specifies the pin angle `pin_angle_deg`. If false, the pin angle is the angle of refraction of
  /// light that is incident along the reference axis.
  bool has_pin_angle = false;
};

/// Curved entrance face, which replaces the plane entrance face.
struct CurvedEntrance {
  std::variant<EntranceForm, EntranceFile> surface;
  /// Position of the origin of the face (x and y) in the part frame; empty: the centre of the part.
  std::optional<std::array<double, 2>> centre_mm;

  /// Returns the keys that describe the face, or null if the face comes from a file.
  const EntranceForm* form() const { return std::get_if<EntranceForm>(&surface); }
  /// Returns the file that contains the face, or null if keys of the design describe the face.
  const EntranceFile* file() const { return std::get_if<EntranceFile>(&surface); }
  bool is_mesh() const { return file() != nullptr && file()->is_mesh; }
  /// Returns the name of the file as given in the design, or the kind of the surface if there is no file.
  std::string name() const;
};

/// Glass catalogue.
struct GlassCatalogueFile {
  std::string name;  ///< name of the file, as given
  /// Path of the file, relative to the working directory; make_model() checks the file when it reads it.
  std::filesystem::path file;
};

/// Returns the catalogue with an absolute file name, for designs that are written to another folder.
std::optional<GlassCatalogueFile> with_absolute_path(const std::optional<GlassCatalogueFile>& catalogue);

/// Material of the part, and medium behind its retro facets.
struct Substance {
  std::string material = "PMMA";
  std::optional<GlassCatalogueFile> catalogue;  ///< catalogue that contains the material; empty for shipped materials
  std::optional<double> refractive_index;  ///< takes precedence over the index of the material; relative to air, >= 1
  std::optional<double> temperature_c;  ///< temperature of part and air; if empty, the temperature of the material data
  Absorption absorption_per_mm;
  double back_index = 1.0;  ///< refractive index of the medium behind the facets, relative to air; 1..3
  bool is_hollow = false;   ///< true: the body is the air in front of three mirrors, and the members above describe air

  bool is_coloured() const { return std::holds_alternative<std::vector<SpectralAbsorption>>(absorption_per_mm); }
};

/// Shell: a separate lens in the air in front of the entrance face, such as the outer lens of a lamp.
struct OuterShell {
  double thickness_mm = 0.0;  ///< distance between both surfaces at the middle, along the normal of the outer surface
  /// Distance at the middle between the inner surface of the shell and the next surface towards the part.
  double gap_mm = 0.0;
  std::string material = "PMMA";
  std::optional<double> refractive_index;  ///< takes precedence over the index of the material; relative to air, >= 1
  Absorption absorption_per_mm;
  std::optional<double> outer_radius_mm;  ///< > 0: convex towards the source; empty: plane
  std::optional<double> inner_radius_mm;  ///< > 0: convex towards the source; empty: plane
  std::array<double, 2> wedge_deg = {};   ///< rotation of the inner surface about x and then y, relative to the outer
  std::array<double, 2> tilt_deg = {};    ///< rotation of the whole shell about x and then y

  /// Returns true if both surfaces are planes and parallel to each other, so that the shell keeps the direction of
  /// light.
  bool is_plane_parallel() const {
    return !outer_radius_mm && !inner_radius_mm && wedge_deg == std::array<double, 2>{};
  }
};

/// Selected elements of a finite array that have another medium behind them.
struct WetElements {
  double index = 1.333;  ///< refractive index of the medium behind these elements, relative to air; 1..3
  geometry::ElementChoice where;
};

/// Layer of a coating, as the design specifies it.
struct CoatingLayer {
  std::string material;  ///< name of a material or metal in the library; if empty, the index is given
  double refractive_index = 1.0;
  double extinction_coefficient = 0.0;
  std::optional<double> thickness_nm;  ///< thickness; if empty, the layer is opaque

  bool operator==(const CoatingLayer&) const = default;
};

/// Layer that `facet_coating = "aluminium"` describes.
inline const CoatingLayer kPlainAluminium = {"aluminium", 1.0, 0.0, {}};

/// Coatings of the faces of a part. The layers of each list are ordered from the body outwards.
struct Coating {
  std::vector<CoatingLayer> facets;    ///< at most one layer is opaque
  std::vector<CoatingLayer> entrance;  ///< no layer is opaque

  /// Returns true if the facets have the coating of `facet_coating = "aluminium"` and no other.
  bool has_only_aluminium_on_facets() const;
  bool has_opaque_facets() const;
};

/// Layer on the entrance face whose thickness is large compared with the coherence length of the light.
struct ThickCoatingLayer {
  double refractive_index = 1.0;
  double thickness_um = 0.0;
  double absorption_per_mm = 0.0;  ///< Napierian absorption coefficient for power
};

/// Contamination and damage of the entrance face. Coverages are fractions of its area; haze is a fraction of the light.
/// If a coverage or `haze` is above 0, the optional members that describe it are set. Only `scratch_azimuth_deg` may be
/// empty in this case.
struct EntranceState {
  std::vector<ThickCoatingLayer> layers;  ///< outside of the coating, ordered from the body outwards
  double film_coverage = 0.0;
  double water_index = 1.333;
  double drop_coverage = 0.0;
  std::optional<double> drop_contact_angle_deg;
  double dust_coverage = 0.0;
  std::optional<double> dust_albedo;
  std::optional<double> dust_forward_fraction;
  double scratch_coverage = 0.0;
  std::optional<double> scratch_spread_deg;
  std::optional<double> scratch_azimuth_deg;  ///< azimuth of the scratches; if empty, they have all directions
  double haze = 0.0;                          ///< fraction of the light that is scattered by more than 2.5 degrees
  std::optional<double> haze_spread_deg;
  double roughness_sq_nm = 0.0;
  double correlation_length_um = 0.0;

  /// Returns true if the face scatters light. A clean plane face does not.
  bool scatters() const {
    return drop_coverage > 0.0 || dust_coverage > 0.0 || scratch_coverage > 0.0 || haze > 0.0 || roughness_sq_nm > 0.0;
  }
  bool is_clean() const { return layers.empty() && film_coverage == 0.0 && !scatters(); }
};

/// Optical properties of surfaces other than the index: coatings, state of the entrance face, texture and form of the
/// retro facets.
struct Surface {
  Coating coating;
  EntranceState entrance;
  bool absorbing_walls = false;  ///< true: the walls of elements and of the border absorb all light
  SurfaceFinish texture;
  FormOfFacets form;

  bool is_smooth() const { return std::holds_alternative<SmoothTexture>(texture); }
};

/// Light that illuminates the part.
struct Light {
  std::variant<double, LightSpectrum> colour = 587.56;  ///< one wavelength in vacuum, in nm, or a spectrum
  /// Polarisation with respect to the axes of raytrace::source_axis(). The component i is 1.
  raytrace::Stokes polarisation = raytrace::kUnpolarised;

  /// Returns the spectrum, or null if the light has only one wavelength.
  const LightSpectrum* spectrum() const { return std::get_if<LightSpectrum>(&colour); }
  /// Returns the wavelength in vacuum.
  /// \pre the light has only one wavelength
  double wavelength_nm() const { return std::get<double>(colour); }
};

/// Definition of retroreflected light.
struct Detector {
  /// Half-angles of the acceptance cones, in air; ascending, each in (0, 90].
  std::vector<double> acceptance_half_angle_deg = {0.5};
};

/// Contents of a design file. They have been checked, and defaults are filled in.
struct Design {
  std::string source;  ///< file name as given, "-" for standard input
  std::string title;   ///< empty if no title was given
  Shape shape;
  std::optional<CurvedEntrance> entrance;  ///< curved entrance face; empty for plane faces, balls and infinite arrays
  std::vector<OuterShell> shells;          ///< in the order from the source to the part
  Substance substance;
  std::optional<WetElements> wet_back;
  Surface surface;
  Light light;
  Detector detector;
  Idealisation idealisation;
  /// Document of the design file. Null if the design was not read from a file.
  std::shared_ptr<const schema::Document> document;

  /// Returns the paths of all files to which keys of the design refer, relative to the working directory.
  std::vector<std::filesystem::path> files() const;
  /// Returns a warning for each key of the design file that has no effect because of another key.
  Warnings warnings() const;
  /// Returns the position at which a key was given. For a missing key, returns the position that messages report for
  /// it.
  InputLocation where(std::string_view key) const;
  /// Returns the position of the key that determines the texture of the facets.
  InputLocation where_texture() const;
  /// Returns the position of the key that determines the form of the facets.
  InputLocation where_form() const;
  /// Returns the position of the key that makes the facets differ from smooth planes. This is the key of the texture
  /// or, if the facets are smooth, the key of the form.
  InputLocation where_facets() const { return surface.is_smooth() ? where_form() : where_texture(); }
  /// Returns the inclination of the entrance face. Returns null if the axis of the face and the reference axis are both
  /// +z.
  const geometry::EntranceInclination* inclination() const;
  /// Returns the reference axis of photometry as a unit vector in the part frame, towards the light. It is the
  /// direction H = V = 0, which is the axis of the vehicle (UN R3, R150). The reference axis is +z unless the entrance
  /// face is inclined.
  geometry::Vec3 reference_axis() const;
  /// Returns the power of the incident beam, divided by its illuminance and by the area of the part in plan. The
  /// illuminance is measured perpendicular to the beam. The result is the cosine of the angle of incidence unless the
  /// entrance face is inclined. For an inclined face, the cross section of the beam is the outline, projected along z
  /// onto a plane perpendicular to the axis of the face.
  /// \param to_source unit vector in the part frame
  double incident_fraction(const geometry::Vec3& to_source) const;
  /// Returns the name of the key that determines the curved entrance face.
  std::string_view entrance_key() const;
  /// Returns true if any shell changes the direction of light. where_shell_deflects() returns the position of the first
  /// such shell in the file.
  bool has_deflecting_shells() const;
  InputLocation where_shell_deflects() const;

  // Each of these functions returns the shape, or null if the shape is of another kind.
  const ElementArray* elements() const { return std::get_if<ElementArray>(&shape); }
  const raytrace::BallLayer* balls() const { return std::get_if<raytrace::BallLayer>(&shape); }
  const PartMesh* mesh() const { return std::get_if<PartMesh>(&shape); }
  const ZonedPart* zoned() const { return std::get_if<ZonedPart>(&shape); }
  /// Returns the mask of the array. Null if there is none.
  const ArrayMask* mask() const;
  const FacetPlanesFile* facet_planes() const;
  /// Returns the spread of the cells if the light of different cells interferes, or null if their intensities are
  /// added.
  const CellSpread* cell_spread() const;
  /// \pre elements()
  const geometry::PartSpec& part() const { return std::get<ElementArray>(shape).part; }
  geometry::PartSpec& part() { return std::get<ElementArray>(shape).part; }
  /// Returns true if the design has an infinite array. Returns false for balls, even though a layer with a pitch is
  /// infinite.
  bool is_infinite() const { return elements() != nullptr && part().array.extent == geometry::Extent::infinite; }
  /// Returns the thickness of the plate as given in the design, or 0 if it is not given.
  double thickness_mm() const;

  /// Returns the name of the design in messages.
  std::string source_name() const { return source == "-" ? "standard input" : source; }
  /// Returns the position of the key that makes the entrance face scatter light.
  /// \pre surface.entrance.scatters()
  InputLocation where_entrance_scatters() const;
  /// Returns true if the retro facets reflect by total internal reflection, that is, without mirror coating.
  bool needs_total_reflection() const { return !idealisation.mirror_facets && !surface.coating.has_opaque_facets(); }
};

/// Kinds of designs that a study supports. Every study supports plane arrays of elements with a plane entrance face.
struct Capabilities {
  std::string_view what;  ///< name of the study for messages, such as "retrace job"
  bool balls = false;
  bool solids = false;  ///< meshes and plates are supported
  bool zones = false;   ///< parts with zones are supported, even if `solids` is false
  bool substrates = true;
  bool entrances = false;
  bool shells = false;
  bool wet_backs = false;
  bool cell_spreads =
      true;  ///< true if the study can add the fields of cells; false if it can only add their intensities
};
/// Checks that a study supports a design.
/// \throw InputError if it does not
void require_supported(const Design& design, const Capabilities& capabilities);

}  // namespace retrace::design
