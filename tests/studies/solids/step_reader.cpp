#include "tests/studies/solids/step_reader.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shape.hxx>

namespace retrace::test {
namespace {

// Relative error of volumes and areas.
constexpr double kQuadratureError = 1e-9;

int count(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  int found = 0;
  for (TopExp_Explorer at(shape, kind); at.More(); at.Next()) ++found;
  return found;
}

}  // namespace

StepFindings read_step(const std::string& file) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  StepFindings found;
  STEPControl_Reader reader;
  found.is_read = reader.ReadFile(file.c_str()) == IFSelect_RetDone;
  if (!found.is_read) return found;
  reader.TransferRoots();
  found.roots = reader.NbShapes();
  const TopoDS_Shape shape = reader.OneShape();
  found.solids = count(shape, TopAbs_SOLID);
  found.shells = count(shape, TopAbs_SHELL);
  found.faces = count(shape, TopAbs_FACE);
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next())
    switch (BRepAdaptor_Surface(TopoDS::Face(at.Current())).GetType()) {
      case GeomAbs_Plane: ++found.planes; break;
      case GeomAbs_Cylinder: ++found.cylinders; break;
      case GeomAbs_Sphere: ++found.spheres; break;
      case GeomAbs_BSplineSurface: ++found.splines; break;
      default: break;
    }
  found.is_valid = BRepCheck_Analyzer(shape).IsValid();
  TopTools_IndexedDataMapOfShapeListOfShape faces_of_edge;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces_of_edge);
  for (int k = 1; k <= faces_of_edge.Extent(); ++k) found.free_edges += faces_of_edge(k).Extent() == 2 ? 0 : 1;
  GProp_GProps properties;
  // The adaptive quadrature is slow, and plane faces do not need it.
  const bool is_curved = found.planes != found.faces;
  is_curved ? static_cast<void>(BRepGProp::VolumeProperties(shape, properties, kQuadratureError))
            : BRepGProp::VolumeProperties(shape, properties);
  found.volume_mm3 = properties.Mass();
  is_curved ? static_cast<void>(BRepGProp::SurfaceProperties(shape, properties, kQuadratureError))
            : BRepGProp::SurfaceProperties(shape, properties);
  found.area_mm2 = properties.Mass();
  return found;
}

}  // namespace retrace::test
