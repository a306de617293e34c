# Builds the engine of the live page with emscripten (tools/live_page): the parts of retrace that can run in a browser.
# Only header-only libraries are available. The CMakeLists.txt of each folder omits sources that need other libraries.
# Functions in live/engine/stand_ins/ replace these sources and report an error.

set(RETRACE_LIVE_PAGE ON)
set(RETRACE_WARNINGS_AS_ERRORS OFF)
include(RetraceTargets)
target_compile_options(retrace_options INTERFACE -fwasm-exceptions)
target_link_options(retrace_options INTERFACE -fwasm-exceptions)
# The standard library of emscripten lacks some functions that retrace uses.
target_compile_options(retrace_options INTERFACE -include "${PROJECT_SOURCE_DIR}/live/engine/compat/standard_library.h")

# Only these system headers may be used. Other system headers do not match the browser's standard library.
set(headers "${PROJECT_BINARY_DIR}/system_headers")
file(MAKE_DIRECTORY "${headers}")
foreach(folder IN ITEMS eigen3/Eigen eigen3/unsupported boost fast_float fmt hwy nlohmann toml++)
  get_filename_component(name "${folder}" NAME)
  file(CREATE_LINK "/usr/include/${folder}" "${headers}/${name}" SYMBOLIC)
endforeach()
# Random123 compiles only for a list of known processors. The choice of the processor does not affect the used
# functions.
file(WRITE "${headers}/Random123/philox.h"
     "#define __riscv\n#include \"/usr/include/Random123/philox.h\"\n#undef __riscv\n")
set(RETRACE_RANDOM123_INCLUDE_DIR "${headers}")
set(RETRACE_FAST_FLOAT_INCLUDE_DIR "${headers}")
foreach(target IN ITEMS Boost::headers Eigen3::Eigen fmt::fmt hwy::hwy nlohmann_json::nlohmann_json PkgConfig::TOMLPLUSPLUS)
  add_library(${target} INTERFACE IMPORTED)
  target_include_directories(${target} SYSTEM INTERFACE "${headers}")
endforeach()
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
# Assertions of toml++ on the contents of user files are disabled, as in the native program.
target_compile_definitions(PkgConfig::TOMLPLUSPLUS INTERFACE NDEBUG)
foreach(folder IN ITEMS core requests geometry materials surface_models raytrace design studies/rre studies/scene
                        studies/photometry live/engine)
  add_subdirectory(${folder})
endforeach()
