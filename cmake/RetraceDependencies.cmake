# Every library retrace uses comes from the system; nothing is downloaded. Versions are minimums.
# docs/dependencies.md says what each one is for.

find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(TBB 2021.8 CONFIG REQUIRED)
find_package(Eigen3 3.4 CONFIG REQUIRED)
find_package(embree 3.13 CONFIG REQUIRED)
find_package(CGAL 5.5 CONFIG REQUIRED)
find_package(CLI11 2.1 CONFIG REQUIRED)
find_package(fmt 9.1 CONFIG REQUIRED)
find_package(nlohmann_json 3.11 CONFIG REQUIRED)
find_package(Boost 1.74 REQUIRED)
find_path(RETRACE_RANDOM123_INCLUDE_DIR Random123/philox.h REQUIRED)
pkg_check_modules(TOMLPLUSPLUS REQUIRED IMPORTED_TARGET tomlplusplus>=3.3)
pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo>=1.16 cairo-svg cairo-png)

if(RETRACE_BUILD_TESTS)
  find_package(GTest 1.12 CONFIG REQUIRED)
  find_package(rapidcheck CONFIG REQUIRED)
endif()
if(RETRACE_BUILD_BENCHMARKS)
  find_package(benchmark 1.7 CONFIG REQUIRED)
endif()
