retrace_test(raytrace_tests
  SOURCES requests/requests_test.cpp
  LIBRARIES retrace::requests)
