# Tests of the search and of optimizations with random errors.
retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/noisy_search_test.cpp ${CMAKE_CURRENT_LIST_DIR}/optimise_noise_test.cpp
          support/refusals.cpp
  LIBRARIES retrace::noisy_search retrace::optimise retrace::compose)
retrace_test(command_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/optimize_stop_test.cpp app/program.cpp support/refusals.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
