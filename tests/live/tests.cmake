retrace_test(studies_tests
  SOURCES live/engine_test.cpp
  LIBRARIES retrace::live_engine retrace::rre nlohmann_json::nlohmann_json)
