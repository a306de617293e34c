#include "design/io/init_templates.h"

#include <fmt/format.h>

#include <array>

#include "core/error.h"
#include "core/message_text.h"

namespace retrace::design {
namespace {

constexpr std::array<std::string_view, 5> kTemplateKinds = {"rtp", "hexagonal_icc", "triangular_icc", "round_icc",
                                                            "round_zone_lens"};
constexpr std::size_t kDesignKinds = 4;

constexpr std::string_view kRtpHead =
    R"(# A retroreflector of right triangular prisms. Lengths in mm, angles in degrees.
# Lines that begin with "#" show defaults and alternatives.
schema = "retrace.design/1"
title = "Right triangular prisms in brick rows"

[element]
kind = "rtp"                      # right triangular prism
base_mm = 0.5                     # length across the roof edge (x)
width_mm = 0.5                    # length along the roof edge (y)
# apex_angle_deg = 90             # included angle of the two facets, 60 to 120

[array]
arrangement = "offset"            # single | aligned (default) | offset (brick rows) | checker (base = width)
shifted_rows = "odd"              # offset only: "even" (default) shifts rows 2, 4, ...; "odd" rows 1, 3, ...
# overlap_percent = 50            # offset only: shift of the rows, in percent of the base
x_length_mm = 10                  # length of the part along x; not for "single" or extent = "infinite"
y_length_mm = 10
# x_gap_mm = 0                    # width of the flat land between elements, along x
# y_gap_mm = 0
)";

/// Returns the first lines of a design of cube corners.
/// \param elements elements in the plural, for the first comment
/// \param aperture shape of the aperture, which is also the first word of the kind
/// \param arrangement default arrangement of the elements
std::string cube_corner_head(std::string_view elements, std::string_view title, std::string_view aperture,
                             std::string_view arrangement) {
  return fmt::format(R"(# A retroreflector of {0}. Lengths in mm, angles in degrees.
# Lines that begin with "#" show defaults and alternatives.
schema = "retrace.design/1"
title = "{1}"

[element]
kind = {3:<27}# inverted cube corner, {2} aperture
aperture_mm = 1.632993161855452   # diameter of the circumscribed circle: 2 a sqrt(2/3), for a cube edge a of 1 mm

[array]
arrangement = {5:<20}# {4} (default) | single
x_length_mm = 10                  # length of the part along x; not for "single" or extent = "infinite"
y_length_mm = 10
)",
                     elements, title, aperture, in_quotes(fmt::format("{}_icc", aperture)), arrangement,
                     in_quotes(arrangement));
}

constexpr std::string_view kRoundHead =
    R"(# A single cube corner with a circular face. Lengths in mm, angles in degrees.
# Lines that begin with "#" show defaults and alternatives.
schema = "retrace.design/1"
title = "Round cube corner"

[element]
kind = "round_icc"                # single cube corner, circular face
diameter_mm = 25.4                # diameter of the face
length_mm = 19                    # from the apex to the face; or edge_length_mm; default: the minimum
# chamfer_mm = 0                  # width of the chamfer at the rim of the face
# recess_mm = 0                   # depth of the face below the edge of its mount; also mount_diameter_mm
# hollow = false                  # true: three mirrors without a body

[body]
material = "fused-silica"         # `retrace list materials` shows the available materials
)";

/// Last keys of the table [array] and first keys of the table [body] in templates.
constexpr std::string_view kArrayTail = R"(# x_offset_mm = 0                 # flat margin at both ends in x
# y_offset_mm = 0
# extent = "finite"               # "infinite" is one periodic cell, without x_length_mm and y_length_mm
# partial_elements = "cut"        # elements are cut at the border; "omit" replaces them by flat back

[body]
thickness_mm = 2.0                # thickness of the plate between the entrance face and the rims
material = "PMMA"                 # `retrace list materials` shows the available materials
)";

constexpr std::string_view kCommonTail =
    R"(# refractive_index = 1.4917       # takes precedence over the index of the material
# absorption_per_mm = 0           # Napierian, for power; takes precedence over the material

[light]
wavelength_nm = 587.56            # or spectrum = "A", "D65", "lamp.csv", [[wavelength_nm, power], ...]
# polarisation = "unpolarised"    # "linear" (polarisation_angle_deg), "right_circular", "left_circular", [i, q, u, v]

[detector]
acceptance_half_angle_deg = 0.5   # in air; a list such as [0.2, 0.5, 1] gives RRE for each half-angle

[surface]
# roughness_sq_nm = 0             # RMS roughness of the retro facets; requires correlation_length_um
# root_radius_um = 0              # radius of the roots, where facets of one element meet; or root_chamfer_um
# rim_radius_um = 0               # radius of the rims, where elements meet; or rim_chamfer_um
# dihedral_error_arcmin = 0       # added to the angle between facets; cube corners: one value or three
# facet_tilt_arcmin = 0           # list with one value for each facet; positive tilts open the element

# [idealisation]                  # for comparison with theory
# facets = "real"                 # "mirror": facets reflect all light at every angle
# entrance = "real"               # "lossless": the entrance face refracts with T = 1
)";

constexpr std::string_view kRoundZoneLens =
    R"(# A round zone lens for millimetre waves, turned on a lathe. Lengths in mm.
# Lines that begin with "#" show defaults and alternatives.
schema = "retrace.planed_part/1"
title = "Round zone lens, 60 GHz"

[element]
kind = "round_zone_lens"
focal_length_mm = 200             # distance of the focus from the centre of the stepped face
wavelength_mm = 5                 # in air
refractive_index = 1.52           # polyethylene
width_mm = 180                    # diameter

[tolerance]
form_mm = 0.05                    # form tolerance: maximum distance from the surface that the nose can produce

[lathe]                           # X is the radius
feed_mm_per_min = 200
spindle_rpm = 800                 # a whole number, 1 to 99999
spindle_direction = "clockwise"   # M3; or "counterclockwise", M4
# depth_of_cut_mm = 1             # maximum depth of cut of a pass
# clear_mm = 2                    # height above the blank of moves without cutting
# nose_radius_mm = 0              # radius of the tool's nose
# spindle_start = "M103"          # line that starts the spindle at this speed; for --dialect pmac, a3200, automation1
# spindle_stop = "M105"           # line that stops the spindle; other dialects have words for the spindle
)";

}  // namespace

std::span<const std::string_view> design_kinds() {
  return std::span(kTemplateKinds).first(kDesignKinds);
}

std::string design_template(std::string_view kind) {
  if (kind == kTemplateKinds[0]) return std::string(kRtpHead).append(kArrayTail).append(kCommonTail);
  if (kind == kTemplateKinds[1])
    return cube_corner_head("full cube corners with hexagonal apertures", "Hexagonal cube corners in a honeycomb",
                            "hexagonal", "honeycomb")
        .append(kArrayTail)
        .append(kCommonTail);
  if (kind == kTemplateKinds[2])
    return cube_corner_head("cube corners with triangular apertures", "Triangular cube corners", "triangular",
                            "triangular")
        .append(kArrayTail)
        .append(kCommonTail);
  if (kind == kTemplateKinds[3]) return std::string(kRoundHead).append(kCommonTail);
  if (kind == kTemplateKinds[4]) return std::string(kRoundZoneLens);
  throw InputError(fmt::format("KIND must be one of {}, got {}", alternatives(kTemplateKinds), in_quotes(kind)));
}

}  // namespace retrace::design
