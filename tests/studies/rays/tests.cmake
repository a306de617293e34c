retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/emitter_test.cpp ${CMAKE_CURRENT_LIST_DIR}/ray_study_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/tm25_test.cpp ${CMAKE_CURRENT_LIST_DIR}/ray_csv_test.cpp
  LIBRARIES retrace::rays)

# Tests of the command from the user's point of view.
retrace_test(command_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/rays_command_test.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
