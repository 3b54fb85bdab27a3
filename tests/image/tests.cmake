ag_test(image/image USES image)
ag_test(image/exr USES image LIBRARIES OpenEXR::OpenEXRCore)
ag_test(image/png USES image LIBRARIES PkgConfig::PNG)
ag_test(image/exposure USES image)
ag_test(image/tonemap USES image)
target_sources(test_image PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/image/tonemap_twin.cpp)
ag_test(image/metrics USES image)
ag_test(image/ssim USES image)
ag_test(image/flip USES image LIBRARIES OpenMP::OpenMP_C)
ag_test(image/hdr USES image)
ag_test(image/ktx2 USES image)
ag_test(image/damaged USES image)
ag_test(image/scarce USES image)

# The GLSL twin compiles, even when included twice.
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/image/tonemap_twice.comp @ONLY CONTENT [[
#version 460
#extension GL_GOOGLE_include_directive : require
#include "image/tonemap.glsl"
#include "image/tonemap.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform image2D pixels;
layout(push_constant) uniform push { float ev; };
void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    vec4 l = imageLoad(pixels, p);
    imageStore(pixels, p, vec4(tonemap_pbr_neutral(l.rgb * exposure_scale(ev)), l.a));
}
]])
add_test(NAME image.tonemap_glsl COMMAND ${GLSLC} --target-env=vulkan1.3 -Werror -I${CMAKE_SOURCE_DIR}/src
  -o ${CMAKE_CURRENT_BINARY_DIR}/image/tonemap_twice.spv ${CMAKE_CURRENT_BINARY_DIR}/image/tonemap_twice.comp)
set_tests_properties(image.tonemap_glsl PROPERTIES LABELS image)
