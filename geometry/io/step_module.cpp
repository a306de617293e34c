// Module that writes STEP. It is the only file that uses OpenCASCADE.
#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRep_Builder.hxx>
#include <Geom_Plane.hxx>
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
#include <gp_Dir.hxx>
#include <gp_Pln.hxx>
#include <gp_Pnt.hxx>
#include <sstream>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/version.h"
#include "geometry/part/faceted_solid.h"

namespace retrace::geometry {
namespace {

gp_Pnt point(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

/// Builds a solid from faces that share vertices and edges by construction. Methods that find the connections
/// afterwards, such as sewing or fusing, might miss some of them and are not needed.
class SolidBuilder {
 public:
  explicit SolidBuilder(const FacetedSolid& source) : source_(source) {
    vertices_.resize(source.vertices.size());
    for (std::size_t v = 0; v < vertices_.size(); ++v)
      builder_.MakeVertex(vertices_[v], point(source.vertices[v]), Precision::Confusion());
  }

  TopoDS_Solid build() {
    TopoDS_Shell shell;
    builder_.MakeShell(shell);
    for (const SolidFace& face : source_.faces) builder_.Add(shell, made(face));
    shell.Closed(Standard_True);
    TopoDS_Solid solid;
    builder_.MakeSolid(solid);
    builder_.Add(solid, shell);
    return solid;
  }

 private:
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

  TopoDS_Shape edge(std::uint32_t from, std::uint32_t to) {
    const auto [low, high] = std::minmax(from, to);
    TopoDS_Edge& made = edges_[(static_cast<std::uint64_t>(low) << 32) | high];
    if (made.IsNull()) made = BRepBuilderAPI_MakeEdge(vertices_[low], vertices_[high]).Edge();
    return made.Oriented(from == low ? TopAbs_FORWARD : TopAbs_REVERSED);
  }

  const FacetedSolid& source_;
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

extern "C" __attribute__((visibility("default"))) void retrace_write_step(const retrace::geometry::FacetedSolid& solid,
                                                                          const std::string& name, std::string& text) {
  try {
    text = retrace::geometry::written(retrace::geometry::SolidBuilder(solid).build(), name);
  } catch (const Standard_Failure& failure) {
    throw std::runtime_error(std::string("OpenCASCADE: ") + failure.GetMessageString());
  }
}
