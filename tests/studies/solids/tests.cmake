retrace_test(raytrace_tests
  SOURCES studies/solids/faceted_solid_test.cpp studies/solids/mesh_files_test.cpp studies/solids/mesh_part_test.cpp
  LIBRARIES retrace::geometry retrace::geometry_check retrace::geometry_io)
retrace_test(command_tests
  SOURCES studies/solids/export_command_test.cpp studies/solids/mesh_command_test.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
# This test reads the written STEP files with OpenCASCADE.
if(RETRACE_WITH_OPENCASCADE)
  retrace_test(step_test
    SOURCES studies/solids/step_test.cpp studies/solids/exact_step_test.cpp studies/solids/step_reader.cpp
    LIBRARIES retrace::geometry retrace::geometry_io retrace::exact_boundary RetraceOpenCASCADE TKShHealing fmt::fmt)
endif()
# These tests make STEP files with OpenCASCADE.
if(RETRACE_WITH_OPENCASCADE)
  retrace_test(solid_tests
    SOURCES app/program.cpp support/refusals.cpp studies/solids/solid_command_test.cpp studies/solids/mesh_keys_test.cpp
            studies/solids/step_reader.cpp studies/solids/step_writer.cpp studies/inspect/tool_report_test.cpp
    LIBRARIES retrace::core retrace::geometry_io retrace::inspect retrace::rre nlohmann_json::nlohmann_json RetraceOpenCASCADE TKShHealing
              TKPrim TKBO)
  add_dependencies(solid_tests retrace)
endif()
