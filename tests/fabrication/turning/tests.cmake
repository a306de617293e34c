retrace_test(fabrication_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/tool_test.cpp
  LIBRARIES retrace::turning_plan retrace::turning_check)
retrace_test(fabrication_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/border_test.cpp ${CMAKE_CURRENT_LIST_DIR}/cubic_path_test.cpp ${CMAKE_CURRENT_LIST_DIR}/mutation_test.cpp ${CMAKE_CURRENT_LIST_DIR}/path_test.cpp ${CMAKE_CURRENT_LIST_DIR}/envelope_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/linuxcnc_turning_test.cpp ${CMAKE_CURRENT_LIST_DIR}/touch_map_test.cpp
  LIBRARIES retrace::turning_plan retrace::turning_check retrace::post TBB::tbb)
retrace_test(command_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/turn_command_test.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
