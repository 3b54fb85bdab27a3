ag_technique_tests(lpv/bounce lpv/cascades lpv/flux lpv/geometry_maps lpv/geometry_scene lpv/history lpv/math
  lpv/occlusion lpv/sky lpv/twin)
