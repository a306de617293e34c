retrace_test(solid_test
  SOURCES solids/faceted_solid_test.cpp solids/mesh_files_test.cpp solids/mesh_part_test.cpp
  LIBRARIES retrace::geometry retrace::geometry_check retrace::geometry_io)
retrace_test(solid_command_test
  SOURCES solids/export_command_test.cpp solids/mesh_command_test.cpp app/program.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
add_dependencies(solid_command_test retrace)
# OpenCASCADE reads back what was written.
if(RETRACE_WITH_OPENCASCADE)
  retrace_test(step_test
    SOURCES solids/step_test.cpp solids/step_reader.cpp
    LIBRARIES retrace::geometry retrace::geometry_io RetraceOpenCASCADE TKShHealing)
endif()
