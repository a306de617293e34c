#include "geometry/io/step_program/step_shapes.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepGProp.hxx>
#include <BRepTools.hxx>
#include <BRepTools_WireExplorer.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Eigen/Geometry>
#include <GProp_GProps.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Surface.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <Quantity_Color.hxx>
#include <STEPConstruct_Styles.hxx>
#include <STEPControl_Reader.hxx>
#include <ShapeUpgrade_ShapeDivideContinuity.hxx>
#include <StepShape_Face.hxx>
#include <StepVisual_StyledItem.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Wire.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <gp_Circ.hxx>
#include <gp_Pnt.hxx>
#include <gp_Trsf.hxx>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <sstream>

#include "geometry/io/step_program/step_refusal.h"

namespace retrace::geometry {
namespace {

constexpr double kRadPerDegree = std::numbers::pi / 180.0;
/// Angle between normals below which an edge counts as smooth.
constexpr double kSmoothDeg = 0.01;
constexpr double kRoundingMm = 1e-6;

std::string text_of(double value) {
  std::ostringstream text;
  text.precision(6);
  text << value;
  return text.str();
}

Vec2 plan_of(const gp_Pnt& p) {
  return {p.X(), p.Y()};
}

/// Returns the number of occurrences of a word.
std::size_t count_of(std::string_view text, std::string_view word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + word.size())) ++count;
  return count;
}

/// Face of the file with the properties by which designs select it.
struct Candidate {
  TopoDS_Face face;
  int number = 0;  ///< number of its entity in the file
  std::string name;
  std::string colour;  ///< "#rrggbb" or empty
  bool is_of_solid = false;
};

/// Returns the normal of a face, with its orientation, at a point of its surface. The length is not 1.
gp_Vec normal_at(const TopoDS_Face& face, const Handle(Geom_Surface) & surface, double u, double v) {
  gp_Pnt p;
  gp_Vec du;
  gp_Vec dv;
  surface->D1(u, v, p, du, dv);
  const gp_Vec normal = du.Crossed(dv);
  return face.Orientation() == TopAbs_REVERSED ? normal.Reversed() : normal;
}

/// Minimum and maximum z of unit normals inside a face.
struct NormalRange {
  double lowest = 1.0;
  double highest = -1.0;
};

NormalRange normals_of(const TopoDS_Face& face) {
  constexpr int kSteps = 9;
  NormalRange range;
  double u0 = 0.0, u1 = 0.0, v0 = 0.0, v1 = 0.0;
  BRepTools::UVBounds(face, u0, u1, v0, v1);
  BRepTopAdaptor_FClass2d border(face, Precision::PConfusion());
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  for (int j = 0; j < kSteps; ++j)
    for (int i = 0; i < kSteps; ++i) {
      const double u = u0 + (u1 - u0) * (i + 0.5) / kSteps;
      const double v = v0 + (v1 - v0) * (j + 0.5) / kSteps;
      if (border.Perform(gp_Pnt2d(u, v)) == TopAbs_OUT) continue;
      const gp_Vec normal = normal_at(face, surface, u, v);
      if (!(normal.Magnitude() > 0.0)) continue;
      const double z = normal.Z() / normal.Magnitude();
      range.lowest = std::min(range.lowest, z);
      range.highest = std::max(range.highest, z);
    }
  return range;
}

double area_of(const TopoDS_Face& face) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties, 1e-6);
  return std::abs(properties.Mass());
}

std::string hex_of(const Quantity_Color& colour) {
  static constexpr char kDigits[] = "0123456789abcdef";
  double red = 0.0, green = 0.0, blue = 0.0;
  // STEP files contain the values that programs display, so they are not converted to linear values.
  colour.Values(red, green, blue, Quantity_TOC_sRGB);
  std::string text = "#";
  for (const double value : {red, green, blue}) {
    const int byte = std::clamp(static_cast<int>(std::lround(255.0 * value)), 0, 255);
    text += kDigits[byte / 16];
    text += kDigits[byte % 16];
  }
  return text;
}

