# A program of its own, because its tests need only the library of one study.
retrace_test(ranging_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/cube_field_test.cpp ${CMAKE_CURRENT_LIST_DIR}/ranging_array_test.cpp
  LIBRARIES retrace::ranging)
