retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/setup_sheet_test.cpp
  LIBRARIES retrace::setup_study retrace::report_page)
