retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/tolerance_test.cpp
  LIBRARIES retrace::tolerance retrace::quantity nlohmann_json::nlohmann_json)
