# Every library retrace uses comes from the system; nothing is downloaded. Versions are minimums.
# docs/dependencies.md says what each one is for.

find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(TBB 2021.8 CONFIG REQUIRED)
find_package(Eigen3 3.4 CONFIG REQUIRED)
find_package(embree 3.13 CONFIG REQUIRED)
find_package(hwy 1.0.3 CONFIG REQUIRED)
find_package(CGAL 5.5 CONFIG REQUIRED)
find_package(CLI11 2.1 CONFIG REQUIRED)
find_package(fmt 9.1 CONFIG REQUIRED)
find_package(nlohmann_json 3.11 CONFIG REQUIRED)
find_package(Boost 1.74 REQUIRED)
find_package(SQLite3 3.37 REQUIRED)
find_package(SQLiteCpp 3.2 CONFIG REQUIRED)
find_path(RETRACE_RANDOM123_INCLUDE_DIR Random123/philox.h REQUIRED)
pkg_check_modules(TOMLPLUSPLUS REQUIRED IMPORTED_TARGET tomlplusplus>=3.3)
pkg_check_modules(FFTW REQUIRED IMPORTED_TARGET fftw3>=3.3)
pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo>=1.16 cairo-svg cairo-png)

if(RETRACE_WITH_OPENIMAGEIO)
  # Its own CMake package asks for OpenEXR's and others', which reading pictures does not need.
  pkg_check_modules(OPENIMAGEIO REQUIRED IMPORTED_TARGET OpenImageIO>=2.4)
endif()

if(RETRACE_BUILD_TESTS)
  find_package(GTest 1.12 CONFIG REQUIRED)
  find_package(rapidcheck CONFIG REQUIRED)
  # Gwyddion's own pkg-config file asks for its graphical parts as well, which are not wanted here.
  pkg_check_modules(GOBJECT REQUIRED IMPORTED_TARGET gobject-2.0)
  find_path(RETRACE_GWYDDION_INCLUDE_DIR libprocess/datafield.h PATH_SUFFIXES gwyddion REQUIRED)
  find_library(RETRACE_GWYPROCESS_LIBRARY gwyprocess2 REQUIRED)
  find_library(RETRACE_GWYDDION_LIBRARY gwyddion2 REQUIRED)
endif()
if(RETRACE_BUILD_BENCHMARKS)
  find_package(benchmark 1.7 CONFIG REQUIRED)
endif()
