retrace_test(raytrace_tests
  SOURCES solids/faceted_solid_test.cpp solids/mesh_files_test.cpp solids/mesh_part_test.cpp
  LIBRARIES retrace::geometry retrace::geometry_check retrace::geometry_io)
retrace_test(command_tests
  SOURCES solids/export_command_test.cpp solids/mesh_command_test.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
# OpenCASCADE reads back what was written.
if(RETRACE_WITH_OPENCASCADE)
  retrace_test(step_test
    SOURCES solids/step_test.cpp solids/step_reader.cpp
    LIBRARIES retrace::geometry retrace::geometry_io RetraceOpenCASCADE TKShHealing)
endif()
