retrace_test(fabrication_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/chords_test.cpp ${CMAKE_CURRENT_LIST_DIR}/mutation_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/part_files_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/planing_test.cpp ${CMAKE_CURRENT_LIST_DIR}/linuxcnc_planing_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/verify_test.cpp
  LIBRARIES retrace::design retrace::planing_plan retrace::planing_check retrace::planing_study retrace::post nlohmann_json::nlohmann_json)
