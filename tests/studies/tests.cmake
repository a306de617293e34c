retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/substrate_reader_test.cpp ${CMAKE_CURRENT_LIST_DIR}/outline_reader_test.cpp ${CMAKE_CURRENT_LIST_DIR}/design_array_test.cpp ${CMAKE_CURRENT_LIST_DIR}/design_format_test.cpp ${CMAKE_CURRENT_LIST_DIR}/design_json_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/design_labels_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/design_light_test.cpp ${CMAKE_CURRENT_LIST_DIR}/design_reader_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/design_surface_test.cpp ${CMAKE_CURRENT_LIST_DIR}/facet_planes_reader_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/init_templates_test.cpp support/key_table.cpp support/refusals.cpp
  LIBRARIES retrace::optical_model rapidcheck)
retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/adaptive_curve_test.cpp ${CMAKE_CURRENT_LIST_DIR}/coating_test.cpp ${CMAKE_CURRENT_LIST_DIR}/derivatives_test.cpp ${CMAKE_CURRENT_LIST_DIR}/engine_choice_test.cpp ${CMAKE_CURRENT_LIST_DIR}/returned_light_test.cpp ${CMAKE_CURRENT_LIST_DIR}/rre_map_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/rre_files_test.cpp ${CMAKE_CURRENT_LIST_DIR}/roughness_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/spectrum_of_light_test.cpp ${CMAKE_CURRENT_LIST_DIR}/texture_test.cpp ${CMAKE_CURRENT_LIST_DIR}/wet_back_test.cpp
  LIBRARIES retrace::roughness retrace::rre retrace::inspect)
retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/coefficient_map_test.cpp ${CMAKE_CURRENT_LIST_DIR}/light_symmetry_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/limits_test.cpp ${CMAKE_CURRENT_LIST_DIR}/photometric_colour_test.cpp ${CMAKE_CURRENT_LIST_DIR}/photometry_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/temperature_test.cpp ${CMAKE_CURRENT_LIST_DIR}/glass_of_design_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/photometry_verdict_test.cpp ${CMAKE_CURRENT_LIST_DIR}/form_of_design_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/entrance_state_test.cpp ${CMAKE_CURRENT_LIST_DIR}/inclined_entrance_test.cpp ${CMAKE_CURRENT_LIST_DIR}/photometric_first_answer_test.cpp
  LIBRARIES retrace::photometry retrace::inspect retrace::rre nlohmann_json::nlohmann_json)
retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/zones_test.cpp ${CMAKE_CURRENT_LIST_DIR}/former_keys_test.cpp
  LIBRARIES retrace::sweep retrace::job retrace::machine retrace::planing retrace::turning retrace::rre retrace::inspect retrace::solids retrace::scene nlohmann_json::nlohmann_json)
retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/balls_test.cpp
  LIBRARIES retrace::inspect retrace::photometry retrace::rre nlohmann_json::nlohmann_json)
retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/fabrication_request_test.cpp
  LIBRARIES retrace::fabrication_study)
retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/validation_test.cpp
  LIBRARIES retrace::validation nlohmann_json::nlohmann_json)
retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/round_cube_design_test.cpp support/refusals.cpp
  LIBRARIES retrace::photometry retrace::fabrication_study retrace::scene nlohmann_json::nlohmann_json)
retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/element_sample_test.cpp
  LIBRARIES retrace::photometry retrace::photometry_by_rays retrace::rre)
retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/ruled_design_test.cpp ${CMAKE_CURRENT_LIST_DIR}/../geometry/ruled_pattern_test.cpp
          support/key_table.cpp support/refusals.cpp support/reference_tracer.cpp
  LIBRARIES retrace::photometry retrace::inspect retrace::rre retrace::geometry_check retrace::geometry_io Boost::headers rapidcheck nlohmann_json::nlohmann_json)
retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/cell_interference_test.cpp support/refusals.cpp
  LIBRARIES retrace::photometry nlohmann_json::nlohmann_json)