/// Contents of a STEP file.
class StepContents {
 public:
  explicit StepContents(const StepChoice& choice) {
    check_step_text(choice.file);
    Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
    if (reader_.ReadFile(choice.file.c_str()) != IFSelect_RetDone)
      refuse_step("must be a STEP file, but it cannot be understood");
    find_unit();
    reader_.TransferRoots();
    gp_Trsf rotation;
    const Eigen::Matrix3d r = geometry::rotation_of(choice);
    rotation.SetValues(r(0, 0), r(0, 1), r(0, 2), 0.0, r(1, 0), r(1, 1), r(1, 2), 0.0, r(2, 0), r(2, 1), r(2, 2), 0.0);
    const TopoDS_Shape shape = reader_.OneShape();
    if (shape.IsNull()) refuse_step("must contain faces, but OpenCASCADE finds none");
    shape_ = shape.Moved(TopLoc_Location(rotation));
    find_candidates();
    find_colours();
    if (candidates_.empty()) refuse_step("must contain faces, but OpenCASCADE finds none");
  }

  const std::vector<Candidate>& candidates() const { return candidates_; }
  const std::string& unit() const { return unit_; }

 private:
  void find_unit() {
    TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
    reader_.FileUnits(lengths, angles, solid_angles);
    for (int k = 1; k <= lengths.Length(); ++k) {
      const std::string name = lengths.Value(k).ToCString();
      if (unit_.find(name) == std::string::npos) unit_ += (unit_.empty() ? "" : ", ") + name;
    }
    if (unit_.empty()) refuse_step("must give its unit of length, but has none");
  }

  void find_candidates() {
    TopTools_IndexedMapOfShape of_solids;
    for (TopExp_Explorer solid(shape_, TopAbs_SOLID); solid.More(); solid.Next())
      TopExp::MapShapes(solid.Current(), TopAbs_FACE, of_solids);
    std::map<const Standard_Transient*, std::vector<std::size_t>> positions;
    TopTools_IndexedMapOfShape known;
    for (TopExp_Explorer face(shape_, TopAbs_FACE); face.More(); face.Next()) {
      if (known.Contains(face.Current())) continue;
      known.Add(face.Current());
      by_shape_[face.Current().TShape().get()].push_back(candidates_.size());
      candidates_.push_back({TopoDS::Face(face.Current()), 0, {}, {}, of_solids.Contains(face.Current())});
    }
    const Handle(Interface_InterfaceModel) model = reader_.WS()->Model();
    const Handle(Transfer_TransientProcess) transfer = reader_.WS()->TransferReader()->TransientProcess();
    for (int k = 1; k <= model->NbEntities(); ++k) {
      const Handle(StepShape_Face) entity = Handle(StepShape_Face)::DownCast(model->Value(k));
      if (entity.IsNull()) continue;
      const TopoDS_Shape shape = TransferBRep::ShapeResult(transfer, entity);
      if (shape.IsNull()) continue;
      for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
        for (const std::size_t index : by_shape_[face.Current().TShape().get()]) {
          candidates_[index].number = k;
          if (!entity->Name().IsNull()) candidates_[index].name = entity->Name()->ToCString();
        }
    }
  }

  void find_colours() {
    STEPConstruct_Styles styles(reader_.WS());
    if (!styles.LoadStyles()) return;
    const Handle(Transfer_TransientProcess) transfer = reader_.WS()->TransferReader()->TransientProcess();
    // The colour of a face takes precedence over the colour of the solid to which it belongs.
    std::vector<std::size_t> faces_coloured(candidates_.size(), SIZE_MAX);
    for (int k = 1; k <= styles.NbStyles(); ++k) {
      const Handle(StepVisual_StyledItem) style = styles.Style(k);
      Handle(StepVisual_Colour) surface, bound, curve, rendered;
      double transparency = 0.0;
      bool is_component = false;
      if (!styles.GetColors(style, surface, bound, curve, rendered, transparency, is_component)) continue;
      const Handle(StepVisual_Colour) given = !surface.IsNull() ? surface : rendered;
      Quantity_Color colour;
      if (given.IsNull() || style->Item().IsNull() || !STEPConstruct_Styles::DecodeColor(given, colour)) continue;
      const TopoDS_Shape shape = TransferBRep::ShapeResult(transfer, style->Item());
      if (shape.IsNull()) continue;
      TopTools_IndexedMapOfShape faces;
      TopExp::MapShapes(shape, TopAbs_FACE, faces);
      for (int f = 1; f <= faces.Extent(); ++f)
        for (const std::size_t index : by_shape_[faces(f).TShape().get()]) {
          const auto count = static_cast<std::size_t>(faces.Extent());
          if (count > faces_coloured[index]) continue;
          faces_coloured[index] = count;
          candidates_[index].colour = hex_of(colour);
        }
    }
  }

