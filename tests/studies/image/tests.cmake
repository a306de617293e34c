retrace_test(studies_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/camera_error_test.cpp ${CMAKE_CURRENT_LIST_DIR}/camera_diffraction_test.cpp ${CMAKE_CURRENT_LIST_DIR}/camera_engines_test.cpp ${CMAKE_CURRENT_LIST_DIR}/camera_parts_test.cpp ${CMAKE_CURRENT_LIST_DIR}/camera_test.cpp ${CMAKE_CURRENT_LIST_DIR}/curved_images_test.cpp ${CMAKE_CURRENT_LIST_DIR}/detector_test.cpp ${CMAKE_CURRENT_LIST_DIR}/lamp_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/picture_file_test.cpp ${CMAKE_CURRENT_LIST_DIR}/pixel_grid_test.cpp ${CMAKE_CURRENT_LIST_DIR}/road_test.cpp
  LIBRARIES retrace::image retrace::photometry retrace::report)
if(RETRACE_WITH_OPENIMAGEIO)
  target_link_libraries(studies_tests PRIVATE PkgConfig::OPENIMAGEIO)
endif()

# Tests of the command from the user's point of view.
retrace_test(command_tests
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/image_command_test.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
