#include "studies/closed_loop/machined_zones.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"
#include "core/schema/document.h"
#include "core/schema/writer.h"
#include "design/zone_elements.h"
#include "geometry/elements/element_cells.h"
#include "geometry/part/zones.h"
#include "studies/closed_loop/part_planes.h"

namespace retrace::studies {
namespace {

using geometry::Vec2;

constexpr double kToldSpreadArcmin = 0.05;

/// Finds whole elements of a design by the position of their apex.
class DesignElements {
 public:
  struct Element {
    std::size_t zone = 0;
    double rotation_deg = 0.0;
  };

  explicit DesignElements(const geometry::ZonedSpec& spec) {
    const auto elements = geometry::whole_elements(spec);
    for (std::size_t z = 0; z < elements.size(); ++z)
      for (const geometry::ElementPlacement& at : elements[z]) elements_[key_of(at.apex_mm)] = {z, at.rotation_deg};
  }
  std::size_t size() const { return elements_.size(); }
  const Element* at(const Vec2& apex) const {
    const auto [x, y] = key_of(apex);
    for (const std::int64_t i : {x, x - 1, x + 1})
      for (const std::int64_t j : {y, y - 1, y + 1})
        if (const auto element = elements_.find({i, j}); element != elements_.end()) return &element->second;
    return nullptr;
  }

 private:
  static std::pair<std::int64_t, std::int64_t> key_of(const Vec2& p) {
    constexpr double kStepMm = 1e-6;
    return {std::llround(p.x() / kStepMm), std::llround(p.y() / kStepMm)};
  }

  std::map<std::pair<std::int64_t, std::int64_t>, Element> elements_;
};

struct ZoneTilts {
  std::array<double, 3> sum{};
  double least = 0.0;
  double most = 0.0;
  int count = 0;

