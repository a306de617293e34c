# Tests of the Python package in the build folder, with Debian's Python packages.
if(NOT RETRACE_WITH_PYTHON)
  return()
endif()
file(GLOB python_tests CONFIGURE_DEPENDS RELATIVE "${CMAKE_CURRENT_LIST_DIR}" "${CMAKE_CURRENT_LIST_DIR}/test_*.py")
foreach(file IN LISTS python_tests)
  string(REGEX REPLACE "test_(.*)\\.py" "\\1" suite "${file}")
  retrace_script_test("python/${suite}" COMMAND "${RETRACE_PYTHON}" -B -m unittest --quiet "${file}")
  set_tests_properties("python/${suite}" PROPERTIES WORKING_DIRECTORY "${CMAKE_CURRENT_LIST_DIR}" TIMEOUT 1200 ENVIRONMENT
    "PYTHONPATH=${PROJECT_BINARY_DIR}/python;RETRACE_PROGRAM=$<TARGET_FILE:retrace>;RETRACE_SOURCE_DIR=${PROJECT_SOURCE_DIR};RETRACE_CMAKE=${CMAKE_COMMAND}")
endforeach()
set_tests_properties(python/install python/notebooks PROPERTIES LABELS slow)
