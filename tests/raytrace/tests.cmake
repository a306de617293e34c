retrace_test(raytrace_tests
  SOURCES
    ${CMAKE_CURRENT_LIST_DIR}/angle_errors_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/back_surface_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/balls_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/beam_tracer_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/cell_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/cant_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/closed_forms_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/edges_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/engines_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/equal_places_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/form_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/layers_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/ledger_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/flat_polygon_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/level_beams_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/outline_part_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/part_symmetry_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/overlay_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/polarisation_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/ray_progress_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/ray_tracer_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/reference_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/returned_beams_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/robustness_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/round_edges_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/rough_dielectric_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/rough_variance_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/sampling_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/scatter_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/scratches_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/stochastic_beams_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/shells_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/unseen_paths_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/weak_beams_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/wet_back_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/soiled_entrance_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/../support/reference_tracer.cpp
  LIBRARIES retrace::raytrace retrace::geometry_check Boost::headers rapidcheck)
# The reference tracer takes most of the time of its tests, and runs faster with full optimization. It is compiled
# separately, because a unity build ignores the options of a source.
set_source_files_properties("${CMAKE_CURRENT_LIST_DIR}/../support/reference_tracer.cpp" PROPERTIES
  COMPILE_OPTIONS $<$<CONFIG:Release>:-O3> SKIP_UNITY_BUILD_INCLUSION ON)

retrace_test(raytrace_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/substrate_trace_test.cpp
  LIBRARIES retrace::raytrace retrace::geometry_check Boost::headers)
retrace_test(raytrace_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/entrance_test.cpp
  LIBRARIES retrace::raytrace)
retrace_test(raytrace_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/round_cube_test.cpp ${CMAKE_CURRENT_LIST_DIR}/../support/reference_tracer.cpp
  LIBRARIES retrace::raytrace retrace::geometry_check Boost::headers)
