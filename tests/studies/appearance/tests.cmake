find_package(EXPAT 2.4 REQUIRED)
retrace_test(studies_tests
  SOURCES studies/appearance/radiance_file_test.cpp
  LIBRARIES retrace::appearance EXPAT::EXPAT)
retrace_test(command_tests
  SOURCES studies/appearance/material_command_test.cpp studies/appearance/material_readers.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