  STEPControl_Reader reader_;
  TopoDS_Shape shape_;
  std::string unit_;
  std::vector<Candidate> candidates_;
  std::map<const Standard_Transient*, std::vector<std::size_t>>
      by_shape_;  ///< indices of the candidates that have this shape
};

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::vector<TopoDS_Face> largest_of(const std::vector<Candidate>& candidates) {
  const Candidate* largest = nullptr;
  double area = 0.0;
  for (const Candidate& candidate : candidates) {
    if (candidate.is_of_solid && !(normals_of(candidate.face).lowest > 0.0)) continue;
    const double own = area_of(candidate.face);
    if (!(own > area)) continue;
    area = own;
    largest = &candidate;
  }
  if (largest == nullptr)
    refuse_step("must have a face that is larger than 0 and faces +z after the rotation, but has none");
  return {largest->face};
}

std::vector<TopoDS_Face> selected(std::vector<Candidate> candidates, const std::string& word) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.number < b.number; });
  if (word == "largest") return largest_of(candidates);
  const bool is_number = !word.empty() && word.size() <= 6 && std::all_of(word.begin(), word.end(), [](char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
  });
  std::vector<TopoDS_Face> faces;
  const auto choose = [&](const auto& is_chosen) {
    for (const Candidate& candidate : candidates)
      if (is_chosen(candidate)) faces.push_back(candidate.face);
  };
  choose([&](const Candidate& candidate) { return candidate.name == word; });
  if (!faces.empty()) return faces;
  if (word == "towards +z")
    choose([](const Candidate& candidate) { return normals_of(candidate.face).lowest > 0.0; });
  else if (is_number && std::stoul(word) >= 1 && std::stoul(word) <= candidates.size())
    faces.push_back(candidates[std::stoul(word) - 1].face);
  else if (word.starts_with('#'))
    choose([&](const Candidate& candidate) { return candidate.colour == lower_case(word); });
  if (!faces.empty()) return faces;
  refuse_step("has no face \"" + word + "\" among its " + std::to_string(candidates.size()) +
              " faces: give a name, a colour such as \"#ff0000\", a number from 1 on, \"largest\" or \"towards +z\"");
}

/// Divides a face at lines where its curvature or slope changes abruptly. Polynomials do not converge at such lines.
void add_smooth_parts(const TopoDS_Face& face, std::vector<TopoDS_Face>& parts) {
  ShapeUpgrade_ShapeDivideContinuity division(face);
  division.SetSurfaceCriterion(GeomAbs_C2);
  division.SetBoundaryCriterion(GeomAbs_C0);
  division.SetPCurveCriterion(GeomAbs_C0);
  const TopoDS_Shape all = division.Perform() ? division.Result() : TopoDS_Shape(face);
  for (TopExp_Explorer part(all, TopAbs_FACE); part.More(); part.Next()) parts.push_back(TopoDS::Face(part.Current()));
}

/// Returns the faces after sewing them together.
std::vector<TopoDS_Face> sewn(const std::vector<TopoDS_Face>& whole_faces, double sew_mm) {
  std::vector<TopoDS_Face> faces;
  for (const TopoDS_Face& face : whole_faces) add_smooth_parts(face, faces);
  if (faces.size() == 1) return faces;
  BRepBuilderAPI_Sewing sewing(sew_mm);
  for (const TopoDS_Face& face : faces) sewing.Add(face);
  sewing.Perform();
  std::vector<TopoDS_Face> joined;
  for (TopExp_Explorer face(sewing.SewedShape(), TopAbs_FACE); face.More(); face.Next())
    joined.push_back(TopoDS::Face(face.Current()));
  return joined;
}

bool is_at_border(const TopoDS_Edge& edge, const TopTools_ListOfShape& faces) {
  return faces.Extent() == 1 && !BRep_Tool::Degenerated(edge) &&
         !BRep_Tool::IsClosed(edge, TopoDS::Face(faces.First()));
}

