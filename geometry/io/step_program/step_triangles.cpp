#include "geometry/io/step_program/step_triangles.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <array>
#include <cstdint>
#include <gp_Pln.hxx>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "geometry/io/step_program/step_refusal.h"
#include "geometry/io/step_program/step_shapes.h"
#include "geometry/io/stl_file.h"

namespace retrace::geometry {
namespace {

// Maximum angle between the triangles of a curved face and the face, in rad.
constexpr double kMaxAngleRad = 0.2;

Vec3 vector_of(const gp_Pnt& p) {
  return {p.X(), p.Y(), p.Z()};
}

/// Collects the triangles of solids. Triangles of neighbouring faces share their vertices, because both faces use the
/// same points on their common edge.
class TriangleCollector {
 public:
  void add_solid(const TopoDS_Shape& shape) {
    ++solid_.solids;
    vertices_.Clear();
    edges_.Clear();
    vertex_numbers_.clear();
    edge_numbers_.clear();
    for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) add_face(TopoDS::Face(at.Current()));
  }

  const SolidMesh& solid() const { return solid_; }

 private:
  void add_face(const TopoDS_Face& face) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, location);
    if (triangles.IsNull() || triangles->NbTriangles() == 0)
      refuse_step("has a face that cannot be divided into triangles: repair the solid in the CAD program");
    if (solid_.mesh.triangles.size() + static_cast<std::size_t>(triangles->NbTriangles()) > kMaxStlTriangles)
      refuse_step("needs too many triangles: use a larger chord_mm");
    const gp_Trsf& move = location.Transformation();
    std::vector<std::uint32_t> numbers(static_cast<std::size_t>(triangles->NbNodes()), kNone);
    for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next())
      number_edge(TopoDS::Edge(at.Current()), triangles, location, numbers);
    for (int node = 1; node <= triangles->NbNodes(); ++node) {
      std::uint32_t& number = numbers[static_cast<std::size_t>(node - 1)];
      if (number == kNone) number = add_vertex(vector_of(triangles->Node(node).Transformed(move)));
    }
    const bool is_reversed = (face.Orientation() == TopAbs_REVERSED) != move.IsNegative();
    for (int k = 1; k <= triangles->NbTriangles(); ++k) {
      std::array<int, 3> nodes{};
      triangles->Triangle(k).Get(nodes[0], nodes[1], nodes[2]);
      if (is_reversed) std::swap(nodes[1], nodes[2]);
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t c = 0; c < 3; ++c) corners.at(c) = numbers[static_cast<std::size_t>(nodes.at(c) - 1)];
      if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
      solid_.mesh.triangles.push_back(corners);
      solid_.face_of.push_back(static_cast<std::uint32_t>(solid_.planes.size()));
    }
    add_plane(face);
  }

  void add_plane(const TopoDS_Face& face) {
    const BRepAdaptor_Surface surface(face, Standard_False);
    if (surface.GetType() != GeomAbs_Plane) {
      solid_.planes.emplace_back(std::nullopt);
      return;
    }
    const gp_Pln plane = surface.Plane();
    const gp_Dir normal = plane.Axis().Direction();
    const Vec3 n(normal.X(), normal.Y(), normal.Z());
    solid_.planes.emplace_back(FacetPlane{n, n.dot(vector_of(plane.Location()))});
  }

  /// Sets the numbers of the vertices on an edge. Their order is that of the edge's parameter.
  void number_edge(const TopoDS_Edge& edge, const Handle(Poly_Triangulation) & triangles,
                   const TopLoc_Location& location, std::vector<std::uint32_t>& numbers) {
    const Handle(Poly_PolygonOnTriangulation) polygon = BRep_Tool::PolygonOnTriangulation(edge, triangles, location);
    if (polygon.IsNull()) return;
    const auto count = static_cast<std::size_t>(polygon->NbNodes());
    const int key = edges_.Add(edge);
    std::vector<std::uint32_t>& of_edge = edge_numbers_[key];
    if (of_edge.empty()) {
      const TopoDS_Edge forward = TopoDS::Edge(edge.Oriented(TopAbs_FORWARD));
      of_edge.push_back(number_of(TopExp::FirstVertex(forward)));
      for (std::size_t k = 1; k + 1 < count; ++k) {
        const gp_Pnt p = triangles->Node(polygon->Node(static_cast<int>(k) + 1));
        of_edge.push_back(BRep_Tool::Degenerated(edge)
                              ? of_edge.front()
                              : add_vertex(vector_of(p.Transformed(location.Transformation()))));
      }
      of_edge.push_back(number_of(TopExp::LastVertex(forward)));
    }
    if (of_edge.size() != count) refuse_step("has faces that do not share the points of their common edge");
    for (std::size_t k = 0; k < count; ++k)
      numbers[static_cast<std::size_t>(polygon->Node(static_cast<int>(k) + 1) - 1)] = of_edge[k];
  }

  std::uint32_t number_of(const TopoDS_Vertex& vertex) {
    if (vertex.IsNull()) refuse_step("has an edge without vertices");
    const int key = vertices_.Add(vertex);
    const auto known = vertex_numbers_.find(key);
    if (known != vertex_numbers_.end()) return known->second;
    return vertex_numbers_.emplace(key, add_vertex(vector_of(BRep_Tool::Pnt(vertex)))).first->second;
  }

  std::uint32_t add_vertex(const Vec3& p) {
    solid_.mesh.vertices.push_back(p);
    return static_cast<std::uint32_t>(solid_.mesh.vertices.size() - 1);
  }

  static constexpr std::uint32_t kNone = UINT32_MAX;

  SolidMesh solid_;
  TopTools_IndexedMapOfShape vertices_;
  TopTools_IndexedMapOfShape edges_;
  std::unordered_map<int, std::uint32_t> vertex_numbers_;
  std::unordered_map<int, std::vector<std::uint32_t>> edge_numbers_;
};

int count_of(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape all;
  TopExp::MapShapes(shape, kind, all);
  return all.Extent();
}

}  // namespace

SolidMesh solids_of_file(const std::filesystem::path& file, double chord_mm) {
  check_step_text(file);
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  STEPControl_Reader reader;
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone)
    refuse_step("must be a STEP file, but it cannot be understood");
  reader.TransferRoots();
  if (reader.NbShapes() == 0) refuse_step("contains no shape that OpenCASCADE can read");
  const TopoDS_Shape shape = reader.OneShape();
  if (count_of(shape, TopAbs_SOLID) == 0)
    refuse_step("must contain a solid, but contains only surfaces: export the part as a solid");
  BRepMesh_IncrementalMesh(shape, chord_mm, Standard_False, kMaxAngleRad, Standard_False);
  TriangleCollector collector;
  for (TopExp_Explorer at(shape, TopAbs_SOLID); at.More(); at.Next()) collector.add_solid(at.Current());
  return collector.solid();
}

}  // namespace retrace::geometry
