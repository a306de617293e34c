retrace_test(page_test
  SOURCES page/page_test.cpp
  LIBRARIES retrace::report_page)
retrace_test(report_command_test
  SOURCES page/report_command_test.cpp app/program.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
add_dependencies(report_command_test retrace)
# Debian's own Python, which has Debian's packages.
find_program(RETRACE_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)
add_test(NAME page_bundle_test COMMAND "${RETRACE_PYTHON}" -B page/bundle_test.py "${PROJECT_SOURCE_DIR}"
         WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
add_test(NAME page_browser_test
         COMMAND "${RETRACE_PYTHON}" -B page/browser_test.py "$<TARGET_FILE:retrace>" "${PROJECT_SOURCE_DIR}"
         WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
set_tests_properties(page_browser_test PROPERTIES TIMEOUT 600 RUN_SERIAL ON)
