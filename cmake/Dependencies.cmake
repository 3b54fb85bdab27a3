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
find_program(GLSLC glslc REQUIRED)
if(AFTERGLOW_TESTS)
  pkg_check_modules(CMOCKA REQUIRED IMPORTED_TARGET cmocka)
endif()
