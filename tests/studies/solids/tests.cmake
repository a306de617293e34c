retrace_test(raytrace_tests
  SOURCES studies/solids/faceted_solid_test.cpp studies/solids/mesh_files_test.cpp studies/solids/mesh_part_test.cpp
  LIBRARIES retrace::geometry retrace::geometry_check retrace::geometry_io)
retrace_test(command_tests
  SOURCES studies/solids/export_command_test.cpp studies/solids/mesh_command_test.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
# This test reads the written STEP files with OpenCASCADE.
if(RETRACE_WITH_OPENCASCADE)
  retrace_test(step_test
    SOURCES studies/solids/step_test.cpp studies/solids/step_reader.cpp
    LIBRARIES retrace::geometry retrace::geometry_io RetraceOpenCASCADE TKShHealing fmt::fmt)
endif()