/// Checks that faces are connected by common edges.
void check_connected(const ChosenFaces& chosen, double sew_mm) {
  TopTools_IndexedMapOfShape numbers;
  for (const TopoDS_Face& face : chosen.faces) numbers.Add(face);
  std::vector<int> parent(chosen.faces.size() + 1);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int k) {
    while (parent[static_cast<std::size_t>(k)] != k) k = parent[static_cast<std::size_t>(k)];
    return k;
  };
  for (int e = 1; e <= chosen.faces_of_edge.Extent(); ++e) {
    const TopTools_ListOfShape& faces = chosen.faces_of_edge(e);
    for (const TopoDS_Shape& face : faces)
      parent[static_cast<std::size_t>(root(numbers.FindIndex(face)))] = root(numbers.FindIndex(faces.First()));
  }
  int pieces = 0;
  for (int k = 1; k <= numbers.Extent(); ++k) pieces += root(k) == k ? 1 : 0;
  if (pieces > 1)
    refuse_step("must be one connected surface, but the " + std::to_string(chosen.faces.size()) +
                " chosen faces form " + std::to_string(pieces) +
                " separate pieces: choose other faces, or increase sew_mm (" + text_of(sew_mm) +
                ") if there are gaps between them");
}

/// Curve of an edge.
struct EdgeCurve {
  BRepAdaptor_Curve curve;
  double first = 0.0;
  double last = 0.0;
  gp_Pnt start;
  gp_Pnt end;

  explicit EdgeCurve(const TopoDS_Edge& edge)
      : curve(edge), first(curve.FirstParameter()), last(curve.LastParameter()) {
    if (!std::isfinite(first) || !std::isfinite(last) || std::abs(first) > 1e9 || std::abs(last) > 1e9)
      refuse_step("must have edges of finite length");
    // Neighbouring edges share vertices. Their curves may end a small distance from them.
    const TopoDS_Vertex from = TopExp::FirstVertex(edge);
    const TopoDS_Vertex to = TopExp::LastVertex(edge);
    start = from.IsNull() ? curve.Value(first) : BRep_Tool::Pnt(from);
    end = to.IsNull() ? curve.Value(last) : BRep_Tool::Pnt(to);
  }
  Vec2 at(double t) const { return t == first ? plan_of(start) : t == last ? plan_of(end) : plan_of(curve.Value(t)); }
};

double distance_to_line(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double length = along.norm();
  if (!(length > 0.0)) return (p - a).norm();
  return std::abs(along.x() * (p.y() - a.y()) - along.y() * (p.x() - a.x())) / length;
}

/// Appends points of a curve after the point at `from`, up to the point at `to`, to a polygon.
void add_points(const EdgeCurve& curve, double from, double to, double tolerance_mm, int depth,
                std::vector<Vec2>& points) {
  const Vec2 a = curve.at(from);
  const Vec2 b = curve.at(to);
  constexpr int kMaxDepth = 11;
  bool is_near = true;
  for (const double fraction : {0.25, 0.5, 0.75})
    is_near = is_near && distance_to_line(curve.at(from + fraction * (to - from)), a, b) <= tolerance_mm;
  if (is_near || depth >= kMaxDepth) {
    points.push_back(b);
    return;
  }
  const double middle = 0.5 * (from + to);
  add_points(curve, from, middle, tolerance_mm, depth + 1, points);
  add_points(curve, middle, to, tolerance_mm, depth + 1, points);
}

/// Returns points on an edge, from its start to its end, which do not depend on its orientation.
std::vector<Vec2> points_of(const TopoDS_Edge& edge, double tolerance_mm) {
  const EdgeCurve curve(edge);
  std::vector<Vec2> points = {curve.at(curve.first)};
  // A curve is divided at least into four parts, because a symmetric curve may cross its chord in the middle.
  const int parts = curve.curve.GetType() == GeomAbs_Line ? 1 : 4;
  for (int k = 0; k < parts; ++k) {
    const auto parameter = [&](int i) {
      return i == parts ? curve.last : curve.first + (curve.last - curve.first) * i / parts;
    };
    add_points(curve, parameter(k), parameter(k + 1), tolerance_mm, 0, points);
  }
  return points;
}

