retrace_test(layering_test
  SOURCES layering/corner_means_test.cpp layering/layering_test.cpp layering/layer_rules.cpp
  LIBRARIES nlohmann_json::nlohmann_json)
add_test(NAME layering/unit_sizes
         COMMAND "${RETRACE_PYTHON}" -B "${CMAKE_CURRENT_LIST_DIR}/unit_sizes.py" "${PROJECT_BINARY_DIR}")
add_test(NAME layering/documents
         COMMAND "${RETRACE_PYTHON}" -B "${PROJECT_SOURCE_DIR}/tools/lib/layer_tables.py" --check)
add_test(NAME layering/renamed_identifiers
         COMMAND "${RETRACE_PYTHON}" -B "${CMAKE_CURRENT_LIST_DIR}/renamed_identifiers.py")
