# The viewer's parts that need no window; cli.view opens one.
if(AFTERGLOW_VIEWER)
  ag_test(viewer/light_values LIBRARIES afterglow_viewer)
  ag_test(viewer/method LIBRARIES afterglow_viewer)
  ag_test(viewer/look LIBRARIES afterglow_viewer)
  ag_test(viewer/path LIBRARIES afterglow_viewer)
  ag_test(viewer/blocks LIBRARIES afterglow_viewer)
endif()
