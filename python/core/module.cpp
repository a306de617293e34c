// Module retrace._core: binds the library (docs/library.md) for the package retrace. The package checks arguments and
// converts results. The functions here only pass requests to the library and return its results.

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <chrono>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "python/core/arrays.h"
#include "python/core/watched.h"
#include "retrace/design.h"
#include "retrace/drawing.h"
#include "retrace/image.h"
#include "retrace/inspect.h"
#include "retrace/job.h"
#include "retrace/metrology.h"
#include "retrace/part.h"
#include "retrace/photometry.h"
#include "retrace/ranging.h"
#include "retrace/rays.h"
#include "retrace/report.h"
#include "retrace/request.h"
#include "retrace/rre.h"
#include "retrace/running.h"
#include "retrace/study.h"
#include "retrace/verify.h"

namespace retrace::python {
namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Raises an exception of the Python package.
/// \param name name of the exception's class
void raise(const char* name, const py::args& arguments) {
  const py::object type = py::module_::import("retrace._errors").attr(name);
  PyErr_SetObject(type.ptr(), type(*arguments).ptr());
}

void translate(std::exception_ptr error) {
  try {
    if (error) std::rethrow_exception(error);
  } catch (const InputError& input) {
    const InputLocation& where = input.where();
    const bool is_in_field = !input.field().name.empty();
    raise("InputError", py::make_tuple(input.text(python_keyword), where.file, where.line,
                                       is_in_field ? python_keyword(input.field().name) : where.key));
  } catch (const OutputError& output) {
    raise("OutputError", py::make_tuple(output.what()));
  } catch (const BudgetError& budget) {
    raise("BudgetError", py::make_tuple(budget.message(python_keyword)));
  } catch (const Error& other) {
    raise("Error", py::make_tuple(other.what()));
  } catch (const Forked& forked) {
    raise("Error", py::make_tuple(forked.what()));
  }
}

/// Converts a Python value (None, bool, int, float, str or list) to the value of a request field.
FieldValue field_value(const py::object& value) {
  if (value.is_none()) return std::monostate();
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::float_>(value) || py::isinstance<py::int_>(value)) return value.cast<double>();
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  const auto list = value.cast<py::list>();
  if (!list.empty() && py::isinstance<py::str>(list[0])) return value.cast<std::vector<std::string>>();
  if (!list.empty() && py::isinstance<py::list>(list[0])) return value.cast<std::vector<std::vector<double>>>();
  return value.cast<std::vector<double>>();
}

/// Binds a type of request. The Python package sets the fields of a request by name with the method `assign`.
template <class Request>
py::class_<Request> request_class(py::module_& module, const char* name) {
  return py::class_<Request>(module, name)
      .def(py::init<>())
      .def("copy", [](const Request& request) { return request; })
      .def("assign", [](Request& request, const std::string& field, const py::object& value) {
        assign(request, field, field_value(value));
      });
}

/// Binds the members that most result classes have in common.
template <class Result>
py::class_<Result> result_class(py::module_& module, const char* name) {
  return py::class_<Result>(module, name)
      .def_property_readonly("warnings", [](const Result& result) { return texts_of(result.warnings); })
      .def_readonly("json", &Result::json)
      .def_readonly("table", &Result::table);
}

void bind_design(py::module_& module) {
  using Released = py::call_guard<py::gil_scoped_release>;
  py::class_<Design>(module, "Design")
      .def_static("load", &Design::load, Released())
      .def_static("parse", &Design::parse, Released())
      .def("replaced", &Design::with, Released())
      .def_property_readonly("title", &Design::title)
      .def_property_readonly("source", &Design::source)
      .def_property_readonly("text", &Design::text)
      .def_property_readonly("overrides", &Design::overrides)
      .def_property_readonly("files", &Design::files)
      .def_property_readonly("warnings", [](const Design& design) { return texts_of(design.warnings()); })
      .def("json", &Design::json);
  py::class_<Drawing>(module, "Drawing")
      .def("__bool__", [](const Drawing& drawing) { return static_cast<bool>(drawing); })
      .def("svg", &Drawing::svg, Released())
      .def("png", [](const Drawing& drawing) {
        std::string file;
        {
          const py::gil_scoped_release others_run;
          file = drawing.png();
        }
        return py::bytes(file);
      });
}

