# Tests of the program from the user's point of view: it runs as a child process, and its output, files and exit code
# are checked.
retrace_test(command_tests
  SOURCES
    app/bad_input_test.cpp
    app/balls_test.cpp
    app/substrate_job_test.cpp
    app/zone_job_command_test.cpp
    app/commands_test.cpp
    app/derivatives_test.cpp
    app/chiseling_command_test.cpp
    app/fabricate_test.cpp
    app/memory_budget_test.cpp
    app/metrology_test.cpp
    app/modules_test.cpp
    app/number_list_test.cpp
    app/option_needs_test.cpp
    app/outline_command_test.cpp
    app/photometry_test.cpp
    app/plane_test.cpp
    app/program.cpp
    support/refusals.cpp
    app/readme_test.cpp
    app/registry_test.cpp
    app/returned_light_test.cpp
    app/roughness_test.cpp
    app/rre_test.cpp
    app/schema_command_test.cpp
    app/terminal_test.cpp
    app/texture_test.cpp
    app/tools_test.cpp
    app/validate_test.cpp
    app/verify_parts_test.cpp
    app/verify_test.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
retrace_test(command_tests
  SOURCES app/entrance_test.cpp app/shell_test.cpp app/inputs_test.cpp app/interrupt_test.cpp app/long_run_test.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
retrace_script_test(app/request_texts
  COMMAND "${RETRACE_PYTHON}" -B "${PROJECT_SOURCE_DIR}/tools/lib/request_texts.py" "$<TARGET_FILE:retrace>" --check)
retrace_test(command_tests
  SOURCES app/first_answers_test.cpp app/program.cpp support/refusals.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
