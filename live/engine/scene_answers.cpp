// Answers about the part: its shape, its plan, and light paths through a portion of it.
#include <nlohmann/json.hpp>

#include "core/base64.h"
#include "design/design_part.h"
#include "geometry/io/stl_file.h"
#include "live/engine/answers.h"
#include "live/engine/request.h"
#include "studies/rre/footprint.h"
#include "studies/scene/path_words.h"

namespace retrace::live {
namespace {

using raytrace::PathEvent;

// Maximum number of elements of a finite array for which the plan is drawn.
constexpr std::int64_t kMaxDrawnElements = 5000;

/// Names in the order of geometry::FacetRole.
constexpr std::string_view kRoleNames[] = {"entrance", "retro_facet", "flat_back", "inner_wall", "border_wall", "side"};

std::string_view event_name(PathEvent event) {
  switch (event) {
    case PathEvent::enters: return "enters";
    case PathEvent::total_reflection: return "total_reflection";
    case PathEvent::reflection: return "reflection";
    case PathEvent::leaves: return "leaves";
    case PathEvent::exits: return "exits";
    case PathEvent::enters_again: return "enters_again";
    case PathEvent::leaves_side: return "leaves_side";
    case PathEvent::escapes: return "escapes";
    case PathEvent::stopped: return "stopped";
    case PathEvent::ends: break;
  }
  return "ends";
}

template <class Points>
Json flat(const Points& points) {
  Json list = Json::array();
  for (const auto& p : points)
    for (const auto c : p) list.push_back(c);
  return list;
}

Json flat(const std::vector<studies::EntranceFace::Line>& lines) {
  Json list = Json::array();
  for (const auto& [from, to] : lines)
    for (const double c : {from.x(), from.y(), to.x(), to.y()}) list.push_back(c);
  return list;
}

Json plan_json(const geometry::Part& part) {
  if (!part.period_mm && part.elements_full > kMaxDrawnElements) {
    Json outline = flat(part.outline);
    return {{"outline", std::move(outline)}, {"periodic", false}, {"rims", Json::array()}, {"roots", Json::array()}};
  }
  const studies::EntranceFace face = studies::entrance_face_of(part);
  return {{"outline", flat(face.outline_mm)},
          {"periodic", face.is_periodic},
          {"rims", flat(face.rims_mm)},
          {"roots", flat(face.roots_mm)}};
}

/// Returns the critical angle of total reflection if the light comes from the denser side of a face.
std::optional<double> critical_deg(const raytrace::Optics& optics, const raytrace::PathStep& step) {
  const bool is_back = step.role != geometry::FacetRole::entrance && step.role != geometry::FacetRole::side;
  if (step.event == PathEvent::enters || step.event == PathEvent::enters_again || step.event == PathEvent::escapes ||
      step.event == PathEvent::stopped || step.event == PathEvent::ends)
    return std::nullopt;
  const double ratio = is_back ? optics.back_index / optics.index : 1.0 / optics.index;
  return ratio < 1.0 ? std::optional(Angle::from_rad(std::asin(ratio)).deg()) : std::nullopt;
}

Json path_json(const raytrace::LightPath& path, const raytrace::Optics& optics) {
  Json steps = Json::array();
  for (const raytrace::PathStep& step : path.steps) {
    Json json = {{"event", event_name(step.event)},
                 {"role", kRoleNames[static_cast<std::size_t>(step.role)]},
                 {"at_mm", {step.at_mm.x(), step.at_mm.y(), step.at_mm.z()}},
                 {"incidence_deg", step.incidence_deg},
                 {"power", step.power},
                 {"text", studies::description_of(step)}};
    if (const auto critical = critical_deg(optics, step)) json["critical_deg"] = *critical;
    steps.push_back(std::move(json));
  }
  return {{"points", flat(path.points_mm)},     {"power", path.power},
          {"returned", path.is_returned},       {"deviation_deg", path.deviation_deg},
          {"fate", studies::ending_text(path)}, {"steps", std::move(steps)}};
}

}  // namespace

Json part_json(const OpenedDesign& opened) {
  const studies::DesignExcerpt& piece = opened.excerpt();
  const geometry::Part& part = opened.require_model().part;
  Json roles = Json::array();
  for (const geometry::FacetRole role : piece.mesh().roles) roles.push_back(static_cast<std::size_t>(role));
  const geometry::Vec2 middle =
      geometry::bounding_box(part.period_mm ? geometry::to_polygon({geometry::Vec2::Zero(), *part.period_mm})
                                            : part.outline)
          .centre();
  const geometry::Vec2 shift = piece.equivalent_position(middle) - middle;
  Json json = {{"vertices", flat(piece.mesh().vertices)},
               {"triangles", flat(piece.mesh().triangles)},
               {"roles", std::move(roles)},
               {"role_names", kRoleNames},
               {"edges", flat(piece.edges())},
               {"remarks", piece.remarks()},
               {"thickness_mm", piece.model().part.thickness_mm},
               {"centre_mm", {piece.centre_mm().x(), piece.centre_mm().y()}},
               {"shift_mm", {shift.x(), shift.y()}}};
  json.update(plan_json(part));
  return json;
}

Json path_json(const OpenedDesign& opened, const Json& request) {
  const auto at_mm = get<std::vector<double>>(request, "at_mm");
  if (at_mm.size() != 2) throw InputError({"", 0, "at_mm"}, "must be [x, y]");
  const studies::SceneLight light = light_of(request);
  const studies::DesignExcerpt& piece = opened.excerpt();
  return path_json(piece.path(light, piece.entry_of(light, {at_mm[0], at_mm[1]})), piece.model().optics);
}

Json typical_paths_json(const OpenedDesign& opened, const Json& request) {
  const studies::DesignExcerpt& piece = opened.excerpt();
  Json paths = Json::array();
  for (const studies::ScenePath& story : piece.typical_paths(light_of(request))) {
    Json json = path_json(story.path, piece.model().optics);
    json["share"] = story.fraction;
    paths.push_back(std::move(json));
  }
  return {{"paths", std::move(paths)}};
}

Json stl_json(const OpenedDesign& opened) {
  const design::Design& design = opened.design();
  const geometry::BoundaryMesh mesh =
      design.elements() && !design.entrance
          ? geometry::closed_boundary(design::part_of(design::single_element_of(design)))
          : opened.excerpt().mesh();
  return {{"name", "element.stl"}, {"base64", base64(geometry::stl_text(mesh, design.title))}};
}

}  // namespace retrace::live
