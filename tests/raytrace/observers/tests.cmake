retrace_test(raytrace_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/diffraction_test.cpp ${CMAKE_CURRENT_LIST_DIR}/geometric_far_field_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/error_free_exit_test.cpp ${CMAKE_CURRENT_LIST_DIR}/formed_aperture_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/mesh_far_field_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/photometric_geometry_test.cpp ${CMAKE_CURRENT_LIST_DIR}/pixel_guide_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/pixel_points_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/scattered_field_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/scattered_limits_test.cpp
  LIBRARIES retrace::raytrace retrace::texture retrace::geometry_io rapidcheck)
# Tests of light behind curved entrance surfaces. They are a separate program, because they trace many elements.
retrace_test(raytrace_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/element_light_test.cpp ${CMAKE_CURRENT_LIST_DIR}/lens_wave_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/rough_lens_test.cpp
  LIBRARIES retrace::raytrace retrace::geometry_io)
# Tests of interference between cells. They are a separate program, because they use only the tracer of beams.
retrace_test(raytrace_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/lattice_field_test.cpp
  LIBRARIES retrace::beams retrace::geometry)
