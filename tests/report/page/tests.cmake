retrace_test(studies_tests
  SOURCES report/page/former_names_test.cpp report/page/page_test.cpp report/page/same_plots_test.cpp
  LIBRARIES retrace::report_page retrace::report_studies)
retrace_test(command_tests
  SOURCES report/page/explore_command_test.cpp report/page/report_command_test.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
add_test(NAME page/bundle_test COMMAND "${RETRACE_PYTHON}" -B report/page/bundle_test.py "${PROJECT_SOURCE_DIR}"
         WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
retrace_script_test(page/layout_test
  COMMAND "${RETRACE_PYTHON}" -B report/page/layout_test.py "$<TARGET_FILE:retrace>" "${PROJECT_SOURCE_DIR}")
set_tests_properties(page/layout_test PROPERTIES TIMEOUT 600 LABELS slow)
retrace_script_test(page/browser_test
  COMMAND "${RETRACE_PYTHON}" -B report/page/browser_test.py "$<TARGET_FILE:retrace>" "${PROJECT_SOURCE_DIR}")
set_tests_properties(page/browser_test PROPERTIES TIMEOUT 600 RUN_SERIAL ON LABELS slow)
