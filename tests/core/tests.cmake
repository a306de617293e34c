retrace_test(raytrace_tests
  SOURCES core/atomic_file_test.cpp core/base64_test.cpp core/csv_test.cpp core/derivative_test.cpp core/former_names_test.cpp core/formula_test.cpp core/jets_test.cpp core/json_text_test.cpp core/leading_number_test.cpp core/memory_budget_test.cpp core/message_text_test.cpp
          core/number_format_test.cpp core/precedence_test.cpp core/progress_test.cpp core/schema_test.cpp core/sin_cos_test.cpp core/toml_file_test.cpp
          support/key_table.cpp support/refusals.cpp
  LIBRARIES retrace::core retrace::threads rapidcheck)
