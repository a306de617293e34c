retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/cells_test.cpp ${CMAKE_CURRENT_LIST_DIR}/distribution_test.cpp ${CMAKE_CURRENT_LIST_DIR}/machining_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/study_format_test.cpp ${CMAKE_CURRENT_LIST_DIR}/study_reader_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/optimise_test.cpp ${CMAKE_CURRENT_LIST_DIR}/sweep_test.cpp
  LIBRARIES retrace::optimise retrace::sweep retrace::quantity retrace::store SQLiteCpp)

# Tests of the program: killed, interrupted and rejected runs, and runs that share work among processes.
set(sweep_app_sources sweep_command_test.cpp tolerance_command_test.cpp)
if(RETRACE_WITH_MPI)
  list(APPEND sweep_app_sources mpi_command_test.cpp mpi_shared_test.cpp)
endif()
list(TRANSFORM sweep_app_sources PREPEND ${CMAKE_CURRENT_LIST_DIR}/)
retrace_test(command_tests
  SOURCES ${sweep_app_sources}
  LIBRARIES retrace::core nlohmann_json::nlohmann_json SQLiteCpp SQLite::SQLite3)
if(RETRACE_WITH_MPI)
  target_compile_definitions(command_tests PRIVATE RETRACE_MPIRUN="${MPIEXEC_EXECUTABLE}")
endif()
