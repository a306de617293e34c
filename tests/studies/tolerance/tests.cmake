retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/indices_test.cpp ${CMAKE_CURRENT_LIST_DIR}/tolerance_test.cpp
  LIBRARIES retrace::tolerance retrace::quantity Boost::headers nlohmann_json::nlohmann_json)
