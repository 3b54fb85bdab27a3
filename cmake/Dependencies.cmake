# Third-party libraries, each named once. Which module may use which is the table in docs/architecture.md;
# modules ask for them by the names of the targets below.
find_package(PkgConfig REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS C)
find_package(Vulkan REQUIRED)
pkg_check_modules(CGLM REQUIRED IMPORTED_TARGET cglm)
pkg_check_modules(JANSSON REQUIRED IMPORTED_TARGET jansson)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(PNG REQUIRED IMPORTED_TARGET libpng)
# The C core alone: OpenEXR's pkg-config file names the C++ libraries too.
find_package(OpenEXR 3.1 CONFIG REQUIRED)
pkg_check_modules(ASSIMP REQUIRED IMPORTED_TARGET assimp)
pkg_check_modules(STB REQUIRED IMPORTED_TARGET stb)
pkg_check_modules(SPIRV_CROSS REQUIRED IMPORTED_TARGET spirv-cross-c-shared)
# Embree 4 (Debian 13) or 3 (Debian 12): src/trace/embree.c knows the difference.
find_package(embree 4 QUIET CONFIG)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED CONFIG)
endif()
set(EMBREE_TARGET embree)
string(REGEX MATCH "^[0-9]+" EMBREE_MAJOR "${embree_VERSION}")
find_program(GLSLC glslc REQUIRED)
# Chart.js 3, minified and made for <script>: a part of the page that compare writes.
find_file(CHART_JS chart.min.js PATHS /usr/share/javascript PATH_SUFFIXES chart.js Chart.js REQUIRED)
if(AFTERGLOW_TESTS)
  pkg_check_modules(CMOCKA REQUIRED IMPORTED_TARGET cmocka)
endif()
