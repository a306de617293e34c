retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/calibration_example_test.cpp ${CMAKE_CURRENT_LIST_DIR}/calibration_test.cpp ${CMAKE_CURRENT_LIST_DIR}/correction_test.cpp ${CMAKE_CURRENT_LIST_DIR}/facet_marks_test.cpp ${CMAKE_CURRENT_LIST_DIR}/time_calibration_test.cpp
  LIBRARIES retrace::calibration)