void bind_rre(py::module_& module) {
  request_class<RreRequest>(module, "RreRequest");
  result_class<RreResult>(module, "RreResult")
      .def_readonly("complete", &RreResult::complete)
      .def_readonly("csv", &RreResult::csv)
      .def_readonly("footprint", &RreResult::footprint)
      .def_readonly("far_field", &RreResult::far_field)
      .def_readonly("curve", &RreResult::curve)
      .def_readonly("map", &RreResult::map)
      .def_readonly("map_difference", &RreResult::map_difference)
      .def_readonly("footprint_map", &RreResult::footprint_map);
  module.def("rre", [](const std::vector<Design>& designs, const RreRequest& request, const py::object& progress,
                       unsigned threads) {
    return watched(progress, threads,
                   [designs, request](const Running& running) { return rre(designs, request, running); });
  });
  module.def(
      "seconds_of_rre",
      [](const std::vector<Design>& designs, const RreRequest& request) {
        const auto start = std::chrono::steady_clock::now();
        rre(designs, request);
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      },
      "Time in seconds that the library takes, without the overhead of Python.");
}

void bind_photometry(py::module_& module) {
  request_class<PhotometryRequest>(module, "PhotometryRequest");
  result_class<PhotometryResult>(module, "PhotometryResult")
      .def_readonly("complete", &PhotometryResult::complete)
      .def_readonly("passes", &PhotometryResult::passes)
      .def_readonly("csv", &PhotometryResult::csv)
      .def_readonly("far_field", &PhotometryResult::far_field)
      .def_readonly("observation", &PhotometryResult::observation)
      .def_readonly("map", &PhotometryResult::map)
      .def_readonly("map_ratio", &PhotometryResult::map_ratio);
  module.def("photometry", [](const Design& design, const std::optional<Design>& compared,
                              const PhotometryRequest& request, const py::object& progress, unsigned threads) {
    return watched(progress, threads, [design, compared, request](const Running& running) {
      return compared ? photometry(design, *compared, request, running) : photometry(design, request, running);
    });
  });
}

void bind_ranging(py::module_& module) {
  request_class<RangingRequest>(module, "RangingRequest");
  result_class<RangingResult>(module, "RangingResult")
      .def_readonly("complete", &RangingResult::complete)
      .def_readonly("csv", &RangingResult::csv)
      .def_readonly("map_csv", &RangingResult::map_csv)
      .def_readonly("cubes_csv", &RangingResult::cubes_csv)
      .def_readonly("response_csv", &RangingResult::response_csv)
      .def_readonly("shots_csv", &RangingResult::shots_csv)
      .def_readonly("map", &RangingResult::map)
      .def_readonly("rings", &RangingResult::rings)
      .def_readonly("response", &RangingResult::response);
  module.def("ranging",
             [](const Design& design, const RangingRequest& request, const py::object& progress, unsigned threads) {
               return watched(progress, threads,
                              [design, request](const Running& running) { return ranging(design, request, running); });
             });
}

