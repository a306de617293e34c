# The package for Python, from the build folder, with Debian's packages.
if(NOT RETRACE_WITH_PYTHON)
  return()
endif()
file(GLOB python_tests CONFIGURE_DEPENDS RELATIVE "${CMAKE_CURRENT_LIST_DIR}" "${CMAKE_CURRENT_LIST_DIR}/test_*.py")
foreach(file IN LISTS python_tests)
  string(REGEX REPLACE "test_(.*)\\.py" "\\1" suite "${file}")
  add_test(NAME "python/${suite}"
           COMMAND "${RETRACE_PYTHON}" -B -m unittest --quiet "${file}"
           WORKING_DIRECTORY "${CMAKE_CURRENT_LIST_DIR}")
  set_tests_properties("python/${suite}" PROPERTIES TIMEOUT 1200 COST 40 ENVIRONMENT
    "PYTHONPATH=${PROJECT_BINARY_DIR}/python;RETRACE_PROGRAM=$<TARGET_FILE:retrace>;RETRACE_SOURCE_DIR=${PROJECT_SOURCE_DIR};RETRACE_CMAKE=${CMAKE_COMMAND}")
endforeach()