  void add(const std::array<double, 3>& tilts) {
    for (std::size_t f = 0; f < 3; ++f) sum[f] += tilts[f];
    const auto [low, high] = std::ranges::minmax(tilts);
    least = count == 0 ? low : std::min(least, low);
    most = count == 0 ? high : std::max(most, high);
    ++count;
  }
};

design::ZoneChange change_of(const std::string& key, const std::array<double, 3>& arcmin) {
  return {key, schema::override_text(key, std::vector(arcmin.begin(), arcmin.end()))};
}

/// Returns the cube corner of a zone with its size in the part. Because of shrinkage, the cube corner in the mould is
/// larger.
geometry::Element part_element(const fabrication::Job& job, std::size_t zone) {
  fabrication::Job part = job;
  part.workpiece.shrinkage_percent = 0.0;
  return fabrication::blank_element(part, zone);
}

/// Checks that the design has every element that a zone of the job cuts.
/// \throw InputError at the zone of the job if an element is missing or differs
void check_zone(const fabrication::Job& job, std::size_t zone, const DesignElements& elements,
                const geometry::ZonedSpec& spec) {
  const InputLocation where = job.where(schema::path_of_entry("zone", zone));
  const geometry::Element cut = part_element(job, zone);
  for (const Vec2& apex : job.zones[zone].apexes_mm) {
    const std::string which = fmt::format("the element at x = {}, y = {} mm", shortest(apex.x()), shortest(apex.y()));
    const DesignElements::Element* const at = elements.at(apex);
    if (at == nullptr)
      throw InputError(where, which + " is not in the job's design, so no as-machined part can be written");
    const geometry::Element& designed = spec.zones[at->zone].elements.element;
    constexpr double kSame = 1e-9;
    const double turn_deg = std::remainder(at->rotation_deg - job.zones[zone].rotation_deg, 360.0);
    const double size = geometry::element_depth_mm(cut) / geometry::element_depth_mm(designed);
    if (cut.index() != designed.index() || std::abs(turn_deg) > kSame || std::abs(size - 1.0) > kSame)
      throw InputError(
          where,
          which +
              " has another kind, size or rotation in the job's design, so that no as-machined part can be written");
  }
}

/// Facet angles of a zone of the design.
struct CutAngles {
  std::optional<geometry::AngleErrors> asked;  ///< angle errors that the job specifies
  ZoneTilts missed;                            ///< deviations of the machined elements from the specified angles
};

/// Collects the facet angles for each zone of the design.
/// \throw InputError at a zone of the job that does not agree with the design
std::vector<CutAngles> cut_angles(const fabrication::Job& job, const std::vector<ElementTilts>& elements,
                                  const DesignElements& designed, const geometry::ZonedSpec& spec) {
  std::vector<CutAngles> angles(spec.zones.size());
  for (std::size_t z = 0, k = 0; z < job.zones.size(); ++z) {
    check_zone(job, z, designed, spec);
    const geometry::AngleErrors asked = fabrication::angle_errors_of(job, z);
    for (const Vec2& apex : job.zones[z].apexes_mm) {
      const ElementTilts& element = elements[k++];
      if (!element) continue;
      CutAngles& of_zone = angles[designed.at(apex)->zone];
      if (of_zone.asked.value_or(asked) != asked)
        throw InputError(job.where(schema::path_of_entry("zone", z)),
                         "has different angles from an earlier zone of the job, but both belong to one zone of the "
                         "job's design, so no as-machined part can be written");
      of_zone.asked = asked;
      of_zone.missed.add(*element);
    }
  }
  return angles;
}

}  // namespace

design::ZonedPart machined_zones(const fabrication::Job& job, const std::filesystem::path& job_file,
                                 const std::vector<ElementTilts>& elements, Warnings& warnings) {
  const Field at{"as_machined"};
  const std::optional<design::Design> design = design_of_job(job, job_file);
  if (!design)
    throw InputError(
        at,
        "the regions of the zones are taken from the job's design, but this file does not exist at the path "
        "that the job gives");
  if (!design->zoned())
    throw InputError(at, "the regions of the zones are taken from the job's design, but it has no [[zone]]");
  design::ZonedPart part = *design->zoned();
  part.spec = design::zones_of(*design);
  const DesignElements designed(part.spec);
  const std::vector<CutAngles> angles = cut_angles(job, elements, designed, part.spec);
  part.base.array.partial_elements = geometry::PartialElements::omit;
  part.base.angle_errors = {};
  part.base.edges = {};
  part.base.random_tilts = {};
  std::size_t cut = 0;
  double spread_arcmin = 0.0;
  for (std::size_t z = 0; z < angles.size(); ++z) {
    // Remove changes of [surface] and of partial_elements from the zone. Programs do not cut edge radii and random
    // errors, angle errors are set below, and an as-machined part has no partial elements.
    std::erase_if(part.changes[z], [](const design::ZoneChange& change) {
      return change.key.starts_with("surface.") || change.key == "array.partial_elements";
    });
    geometry::AngleErrors errors = angles[z].asked.value_or(part.spec.zones[z].elements.angle_errors);
    const ZoneTilts& missed = angles[z].missed;
    for (std::size_t f = 0; missed.count > 0 && f < 3; ++f) errors.facet_tilt_arcmin[f] += missed.sum[f] / missed.count;
    cut += static_cast<std::size_t>(missed.count);
    spread_arcmin = std::max(spread_arcmin, missed.most - missed.least);
    part.changes[z].push_back(change_of("surface.dihedral_error_arcmin", errors.dihedral_error_arcmin));
    part.changes[z].push_back(change_of("surface.facet_tilt_arcmin", errors.facet_tilt_arcmin));
  }
  part.outline = design::with_absolute_path(std::move(part.outline));
  for (design::ElementsOfZone& of_zone : part.elements)
    if (of_zone.mask) of_zone.mask->name = std::filesystem::absolute(of_zone.mask->file).string();
  if (cut < designed.size())
    warnings.push_back({"uncut_elements_included",
                        fmt::format("{} of {} elements are not cut, but are contained in the as-machined design",
                                    designed.size() - cut, designed.size())});
  if (spread_arcmin > kToldSpreadArcmin)
    warnings.push_back(
        {"facets_differ_from_mean",
         fmt::format("facets of a zone differ by up to {} arcmin: the as-machined design contains their mean",
                     fixed(spread_arcmin, 2))});
  return part;
}

}  // namespace retrace::studies