void bind_part(py::module_& module) {
  result_class<Inspection>(module, "Inspection")
      .def_readonly("plan", &Inspection::plan)
      .def_readonly("section", &Inspection::section)
      .def_readonly("entrance_surface", &Inspection::entrance_surface)
      .def_readonly("shells", &Inspection::shells)
      .def_readonly("pin_axes", &Inspection::pin_axes)
      .def_readonly("view", &Inspection::view);
  request_class<InspectRequest>(module, "InspectRequest");
  module.def("inspect", [](const Design& design, const InspectRequest& request) {
    return watched(py::none(), 0, [design, request](const Running&) { return inspect(design, request); });
  });
  result_class<ExportResult>(module, "ExportResult");
  request_class<SolidRequest>(module, "SolidRequest");
  module.def("export_solid", [](const Design& design, const std::filesystem::path& file, const SolidRequest& request) {
    return watched(py::none(), 0,
                   [design, file, request](const Running&) { return export_solid(design, file, request); });
  });
  request_class<MaterialRequest>(module, "MaterialRequest");
  result_class<MaterialResult>(module, "MaterialResult").def_readonly("complete", &MaterialResult::complete);
  module.def("export_material", [](const Design& design, const std::filesystem::path& file,
                                   const MaterialRequest& request, const py::object& progress, unsigned threads) {
    return watched(progress, threads, [design, file, request](const Running& running) {
      return export_material(design, file, request, running);
    });
  });
  module.def("mesh", [](const Design& design, const SolidRequest& request) {
    Mesh made = watched(py::none(), 0, [design, request](const Running&) { return mesh(design, request); });
    static_assert(sizeof(FaceKind) == sizeof(std::int32_t));
    const auto vertices = static_cast<py::ssize_t>(made.vertices_mm.size());
    const auto triangles = static_cast<py::ssize_t>(made.triangles.size());
    py::dict result;
    result["vertices_mm"] = array_of<double>(std::move(made.vertices_mm), {vertices, 3});
    result["triangles"] = array_of<std::uint32_t>(std::move(made.triangles), {triangles, 3});
    result["kinds"] = array_of<std::int32_t>(std::move(made.kinds), {triangles});
    result["volume_mm3"] = made.volume_mm3;
    result["area_mm2"] = made.area_mm2;
    result["is_manifold"] = made.is_manifold;
    result["warnings"] = texts_of(made.warnings);
    return result;
  });
}

void bind_making(py::module_& module) {
  request_class<JobRequest>(module, "JobRequest");
  result_class<Job>(module, "Job")
      .def_readonly("text", &Job::text)
      .def_readonly("elements", &Job::elements)
      .def_readonly("partial_elements", &Job::partial_elements);
  module.def("make_job", [](const Design& design, const JobRequest& request) {
    return watched(py::none(), 0, [design, request](const Running&) { return make_job(design, request); });
  });
  request_class<FabricationRequest>(module, "FabricationRequest")
      .def_readwrite("job_text", &FabricationRequest::job_text);
  result_class<Fabrication>(module, "Fabrication")
      .def_property_readonly("programs",
                             [](const Fabrication& made) {
                               py::dict programs;
                               for (const NcText& program : made.programs)
                                 programs[py::str(program.file)] = program.text;
                               return programs;
                             })
      .def_readonly("roughing", &Fabrication::roughing)
      .def_readonly("finishing", &Fabrication::finishing)
      .def_readonly("arrangement", &Fabrication::arrangement);
  module.def("fabricate", [](const std::filesystem::path& job, const FabricationRequest& request) {
    return watched(py::none(), 0, [job, request](const Running&) { return fabricate(job, request); });
  });
  request_class<VerificationRequest>(module, "VerificationRequest")
      .def_readwrite("job", &VerificationRequest::job)
      .def_readwrite("programs", &VerificationRequest::programs)
      .def_readwrite("dialect", &VerificationRequest::dialect)
      .def_readwrite("tolerance_nm", &VerificationRequest::tolerance_nm)
      .def_readwrite("next_stage", &VerificationRequest::next_stage)
      .def_readwrite("texts", &VerificationRequest::texts);
  result_class<Verification>(module, "Verification")
      .def_readonly("passes", &Verification::passes)
      .def_readonly("verdict", &Verification::verdict)
      .def_readonly("map", &Verification::map);
  module.def("write_as_machined", [](const Verification& verification, const std::filesystem::path& design) {
    return watched(py::none(), 0, [verification, design](const Running&) {
      write_as_machined(verification, design);
      return true;
    });
  });
  module.def("verify", [](const VerificationRequest& request, const py::object& progress, unsigned threads) {
    return watched(progress, threads, [request](const Running& running) { return verify(request, running); });
  });
}

/// Type of the functions sweep, tolerance and optimize.
using StudyFunction = StudyResult (*)(const Study&, const StudyRequest&, const Running&);