double doubled_area(const std::vector<Vec2>& loop) {
  double sum = 0.0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec2& a = loop[k];
    const Vec2& b = loop[(k + 1) % loop.size()];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

/// Returns the bulge of the arc through three points.
double bulge_through(const Vec2& from, const Vec2& middle, const Vec2& to) {
  const Vec2 chord = to - from;
  const Vec2 offset = middle - 0.5 * (from + to);
  // The bulge is the sagitta divided by half of the chord. It is positive if the arc is on the right of the chord.
  const double sagitta = (chord.y() * offset.x() - chord.x() * offset.y()) / chord.norm();
  return 2.0 * sagitta / chord.norm();
}

double distance_to_arc(const OutlineSide& side, const Vec2& p) {
  if (!side.is_arc()) return distance_to_line(p, side.from_mm, side.to_mm);
  const Vec2 chord = side.to_mm - side.from_mm;
  const double half = 0.5 * chord.norm();
  const double b = side.bulge;
  const Vec2 left(-chord.y(), chord.x());
  const Vec2 centre = 0.5 * (side.from_mm + side.to_mm) + (1.0 - b * b) / (4.0 * b) * left;
  return std::abs((p - centre).norm() - half * (1.0 + b * b) / (2.0 * std::abs(b)));
}

/// Appends lines and arcs that replace a part of a curve.
void add_sides(const EdgeCurve& curve, double from, double to, int depth, OutlineLoop& sides) {
  constexpr int kMaxDepth = 9;
  constexpr double kStraight = 1e-9;
  const Vec2 a = curve.at(from);
  const Vec2 b = curve.at(to);
  const double middle = 0.5 * (from + to);
  if ((b - a).norm() > 0.0) {
    OutlineSide side{a, b, bulge_through(a, curve.at(middle), b)};
    if (std::abs(side.bulge) < kStraight) side.bulge = 0.0;
    bool is_near = std::abs(side.bulge) < 1.0 + 1e-9;
    for (const double fraction : {0.125, 0.25, 0.5, 0.75, 0.875})
      is_near = is_near && distance_to_arc(side, curve.at(from + fraction * (to - from))) <= kArcToleranceMm;
    if (is_near || depth >= kMaxDepth) {
      sides.push_back(side);
      return;
    }
  }
  if (depth >= kMaxDepth) return;
  add_sides(curve, from, middle, depth + 1, sides);
  add_sides(curve, middle, to, depth + 1, sides);
}

OutlineLoop sides_of(const TopoDS_Edge& edge) {
  const EdgeCurve curve(edge);
  OutlineLoop sides;
  if (curve.curve.GetType() == GeomAbs_Line) {
    if ((curve.at(curve.last) - curve.at(curve.first)).norm() > kRoundingMm)
      sides.push_back({curve.at(curve.first), curve.at(curve.last), 0.0});
    return sides;
  }
  const double middle = 0.5 * (curve.first + curve.last);
  const bool is_arc = curve.curve.GetType() == GeomAbs_Circle &&
                      std::abs(std::abs(curve.curve.Circle().Axis().Direction().Z()) - 1.0) < 1e-12;
  if (is_arc) {
    // Both halves are exact arcs.
    for (const auto& [from, to] : {std::pair(curve.first, middle), std::pair(middle, curve.last)})
      sides.push_back(
          {curve.at(from), curve.at(to), bulge_through(curve.at(from), curve.at(0.5 * (from + to)), curve.at(to))});
    return sides;
  }
  add_sides(curve, curve.first, curve.last, 0, sides);
  return sides;
}

OutlineLoop reversed_sides(const OutlineLoop& sides) {
  OutlineLoop result;
  for (auto side = sides.rbegin(); side != sides.rend(); ++side) result.push_back(side->reversed());
  return result;
}

}  // namespace

Eigen::Matrix3d rotation_of(const StepChoice& choice) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    const double degrees = choice.rotation_deg[static_cast<std::size_t>(axis)];
    // Multiples of 90 degrees are exact.
    const double quarter = std::remainder(degrees, 360.0) / 90.0;
    const bool is_exact = quarter == std::round(quarter);
    const double cosine = is_exact ? std::round(std::cos(degrees * kRadPerDegree)) : std::cos(degrees * kRadPerDegree);
    const double sine = is_exact ? std::round(std::sin(degrees * kRadPerDegree)) : std::sin(degrees * kRadPerDegree);
    const int i = (axis + 1) % 3;
    const int j = (axis + 2) % 3;
    Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    one(i, i) = one(j, j) = cosine;
    one(i, j) = -sine;
    one(j, i) = sine;
    rotation = one * rotation;
  }
  return rotation;
}

