# The engine of the live page: what of the tree a browser can run, built by emscripten (tools/live_page). Libraries are
# headers alone; what needs others is left out by the folders' lists, and live/engine/stand_ins/ says so to who asks.

set(RETRACE_LIVE_PAGE ON)
set(RETRACE_WARNINGS_AS_ERRORS OFF)
include(RetraceTargets)
target_compile_options(retrace_options INTERFACE -fwasm-exceptions)
target_link_options(retrace_options INTERFACE -fwasm-exceptions)
# Its standard library lacks some of what is used.
target_compile_options(retrace_options INTERFACE -include "${PROJECT_SOURCE_DIR}/live/engine/compat/standard_library.h")

# Only these headers of the system's: its others are not those of the browser.
set(headers "${PROJECT_BINARY_DIR}/system_headers")
file(MAKE_DIRECTORY "${headers}")
foreach(folder IN ITEMS eigen3/Eigen eigen3/unsupported boost fast_float fmt hwy nlohmann toml++)
  get_filename_component(name "${folder}" NAME)
  file(CREATE_LINK "/usr/include/${folder}" "${headers}/${name}" SYMBOLIC)
endforeach()
# Random123 asks for one of the machines that it was tested on; which one matters to nothing that is used here.
file(WRITE "${headers}/Random123/philox.h"
     "#define __riscv\n#include \"/usr/include/Random123/philox.h\"\n#undef __riscv\n")
set(RETRACE_RANDOM123_INCLUDE_DIR "${headers}")
set(RETRACE_FAST_FLOAT_INCLUDE_DIR "${headers}")
foreach(target IN ITEMS Boost::headers Eigen3::Eigen fmt::fmt hwy::hwy nlohmann_json::nlohmann_json PkgConfig::TOMLPLUSPLUS)
  add_library(${target} INTERFACE IMPORTED)
  target_include_directories(${target} SYSTEM INTERFACE "${headers}")
endforeach()
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
# Without assertions on what users gave, as the library of the program.
target_compile_definitions(PkgConfig::TOMLPLUSPLUS INTERFACE NDEBUG)
foreach(folder IN ITEMS core requests geometry materials surface_models raytrace studies/design studies/rre studies/scene
                        studies/photometry live/engine)
  add_subdirectory(${folder})
endforeach()
