retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/least_squares_test.cpp ${CMAKE_CURRENT_LIST_DIR}/linear_programme_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/sample_statistics_test.cpp ${CMAKE_CURRENT_LIST_DIR}/store_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/unit_samples_test.cpp
  LIBRARIES retrace::estimation retrace::linear retrace::store SQLiteCpp Boost::headers)
