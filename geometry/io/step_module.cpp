// Module that writes STEP. It uses OpenCASCADE.
#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRep_Builder.hxx>
#include <Eigen/Geometry>
#include <ElCLib.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_Circle.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Plane.hxx>
#include <Geom_SphericalSurface.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <Precision.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <Standard_Failure.hxx>
#include <StepBasic_Product.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Ax2.hxx>
#include <gp_Ax3.hxx>
#include <gp_Dir.hxx>
#include <gp_Pln.hxx>
#include <gp_Pnt.hxx>
#include <sstream>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/overloaded.h"
#include "core/version.h"
#include "geometry/part/exact_solid.h"

namespace retrace::geometry {
namespace {

gp_Pnt point(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

gp_Dir direction(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

/// Returns a unit vector that is perpendicular to a unit vector.
Vec3 perpendicular_to(const Vec3& v) {
  return (std::abs(v.x()) < 0.5 ? Vec3(v.cross(Vec3::UnitX())) : Vec3(v.cross(Vec3::UnitY()))).normalized();
}

/// Knots of a spline, without repetitions, and their multiplicities.
struct KnotVector {
  TColStd_Array1OfReal values;
  TColStd_Array1OfInteger multiplicities;

  explicit KnotVector(const SplineAxis& axis) : values(1, count_of(axis)), multiplicities(1, count_of(axis)) {
    multiplicities.Init(1);
    multiplicities(1) = multiplicities(multiplicities.Upper()) = kDegree + 1;
    for (int k = 1; k <= values.Upper(); ++k) values(k) = axis.knots()[static_cast<std::size_t>(k - 1 + kDegree)];
  }

  static constexpr int kDegree = 3;
  static int count_of(const SplineAxis& axis) { return static_cast<int>(axis.knots().size()) - 2 * kDegree; }
};

Handle(Geom_Surface) geometry_of(const SplinePatch& patch) {
  TColgp_Array2OfPnt poles(1, static_cast<int>(patch.x.count()), 1, static_cast<int>(patch.y.count()));
  for (std::size_t j = 0; j < patch.y.count(); ++j)
    for (std::size_t i = 0; i < patch.x.count(); ++i)
      poles(static_cast<int>(i) + 1, static_cast<int>(j) + 1) =
          gp_Pnt(patch.x.greville(i), patch.y.greville(j), patch.heights_mm[j * patch.x.count() + i]);
  const KnotVector along_x(patch.x);
  const KnotVector along_y(patch.y);
  return new Geom_BSplineSurface(poles, along_x.values, along_y.values, along_x.multiplicities, along_y.multiplicities,
                                 KnotVector::kDegree, KnotVector::kDegree);
}

/// Returns the surface of the entrance face. The seam of a cylinder or a sphere is opposite to the middle of the face,
/// and the poles of a sphere are 90 degrees away from it.
Handle(Geom_Surface) surface_of(const FaceSurface& surface) {
  return std::visit(Overloaded{[](const ExactPlane& plane) -> Handle(Geom_Surface) {
                                 return new Geom_Plane(gp_Pln(point(plane.origin_mm), direction(plane.normal)));
                               },
                               [](const ExactCylinder& cylinder) -> Handle(Geom_Surface) {
                                 const gp_Ax3 axes(point(cylinder.origin_mm), direction(cylinder.axis),
                                                   direction(-cylinder.towards));
                                 return new Geom_CylindricalSurface(axes, cylinder.radius_mm);
                               },
                               [](const ExactSphere& sphere) -> Handle(Geom_Surface) {
                                 const gp_Ax3 axes(point(sphere.centre_mm), direction(perpendicular_to(sphere.towards)),
                                                   direction(-sphere.towards));
                                 return new Geom_SphericalSurface(axes, sphere.radius_mm);
                               },
                               [](const SplinePatch& patch) -> Handle(Geom_Surface) { return geometry_of(patch); }},
                    surface);
}

/// Returns true if the normal of the surface in OpenCASCADE points into the solid.
bool is_reversed(const FaceSurface& surface) {
  return std::visit(
      Overloaded{[](const ExactPlane&) { return false; },
                 [](const ExactCylinder& cylinder) { return !cylinder.is_convex; },
                 [](const ExactSphere& sphere) { return !sphere.is_convex; }, [](const SplinePatch&) { return false; }},
      surface);
}

/// Part of a curve between two parameters.
struct CurveSection {
  Handle(Geom_Curve) curve;
  double first = 0.0;
  double last = 1.0;
};

/// Returns the section of a circle with the given plane and centre.
CurveSection circle_section(const Vec3& centre_mm, const Vec3& normal, double radius_mm, const Vec3& from,
                            const Vec3& to) {
  for (const double sign : {1.0, -1.0}) {
    const gp_Circ circle(gp_Ax2(point(centre_mm), direction(sign * normal)), radius_mm);
    const double first = ElCLib::Parameter(circle, point(from));
    double last = ElCLib::Parameter(circle, point(to));
    if (last < first) last += 2.0 * M_PI;
    if (last - first < M_PI) return {new Geom_Circle(circle), first, last};
  }
  throw std::runtime_error("an edge of the entrance face is longer than half a circle");
}

/// Returns the section of the ellipse in which a plane cuts a cylinder, or nothing if the plane is parallel to the
/// axis.
CurveSection ellipse_section(const ExactCylinder& cylinder, const Vec3& normal, const Vec3& from, const Vec3& to) {
  // Sine of the angle between plane and axis below which the section is a straight line.
  constexpr double kParallel = 1e-9;
  const double sine = cylinder.axis.dot(normal);
  if (std::abs(sine) < kParallel) return {};
  const Vec3 centre = cylinder.origin_mm + (from - cylinder.origin_mm).dot(normal) / sine * cylinder.axis;
  const Vec3 along = cylinder.axis - sine * normal;
  if (along.norm() < kParallel) return circle_section(centre, normal, cylinder.radius_mm, from, to);
  for (const double sign : {1.0, -1.0}) {
    const gp_Elips ellipse(gp_Ax2(point(centre), direction(sign * normal), direction(along)),
                           cylinder.radius_mm / std::abs(sine), cylinder.radius_mm);
    const double first = ElCLib::Parameter(ellipse, point(from));
    double last = ElCLib::Parameter(ellipse, point(to));
    if (last < first) last += 2.0 * M_PI;
    if (last - first < M_PI) return {new Geom_Ellipse(ellipse), first, last};
  }
  throw std::runtime_error("an edge of the entrance face is longer than half an ellipse");
}

/// Returns the line in which the vertical plane through two points of a surface cuts this surface. The curve is null if
/// the line is straight. It is also null for a bicubic patch, whose edges are given.
CurveSection section_between(const FaceSurface& surface, const Vec3& from, const Vec3& to) {
  const Vec3 normal = Vec3(from.y() - to.y(), to.x() - from.x(), 0.0).normalized();
  return std::visit(
      Overloaded{[](const ExactPlane&) { return CurveSection{}; },
                 [&](const ExactCylinder& cylinder) { return ellipse_section(cylinder, normal, from, to); },
                 [&](const ExactSphere& sphere) {
                   const double distance = (from - sphere.centre_mm).dot(normal);
                   const Vec3 centre = sphere.centre_mm + distance * normal;
                   return circle_section(centre, normal, (from - centre).norm(), from, to);
                 },
                 [](const SplinePatch&) { return CurveSection{}; }},
      surface);
}

CurveSection section_of(const PatchEdge& edge, const Vec3& from, const Vec3& to) {
  const KnotVector knots(edge.axis);
  TColgp_Array1OfPnt poles(1, static_cast<int>(edge.axis.count()));
  for (std::size_t k = 0; k < edge.axis.count(); ++k) {
    const double share = edge.axis.greville(k);
    poles(static_cast<int>(k) + 1) =
        gp_Pnt(std::lerp(from.x(), to.x(), share), std::lerp(from.y(), to.y(), share), edge.heights_mm[k]);
  }
  return {new Geom_BSplineCurve(poles, knots.values, knots.multiplicities, KnotVector::kDegree)};
}

/// Builds a solid from faces that share vertices and edges by construction. Methods that find the connections
/// afterwards, such as sewing or fusing, might miss some of them and are not needed.
class SolidBuilder {
 public:
  explicit SolidBuilder(const ExactSolid& source) : source_(source.faces), entrance_(source.entrance) {
    vertices_.resize(source_.vertices.size());
    for (std::size_t v = 0; v < vertices_.size(); ++v)
      builder_.MakeVertex(vertices_[v], point(source_.vertices[v]), Precision::Confusion());
  }

  TopoDS_Solid build() {
    TopoDS_Shell shell;
    builder_.MakeShell(shell);
    if (entrance_) add_entrance(shell);
    for (const SolidFace& face : source_.faces)
      if (!is_curved(face)) builder_.Add(shell, made(face));
    shell.Closed(Standard_True);
    TopoDS_Solid solid;
    builder_.MakeSolid(solid);
    builder_.Add(solid, shell);
    return solid;
  }

 private:
  bool is_curved(const SolidFace& face) const { return entrance_ && face.role == FacetRole::entrance; }

  /// Adds the faces on the curved surface. Their edges are made first, so that the sides share them.
  void add_entrance(TopoDS_Shell& shell) {
    for (const PatchEdge& edge : entrance_->edges)
      add_edge(edge.from, edge.to, section_of(edge, source_.vertices[edge.from], source_.vertices[edge.to]));
    const Handle(Geom_Surface) surface = surface_of(entrance_->surface);
    const bool reversed = is_reversed(entrance_->surface);
    for (const SolidFace& face : source_.faces) {
      if (!is_curved(face)) continue;
      TopoDS_Face result;
      builder_.MakeFace(result, surface, Precision::Confusion());
      for (std::vector<std::uint32_t> loop : face.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const auto [low, high] = std::minmax(loop[i], loop[(i + 1) % loop.size()]);
          if (!edges_.contains(key_of(low, high)))
            add_edge(low, high, section_between(entrance_->surface, source_.vertices[low], source_.vertices[high]));
        }
        if (reversed) std::reverse(loop.begin(), loop.end());
        builder_.Add(result, wire(loop));
      }
      builder_.Add(shell, reversed ? result.Reversed() : result);
    }
  }

  TopoDS_Face made(const SolidFace& face) {
    const Vec3& n = face.normal;
    const gp_Pln plane(point(source_.vertices[face.loops.front().front()]), gp_Dir(n.x(), n.y(), n.z()));
    TopoDS_Face result;
    builder_.MakeFace(result, new Geom_Plane(plane), Precision::Confusion());
    for (const auto& loop : face.loops) builder_.Add(result, wire(loop));
    return result;
  }

  TopoDS_Wire wire(const std::vector<std::uint32_t>& loop) {
    TopoDS_Wire result;
    builder_.MakeWire(result);
    for (std::size_t i = 0; i < loop.size(); ++i) builder_.Add(result, edge(loop[i], loop[(i + 1) % loop.size()]));
    result.Closed(Standard_True);
    return result;
  }

  static std::uint64_t key_of(std::uint32_t low, std::uint32_t high) {
    return (static_cast<std::uint64_t>(low) << 32) | high;
  }

  /// \pre from < to
  void add_edge(std::uint32_t from, std::uint32_t to, const CurveSection& section) {
    TopoDS_Edge& made = edges_[key_of(from, to)];
    BRepBuilderAPI_MakeEdge maker =
        section.curve.IsNull()
            ? BRepBuilderAPI_MakeEdge(vertices_[from], vertices_[to])
            : BRepBuilderAPI_MakeEdge(section.curve, vertices_[from], vertices_[to], section.first, section.last);
    if (!maker.IsDone()) throw std::runtime_error("OpenCASCADE could not make an edge of the solid");
    made = maker.Edge();
  }

  TopoDS_Shape edge(std::uint32_t from, std::uint32_t to) {
    const auto [low, high] = std::minmax(from, to);
    if (!edges_.contains(key_of(low, high))) add_edge(low, high, {});
    return edges_[key_of(low, high)].Oriented(from == low ? TopAbs_FORWARD : TopAbs_REVERSED);
  }

  const FacetedSolid& source_;
  const std::optional<CurvedFace>& entrance_;
  BRep_Builder builder_;
  std::vector<TopoDS_Vertex> vertices_;
  std::unordered_map<std::uint64_t, TopoDS_Edge> edges_;
};

Handle(TCollection_HAsciiString) text_of(const std::string& text) {
  return new TCollection_HAsciiString(text.c_str());
}

/// Sets the names of products. By default, OpenCASCADE numbers the products of a process.
void name_product(const Handle(StepData_StepModel) & model, const std::string& name) {
  for (int k = 1; k <= model->NbEntities(); ++k) {
    const Handle(StepBasic_Product) product = Handle(StepBasic_Product)::DownCast(model->Value(k));
    if (product.IsNull()) continue;
    product->SetId(text_of(name));
    product->SetName(text_of(name));
  }
}

/// Sets the header of the file, without an author and with a fixed time stamp. Equal solids then give equal files.
void set_header(const Handle(StepData_StepModel) & model, const std::string& name) {
  APIHeaderSection_MakeHeader header(model);
  header.SetName(text_of(name));
  header.SetTimeStamp(text_of("1970-01-01T00:00:00"));
  header.SetAuthorValue(1, text_of(""));
  header.SetOrganizationValue(1, text_of(""));
  header.SetOriginatingSystem(text_of(std::string("retrace ") + kVersion));
  header.SetPreprocessorVersion(text_of("Open CASCADE Technology"));
  header.Apply(model);
}

std::string written(const TopoDS_Solid& solid, const std::string& name) {
  // OpenCASCADE must not write to the program's standard output.
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  STEPControl_Controller::Init();
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  Interface_Static::SetCVal("write.step.unit", "MM");
  // lines in planes need no additional curves in parameter space
  Interface_Static::SetIVal("write.surfacecurve.mode", 0);
  STEPControl_Writer writer;
  if (writer.Transfer(solid, STEPControl_ManifoldSolidBrep) != IFSelect_RetDone)
    throw std::runtime_error("OpenCASCADE could not convert the solid to STEP");
  const Handle(StepData_StepModel) model = writer.Model();
  name_product(model, name);
  set_header(model, name);
  StepData_StepWriter text(model);
  text.FloatWriter().SetFormat("%.16E");
  text.SendModel(Handle(StepData_Protocol)::DownCast(writer.WS()->Protocol()));
  std::ostringstream stream;
  if (!text.Print(stream)) throw std::runtime_error("OpenCASCADE could not write the STEP file");
  return std::move(stream).str();
}

}  // namespace
}  // namespace retrace::geometry

extern "C" __attribute__((visibility("default"))) void retrace_write_step(const retrace::geometry::ExactSolid& solid,
                                                                          const std::string& name, std::string& text) {
  try {
    text = retrace::geometry::written(retrace::geometry::SolidBuilder(solid).build(), name);
  } catch (const Standard_Failure& failure) {
    throw std::runtime_error(std::string("OpenCASCADE: ") + failure.GetMessageString());
  }
}
