retrace_test(materials_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/materials_test.cpp ${CMAKE_CURRENT_LIST_DIR}/spectrum_test.cpp
  LIBRARIES retrace::materials_io)
