retrace_test(fabrication_job_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/job_test.cpp
  LIBRARIES retrace::job rapidcheck)
