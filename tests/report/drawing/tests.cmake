find_package(EXPAT 2.4 REQUIRED)
retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/design_drawing_test.cpp ${CMAKE_CURRENT_LIST_DIR}/shaded_view_test.cpp
  LIBRARIES retrace::report_drawing PkgConfig::CAIRO EXPAT::EXPAT)

# Tests of the command from the user's point of view.
retrace_test(command_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/drawing_command_test.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
