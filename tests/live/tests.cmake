retrace_test(studies_tests
  SOURCES live/engine_test.cpp
  LIBRARIES retrace::live_engine retrace::rre nlohmann_json::nlohmann_json)
find_program(RETRACE_NODE node REQUIRED)
add_test(NAME live/bundle_test
         COMMAND "${RETRACE_PYTHON}" -B live/bundle_test.py "${PROJECT_SOURCE_DIR}" "$<TARGET_FILE:retrace_live>"
         WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
add_test(NAME live/live_sources_test COMMAND "${RETRACE_PYTHON}" -B live/live_sources_test.py "${PROJECT_SOURCE_DIR}"
         WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
add_test(NAME live/modules_test COMMAND "${RETRACE_PYTHON}" -B live/modules_test.py "${PROJECT_SOURCE_DIR}"
         WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
add_test(NAME live/toml_edit_test COMMAND "${RETRACE_NODE}" live/toml_edit_test.mjs "${PROJECT_SOURCE_DIR}"
         WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
# Tests whether the engine matches the sources. The test exists only with emscripten, which is needed to rebuild the
# engine.
find_program(RETRACE_EMXX em++)
if(RETRACE_EMXX)
  add_test(NAME live/sources_test COMMAND "${PROJECT_SOURCE_DIR}/tools/live_page" --check)
endif()
