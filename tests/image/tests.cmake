retrace_test(image_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/camera_error_test.cpp ${CMAKE_CURRENT_LIST_DIR}/camera_parts_test.cpp ${CMAKE_CURRENT_LIST_DIR}/camera_test.cpp ${CMAKE_CURRENT_LIST_DIR}/detector_test.cpp
          ${CMAKE_CURRENT_LIST_DIR}/picture_file_test.cpp ${CMAKE_CURRENT_LIST_DIR}/pixel_grid_test.cpp ${CMAKE_CURRENT_LIST_DIR}/road_test.cpp
  LIBRARIES retrace::image retrace::photometry retrace::report)
if(RETRACE_WITH_OPENIMAGEIO)
  target_link_libraries(image_test PRIVATE PkgConfig::OPENIMAGEIO)
endif()

# The command, as users meet it.
retrace_test(image_command_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/image_command_test.cpp app/program.cpp
  LIBRARIES retrace::core nlohmann_json::nlohmann_json)
add_dependencies(image_command_test retrace)
