retrace_script_test(live/page_test
  COMMAND "${RETRACE_PYTHON}" -B live/page/page_test.py "$<TARGET_FILE:retrace>" "${PROJECT_SOURCE_DIR}")
set_tests_properties(live/page_test PROPERTIES TIMEOUT 900 RUN_SERIAL ON LABELS slow)
