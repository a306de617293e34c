retrace_test(raytrace_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/angle_errors_test.cpp ${CMAKE_CURRENT_LIST_DIR}/cant_test.cpp ${CMAKE_CURRENT_LIST_DIR}/centroid_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/facet_planes_test.cpp          ${CMAKE_CURRENT_LIST_DIR}/part_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/sag_test.cpp ${CMAKE_CURRENT_LIST_DIR}/boundary_test.cpp ${CMAKE_CURRENT_LIST_DIR}/freeform_surface_test.cpp ${CMAKE_CURRENT_LIST_DIR}/zones_test.cpp ${CMAKE_CURRENT_LIST_DIR}/outline_test.cpp ${CMAKE_CURRENT_LIST_DIR}/dxf_outline_test.cpp
  LIBRARIES retrace::geometry retrace::geometry_check)

retrace_test(raytrace_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/substrate_part_test.cpp
  LIBRARIES retrace::geometry retrace::geometry_check)

retrace_test(raytrace_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/curved_boundary_test.cpp ${CMAKE_CURRENT_LIST_DIR}/entrance_mesh_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/entrance_shape_test.cpp
  LIBRARIES retrace::geometry retrace::geometry_check)