void bind_studies(py::module_& module) {
  py::class_<Study>(module, "Study")
      .def(py::init<std::string, std::string, std::map<std::string, std::string>>())
      .def_static("load", &Study::load)
      .def_readonly("text", &Study::text)
      .def_readonly("source", &Study::source)
      .def_readonly("designs", &Study::designs);
  request_class<StudyRequest>(module, "StudyRequest")
      .def_readwrite("overrides", &StudyRequest::overrides)
      .def_readwrite("seed", &StudyRequest::seed)
      .def_readwrite("store", &StudyRequest::store)
      .def_readwrite("if_exists", &StudyRequest::if_exists);
  result_class<StudyResult>(module, "StudyResult")
      .def_readonly("complete", &StudyResult::complete)
      .def_readonly("is_yes", &StudyResult::is_yes)
      .def_readonly("csv", &StudyResult::csv)
      .def_readonly("drawing", &StudyResult::drawing);
  for (const auto& [name, function] :
       {std::pair<const char*, StudyFunction>{"sweep", sweep}, {"tolerance", tolerance}, {"optimize", optimize}})
    module.def(name, [function = function](const Study& study, const StudyRequest& request, const py::object& progress,
                                           unsigned threads) {
      return watched(progress, threads,
                     [function, study, request](const Running& running) { return function(study, request, running); });
    });
}

/// Returns the channels of a picture by name. Each channel is an array of the shape (rows, columns).
py::dict channels_of(Picture& picture) {
  py::dict channels;
  for (auto& [name, values] : picture.channels)
    channels[py::str(name)] = array_of<double>(
        std::move(values), {static_cast<py::ssize_t>(picture.rows), static_cast<py::ssize_t>(picture.columns)});
  return channels;
}

/// Returns a result and a dict of its pictures. Each picture consists of its channels and its drawing.
py::tuple told(ImageResult result) {
  py::dict pictures;
  for (Picture& picture : result.pictures)
    pictures[py::str(picture.name)] = py::make_tuple(channels_of(picture), picture.drawing);
  result.pictures.clear();
  return py::make_tuple(std::move(result), pictures);
}

void bind_images(py::module_& module) {
  request_class<DetectorRequest>(module, "DetectorRequest");
  request_class<CameraRequest>(module, "CameraRequest");
  request_class<RoadRequest>(module, "RoadRequest");
  result_class<ImageResult>(module, "ImageResult")
      .def_readonly("complete", &ImageResult::complete)
      .def_readonly("sheet", &ImageResult::sheet);
  const auto bind = [&]<class Request>(const char* name,
                                       ImageResult (*function)(const Design&, const Request&, const Running&)) {
    module.def(name,
               [function](const Design& design, const Request& request, const py::object& progress, unsigned threads) {
                 return told(watched(progress, threads, [function, design, request](const Running& running) {
                   return function(design, request, running);
                 }));
               });
  };
  bind("detector", detector);
  bind("camera", camera);
  bind("road", road);
  module.def("camera_series", [](const std::vector<Design>& designs, const std::vector<CameraRequest>& requests,
                                 const py::object& progress, unsigned threads) {
    return told(watched(progress, threads, [designs, requests](const Running& running) {
      return camera_series(designs, requests, running);
    }));
  });
}

std::vector<double> numbers_of(const Numbers& array) {
  return {array.data(), array.data() + array.size()};
}

/// Returns a result and its arrays.
py::tuple told(TracedRays traced) {
  const auto count = static_cast<py::ssize_t>(traced.accounts.size());
  py::dict arrays;
  arrays["origins"] = array_of<double>(std::move(traced.origins_mm), {count, 3});
  arrays["directions"] = array_of<double>(std::move(traced.directions), {count, 3});
  arrays["stokes"] = array_of<double>(std::move(traced.stokes), {count, 4});
  arrays["axes"] = array_of<double>(std::move(traced.axes), {count, 3});
  arrays["wavelength_nm"] = array_of<double>(std::move(traced.wavelengths_nm), {count});
  arrays["account"] = array_of<std::uint8_t>(std::move(traced.accounts), {count});
  arrays["incident"] = array_of<std::uint64_t>(std::move(traced.incident), {count});
  return py::make_tuple(std::move(traced), arrays);
}

