# This test is linked like a program of a user: only with the shared library, without the static libraries.
retrace_test(library_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/library_test.cpp app/program.cpp support/refusals.cpp
  LIBRARIES retrace::retrace nlohmann_json::nlohmann_json)
target_compile_definitions(library_tests PRIVATE RETRACE_BUILD_DIR="${PROJECT_BINARY_DIR}"
                                                 RETRACE_LIBRARY="$<TARGET_FILE:retrace_shared>"
                                                 RETRACE_CMAKE="${CMAKE_COMMAND}"
                                                 RETRACE_GENERATOR="${CMAKE_GENERATOR}" RETRACE_NM="${CMAKE_NM}")
add_dependencies(library_tests retrace)
