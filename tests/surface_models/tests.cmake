retrace_test(raytrace_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/edge_fit_test.cpp ${CMAKE_CURRENT_LIST_DIR}/filter_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/height_map_reader_test.cpp ${CMAKE_CURRENT_LIST_DIR}/height_parameters_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/spectrum_test.cpp ${CMAKE_CURRENT_LIST_DIR}/texture_model_test.cpp
  LIBRARIES retrace::texture)

# This test compares results with those of Gwyddion's libraries.
retrace_test(gwyddion_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/gwyddion_test.cpp
  LIBRARIES retrace::texture "${RETRACE_GWYPROCESS_LIBRARY}" "${RETRACE_GWYDDION_LIBRARY}" PkgConfig::GOBJECT)
target_include_directories(gwyddion_test SYSTEM PRIVATE "${RETRACE_GWYDDION_INCLUDE_DIR}")

retrace_test(raytrace_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/first_order_test.cpp ${CMAKE_CURRENT_LIST_DIR}/height_map_scatter_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/lay_test.cpp ${CMAKE_CURRENT_LIST_DIR}/scatter_test.cpp
  LIBRARIES retrace::scatter retrace::materials Boost::headers)
