retrace_test(command_tests
  SOURCES studies/appearance/material_command_test.cpp studies/appearance/material_readers.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
