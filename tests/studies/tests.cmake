retrace_test(studies_design_test SOURCES ${CMAKE_CURRENT_LIST_DIR}/design_reader_test.cpp LIBRARIES retrace::design
                                                                                             rapidcheck)
