retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/compose_test.cpp ${CMAKE_CURRENT_LIST_DIR}/errors_test.cpp ${CMAKE_CURRENT_LIST_DIR}/mixture_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/readings_test.cpp ${CMAKE_CURRENT_LIST_DIR}/real_cells_test.cpp
  LIBRARIES retrace::compose nlohmann_json::nlohmann_json)
retrace_test(command_tests SOURCES ${CMAKE_CURRENT_LIST_DIR}/compose_command_test.cpp LIBRARIES nlohmann_json::nlohmann_json SQLiteCpp)
retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/best_so_far_test.cpp support/refusals.cpp
  LIBRARIES retrace::compose)
