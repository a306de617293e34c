# Tests of faces of STEP files as surfaces of designs. They need the program that reads STEP files.
if(RETRACE_WITH_OPENCASCADE)
  retrace_test(studies_tests
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/broken_step_test.cpp ${CMAKE_CURRENT_LIST_DIR}/patch_surface_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/step_faces_test.cpp app/program.cpp support/refusals.cpp
    LIBRARIES retrace::photometry retrace::rre retrace::inspect retrace::step_files nlohmann_json::nlohmann_json)
endif()