void bind_rays(py::module_& module) {
  request_class<RaysRequest>(module, "RaysRequest");
  result_class<RaysResult>(module, "RaysResult");
  module.def("rays",
             [](const Design& design, const RaysRequest& request, const py::object& progress, unsigned threads) {
               return watched(progress, threads,
                              [design, request](const Running& running) { return rays(design, request, running); });
             });
  request_class<TraceRequest>(module, "TraceRequest");
  result_class<TracedRays>(module, "TracedRays");
  module.def("ray_accounts", &ray_accounts);
  module.def("trace", [](const Design& design, const Numbers& origins, const Numbers& directions, const Numbers& stokes,
                         const Numbers& axes, const Numbers& wavelengths, const TraceRequest& request,
                         const py::object& progress, unsigned threads) {
    RayArrays arrays{numbers_of(origins), numbers_of(directions), numbers_of(stokes), numbers_of(axes),
                     numbers_of(wavelengths)};
    return told(watched(progress, threads, [design, arrays = std::move(arrays), request](const Running& running) {
      return trace(design, arrays, request, running);
    }));
  });
}

py::array_t<double> heights_of(HeightMap& map) {
  return array_of<double>(std::move(map.heights_nm),
                          {static_cast<py::ssize_t>(map.rows), static_cast<py::ssize_t>(map.columns)});
}

/// Returns a result and its maps.
py::tuple told(Metrology measured) {
  const py::tuple maps =
      py::make_tuple(heights_of(measured.surface), heights_of(measured.roughness), heights_of(measured.waviness));
  return py::make_tuple(std::move(measured), maps);
}

void bind_surfaces(py::module_& module) {
  request_class<MetrologyRequest>(module, "MetrologyRequest");
  result_class<Metrology>(module, "Metrology")
      .def_readonly("surface_toml", &Metrology::surface_toml)
      .def_readonly("spectra_csv", &Metrology::spectra_csv)
      .def_readonly("drawing", &Metrology::drawing)
      .def_readonly("x_pixel_um", &Metrology::x_pixel_um)
      .def_readonly("y_pixel_um", &Metrology::y_pixel_um);
  module.def("measure_file", [](const std::filesystem::path& file, const MetrologyRequest& request) {
    return told(watched(py::none(), 0, [file, request](const Running&) { return metrology(file, request); }));
  });
  module.def("measure_heights", [](const Numbers& heights, const MetrologyRequest& request) {
    HeightMap map;
    map.rows = static_cast<std::size_t>(heights.shape(0));
    map.columns = static_cast<std::size_t>(heights.shape(1));
    map.heights_nm.assign(heights.data(), heights.data() + heights.size());
    return told(
        watched(py::none(), 0, [map = std::move(map), request](const Running&) { return metrology(map, request); }));
  });
  module.def("report_page", [](const std::vector<std::pair<std::string, std::string>>& parts, const std::string& title,
                               const std::vector<std::string>& readable) {
    std::vector<ReportPart> all;
    for (const auto& [file, text] : parts) all.push_back({file, text});
    const ReportPage page = watched(py::none(), 0, [all = std::move(all), title, readable](const Running&) {
      return report_page(all, title, readable);
    });
    return py::make_tuple(page.html, texts_of(page.warnings));
  });
  module.def("former_names", [] {
    std::vector<std::tuple<std::string, std::string, std::string>> names;
    for (const FormerName& name : former_names()) names.emplace_back(name.kind, name.former, name.current);
    return names;
  });
  module.def("current_document", [](const std::string& text) { return current_document(text); });
}

}  // namespace
}  // namespace retrace::python

PYBIND11_MODULE(_core, module) {
  using namespace retrace::python;
  module.doc() = "Bindings of the C++ library, for the package retrace.";
  pybind11::register_exception_translator(translate);
  module.def("version", &retrace::version);
  bind_design(module);
  bind_rre(module);
  bind_photometry(module);
  bind_ranging(module);
  bind_part(module);
  bind_making(module);
  bind_studies(module);
  bind_images(module);
  bind_rays(module);
  bind_surfaces(module);
}
