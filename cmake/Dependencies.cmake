# Third-party libraries. docs/architecture.md lists the modules that may use each; they link the targets below.
find_package(PkgConfig REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS C)
find_package(Vulkan REQUIRED)
pkg_check_modules(CGLM REQUIRED IMPORTED_TARGET cglm)
pkg_check_modules(JANSSON REQUIRED IMPORTED_TARGET jansson)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
# OpenBLAS before LAPACKE, so that its LAPACK is used, not the reference one.
pkg_check_modules(OPENBLAS REQUIRED IMPORTED_TARGET openblas)
pkg_check_modules(LAPACKE REQUIRED IMPORTED_TARGET lapacke)
pkg_check_modules(PNG REQUIRED IMPORTED_TARGET libpng)
pkg_check_modules(JPEG REQUIRED IMPORTED_TARGET libjpeg)
# find_package gives the C core alone; OpenEXR's pkg-config file adds the C++ libraries.
find_package(OpenEXR 3.1 CONFIG REQUIRED)
pkg_check_modules(ASSIMP REQUIRED IMPORTED_TARGET assimp)
pkg_check_modules(SECCOMP REQUIRED IMPORTED_TARGET libseccomp)
# The reentrant one of its libraries.
pkg_check_modules(QHULL REQUIRED IMPORTED_TARGET qhull_r)
pkg_check_modules(STB REQUIRED IMPORTED_TARGET stb)
pkg_check_modules(SPIRV_CROSS REQUIRED IMPORTED_TARGET spirv-cross-c-shared)
# Embree 4 (Debian 13) or 3 (Debian 12); src/trace/embree.c supports both.
find_package(embree 4 QUIET CONFIG)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED CONFIG)
endif()
set(EMBREE_TARGET embree)
string(REGEX MATCH "^[0-9]+" EMBREE_MAJOR "${embree_VERSION}")
# Optional: denoised light maps (src/lightmap/denoise.c).
find_package(OpenImageDenoise 2 QUIET CONFIG)
find_program(GLSLC glslc REQUIRED)
# Chart.js 3, minified, embedded in the report page of `afterglow compare`.
find_file(CHART_JS chart.min.js PATHS /usr/share/javascript PATH_SUFFIXES chart.js Chart.js REQUIRED)
if(AFTERGLOW_TESTS)
  pkg_check_modules(CMOCKA REQUIRED IMPORTED_TARGET cmocka)
endif()
