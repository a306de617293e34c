retrace_test(sweep_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/machining_test.cpp ${CMAKE_CURRENT_LIST_DIR}/sampling_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/store_test.cpp ${CMAKE_CURRENT_LIST_DIR}/study_reader_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/sweep_test.cpp
  LIBRARIES retrace::sweep retrace::quantity retrace::store SQLiteCpp)

# The program: runs that are killed, interrupted, shared and refused.
retrace_test(sweep_app_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/../app/program.cpp ${CMAKE_CURRENT_LIST_DIR}/sweep_command_test.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json SQLiteCpp SQLite::SQLite3)
add_dependencies(sweep_app_test retrace)
