retrace_test(raytrace_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/chromaticity_test.cpp ${CMAKE_CURRENT_LIST_DIR}/glass_catalogue_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/index_record_test.cpp ${CMAKE_CURRENT_LIST_DIR}/knee_rule_test.cpp ${CMAKE_CURRENT_LIST_DIR}/materials_test.cpp ${CMAKE_CURRENT_LIST_DIR}/spectrum_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/thick_layers_test.cpp ${CMAKE_CURRENT_LIST_DIR}/thin_film_test.cpp
  LIBRARIES retrace::materials_io)