void check_step_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse_step("must be readable, but it cannot be opened");
  std::ostringstream content;
  content << stream.rdbuf();
  const std::string text = std::move(content).str();
  if (text.substr(0, 1024).find("ISO-10303-21;") == std::string::npos)
    refuse_step("must be a STEP file, which begins with ISO-10303-21");
  constexpr std::size_t kEndBytes = 65536;
  if (text.find("END-ISO-10303-21", text.size() < kEndBytes ? 0 : text.size() - kEndBytes) == std::string::npos)
    refuse_step("is truncated: END-ISO-10303-21 is missing at its end");
  const std::size_t faces = count_of(text, "ADVANCED_FACE") + count_of(text, "FACE_SURFACE");
  if (faces == 0) refuse_step("must contain faces, but has none");
  if (faces > kMaxStepFaces)
    refuse_step("must have at most " + std::to_string(kMaxStepFaces) + " faces, but has " + std::to_string(faces));
}

ChosenFaces choose_faces(const StepChoice& choice) {
  const StepContents contents(choice);
  ChosenFaces chosen;
  chosen.unit = contents.unit();
  chosen.faces = sewn(selected(contents.candidates(), choice.face), choice.sew_mm);
  if (chosen.faces.empty()) refuse_step("must have faces that are larger than sew_mm");
  BRep_Builder builder;
  TopoDS_Compound all;
  builder.MakeCompound(all);
  for (const TopoDS_Face& face : chosen.faces) {
    if (BRep_Tool::Surface(face).IsNull()) refuse_step("must have a surface for each face");
    builder.Add(all, face);
  }
  TopExp::MapShapesAndUniqueAncestors(all, TopAbs_EDGE, TopAbs_FACE, chosen.faces_of_edge);
  if (chosen.faces.size() > 1) {
    check_connected(chosen, choice.sew_mm);
    for (int e = 1; e <= chosen.faces_of_edge.Extent(); ++e)
      if (const double gap = BRep_Tool::Tolerance(TopoDS::Edge(chosen.faces_of_edge.FindKey(e)));
          chosen.faces_of_edge(e).Extent() > 1 && gap > kRoundingMm)
        chosen.gap_mm = std::max(chosen.gap_mm, gap);
  }
  return chosen;
}

