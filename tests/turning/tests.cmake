retrace_test(turning_surface_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/sag_test.cpp ${CMAKE_CURRENT_LIST_DIR}/boundary_test.cpp ${CMAKE_CURRENT_LIST_DIR}/surface_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/tool_test.cpp
  LIBRARIES retrace::turning)
retrace_test(turning_path_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/path_test.cpp ${CMAKE_CURRENT_LIST_DIR}/envelope_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/linuxcnc_turning_test.cpp ${CMAKE_CURRENT_LIST_DIR}/touch_map_test.cpp
  LIBRARIES retrace::turning retrace::post)
retrace_test(turning_command_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/turn_command_test.cpp app/program.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
add_dependencies(turning_command_test retrace)
