#include "tests/studies/solids/step_writer.h"

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Ax2.hxx>
#include <stdexcept>

namespace retrace::test {
namespace {

void write_shape(const std::string& file, const TopoDS_Shape& shape, const std::string& unit = "MM") {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  STEPControl_Controller::Init();
  Interface_Static::SetCVal("write.step.unit", unit.c_str());
  STEPControl_Writer writer;
  if (writer.Transfer(shape, STEPControl_AsIs) != IFSelect_RetDone || writer.Write(file.c_str()) != IFSelect_RetDone)
    throw std::runtime_error("the test cannot write " + file);
}

gp_Pnt corner(const std::array<double, 3>& p) {
  return {p[0], p[1], p[2]};
}

}  // namespace

void write_boxes(const std::string& file, const std::vector<Box>& boxes, const std::string& unit) {
  BRep_Builder builder;
  TopoDS_Compound all;
  builder.MakeCompound(all);
  for (const Box& box : boxes) builder.Add(all, BRepPrimAPI_MakeBox(corner(box.lower), corner(box.upper)).Solid());
  write_shape(file, all, unit);
}

void write_plate_with_half_cylinder(const std::string& file, double side_mm, double thickness_mm, double radius_mm) {
  const TopoDS_Shape plate = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), gp_Pnt(side_mm, side_mm, thickness_mm)).Solid();
  const gp_Ax2 axis(gp_Pnt(0.5 * side_mm, 0, 0), gp_Dir(0, 1, 0));
  const TopoDS_Shape cylinder = BRepPrimAPI_MakeCylinder(axis, radius_mm, side_mm).Solid();
  const TopoDS_Shape below = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, -side_mm), gp_Pnt(side_mm, side_mm, 0)).Solid();
  write_shape(file, BRepAlgoAPI_Fuse(plate, BRepAlgoAPI_Common(cylinder, below).Shape()).Shape());
}

void write_shell(const std::string& file) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), gp_Pnt(1, 1, 1)).Solid();
  write_shape(file, TopExp_Explorer(box, TopAbs_SHELL).Current());
}

}  // namespace retrace::test