std::vector<OutlineLoop> loops_around(const ChosenFaces& chosen, double sew_mm) {
  std::vector<OutlineLoop> pieces;
  for (int e = 1; e <= chosen.faces_of_edge.Extent(); ++e) {
    const TopoDS_Edge edge = TopoDS::Edge(chosen.faces_of_edge.FindKey(e));
    if (!is_at_border(edge, chosen.faces_of_edge(e))) continue;
    if (OutlineLoop sides = sides_of(edge); !sides.empty()) pieces.push_back(std::move(sides));
  }
  const double tolerance_mm = std::max(sew_mm, kRoundingMm);
  std::vector<OutlineLoop> loops;
  while (!pieces.empty()) {
    OutlineLoop loop = std::move(pieces.back());
    pieces.pop_back();
    while ((loop.back().to_mm - loop.front().from_mm).norm() > tolerance_mm) {
      const Vec2 end = loop.back().to_mm;
      const auto distance = [&](const OutlineLoop& piece) {
        return std::min((piece.front().from_mm - end).norm(), (piece.back().to_mm - end).norm());
      };
      const auto next = std::min_element(pieces.begin(), pieces.end(),
                                         [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
      if (next == pieces.end() || distance(*next) > tolerance_mm)
        refuse_step("must have faces with a closed border, but the border has a gap at x = " + text_of(end.x()) +
                    ", y = " + text_of(end.y()) + " mm");
      OutlineLoop piece =
          (next->front().from_mm - end).norm() <= (next->back().to_mm - end).norm() ? *next : reversed_sides(*next);
      pieces.erase(next);
      piece.front().from_mm = end;
      loop.insert(loop.end(), piece.begin(), piece.end());
    }
    loop.back().to_mm = loop.front().from_mm;
    loops.push_back(std::move(loop));
  }
  if (loops.empty()) refuse_step("must have faces with a border");
  return loops;
}

std::vector<FaceBorder> borders_of(const ChosenFaces& chosen, double tolerance_mm) {
  std::vector<std::vector<Vec2>> points(static_cast<std::size_t>(chosen.faces_of_edge.Extent()) + 1);
  std::vector<FaceBorder> borders;
  for (const TopoDS_Face& face : chosen.faces) {
    FaceBorder& border = borders.emplace_back();
    for (TopExp_Explorer wire(face, TopAbs_WIRE); wire.More(); wire.Next()) {
      std::vector<Vec2> loop;
      for (BRepTools_WireExplorer edge(TopoDS::Wire(wire.Current()), face); edge.More(); edge.Next()) {
        if (BRep_Tool::Degenerated(edge.Current())) continue;
        const int number = chosen.faces_of_edge.FindIndex(edge.Current());
        std::vector<Vec2>& own = points[static_cast<std::size_t>(number)];
        if (own.empty())
          own = points_of(TopoDS::Edge(chosen.faces_of_edge.FindKey(number).Oriented(TopAbs_FORWARD)), tolerance_mm);
        if (edge.Current().Orientation() == TopAbs_REVERSED)
          loop.insert(loop.end(), own.rbegin(), own.rend() - 1);
        else
          loop.insert(loop.end(), own.begin(), own.end() - 1);
      }
      if (loop.size() >= 3) border.push_back(std::move(loop));
    }
    const auto outer = std::max_element(border.begin(), border.end(), [](const auto& a, const auto& b) {
      return std::abs(doubled_area(a)) < std::abs(doubled_area(b));
    });
    for (auto loop = border.begin(); loop != border.end(); ++loop)
      if ((doubled_area(*loop) > 0.0) != (loop == outer)) std::reverse(loop->begin(), loop->end());
  }
  return borders;
}

std::vector<TangentBreak> tangent_breaks(const ChosenFaces& chosen, const StepChoice& choice) {
  constexpr int kSteps = 16;
  const Eigen::Matrix3d file_from_rotated = rotation_of(choice).transpose();
  std::vector<TangentBreak> breaks;
  for (int e = 1; e <= chosen.faces_of_edge.Extent(); ++e) {
    const TopTools_ListOfShape& faces = chosen.faces_of_edge(e);
    const TopoDS_Edge edge = TopoDS::Edge(chosen.faces_of_edge.FindKey(e));
    if (faces.Extent() != 2 || BRep_Tool::Degenerated(edge)) continue;
    const std::array<TopoDS_Face, 2> both = {TopoDS::Face(faces.First()), TopoDS::Face(faces.Last())};
    std::array<Handle(Geom2d_Curve), 2> curves;
    std::array<Handle(Geom_Surface), 2> surfaces;
    double first = 0.0;
    double last = 0.0;
    for (std::size_t side = 0; side < 2; ++side) {
      curves[side] = BRep_Tool::CurveOnSurface(edge, both[side], first, last);
      surfaces[side] = BRep_Tool::Surface(both[side]);
    }
    if (curves[0].IsNull() || curves[1].IsNull()) continue;
    TangentBreak largest;
    for (int k = 0; k <= kSteps; ++k) {
      const double t = first + (last - first) * k / kSteps;
      std::array<Vec3, 2> normals;
      for (std::size_t side = 0; side < 2; ++side) {
        const gp_Pnt2d uv = curves[side]->Value(t);
        const gp_Vec normal = normal_at(both[side], surfaces[side], uv.X(), uv.Y());
        normals[side] = Vec3(normal.X(), normal.Y(), normal.Z()).normalized();
        // The material is below all faces, whatever their orientation in the file.
        if (normals[side].z() < 0.0) normals[side] = -normals[side];
      }
      const double angle_deg =
          std::atan2(normals[0].cross(normals[1]).norm(), normals[0].dot(normals[1])) / kRadPerDegree;
      if (!(angle_deg > largest.angle_deg)) continue;
      const gp_Pnt2d uv = curves[0]->Value(t);
      const gp_Pnt p = surfaces[0]->Value(uv.X(), uv.Y());
      largest = {angle_deg, file_from_rotated * Vec3(p.X(), p.Y(), p.Z())};
    }
    if (largest.angle_deg > kSmoothDeg) breaks.push_back(largest);
  }
  std::sort(breaks.begin(), breaks.end(),
            [](const TangentBreak& a, const TangentBreak& b) { return a.angle_deg > b.angle_deg; });
  return breaks;
}

}  // namespace retrace::geometry
