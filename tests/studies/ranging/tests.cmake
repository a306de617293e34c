# A program of its own, because its tests need only the library of one study.
retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/cube_field_test.cpp ${CMAKE_CURRENT_LIST_DIR}/cubes_reader_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/ranging_array_test.cpp support/key_table.cpp support/refusals.cpp
  LIBRARIES retrace::ranging rapidcheck nlohmann_json::nlohmann_json)

# Tests of the command from the user's point of view.
retrace_test(command_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/ranging_command_test.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
