retrace_test(fabrication_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/job_test.cpp
  LIBRARIES retrace::job rapidcheck)
retrace_test(fabrication_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/machine_test.cpp ${CMAKE_CURRENT_LIST_DIR}/setup_test.cpp
  LIBRARIES retrace::machine rapidcheck)
retrace_test(fabrication_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/formats_test.cpp support/key_table.cpp support/refusals.cpp
  LIBRARIES retrace::job retrace::machine retrace::planing retrace::turning rapidcheck)
retrace_test(fabrication_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/plan_test.cpp
  LIBRARIES retrace::chisel_plan rapidcheck)
retrace_test(fabrication_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/linuxcnc_test.cpp
  LIBRARIES retrace::chisel_plan retrace::post retrace::nc_read)
retrace_test(fabrication_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/nc_reader_test.cpp
  LIBRARIES retrace::nc_read rapidcheck)
retrace_test(fabrication_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/read_back_test.cpp
  LIBRARIES retrace::chisel_plan retrace::post retrace::nc_read rapidcheck)
retrace_test(fabrication_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/control_state_test.cpp ${CMAKE_CURRENT_LIST_DIR}/partial_programs_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/stops_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/cutting_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/verify_test.cpp ${CMAKE_CURRENT_LIST_DIR}/setup_cuts_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/random_machines_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/rates_test.cpp ${CMAKE_CURRENT_LIST_DIR}/passes_test.cpp
  LIBRARIES retrace::chisel_plan retrace::post retrace::chisel_check rapidcheck)
retrace_test(fabrication_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/planned_jobs_test.cpp ${CMAKE_CURRENT_LIST_DIR}/chip_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/chip_faults_test.cpp
  LIBRARIES retrace::chisel_plan retrace::post retrace::nc_read retrace::chisel_check rapidcheck)
retrace_test(fabrication_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/forces_test.cpp
  LIBRARIES retrace::forces)
retrace_test(fabrication_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/chiseling_test.cpp ${CMAKE_CURRENT_LIST_DIR}/rounded_cuts_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/zone_jobs_test.cpp
  LIBRARIES retrace::chisel_plan retrace::post retrace::chisel_check)
retrace_test(fabrication_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/substrate_faults_test.cpp ${CMAKE_CURRENT_LIST_DIR}/substrate_jobs_test.cpp
  LIBRARIES retrace::chisel_plan retrace::post retrace::chisel_check)
retrace_test(fabrication_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/line_moves_test.cpp
  LIBRARIES retrace::chisel_check)
