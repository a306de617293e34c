# Tests of the search need no designs. They are a program of their own, which builds in seconds.
retrace_test(search_tests SOURCES ${CMAKE_CURRENT_LIST_DIR}/noisy_search_test.cpp LIBRARIES retrace::noisy_search)
