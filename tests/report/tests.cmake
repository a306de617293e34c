find_package(EXPAT 2.4 REQUIRED)
retrace_test(studies_tests
  SOURCES report/axis_ticks_test.cpp report/canvas_test.cpp report/contours_test.cpp report/contour_plot_test.cpp report/map_plot_test.cpp report/path_plot_test.cpp report/plot_test.cpp report/polar_plot_test.cpp report/roughness_plot_test.cpp
    report/rre_plot_test.cpp     report/surface_plot_test.cpp
  LIBRARIES retrace::report retrace::report_studies retrace::core PkgConfig::CAIRO EXPAT::EXPAT rapidcheck)
