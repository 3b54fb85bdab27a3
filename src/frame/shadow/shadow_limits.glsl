// Limits of the shadow test of shadow_resolved.glsl.
#ifndef AG_FRAME_SHADOW_LIMITS_GLSL
#define AG_FRAME_SHADOW_LIMITS_GLSL

// Covers the rounding of vertices to 1/256 of a texel or pixel.
const float SHADOW_TOLERANCE = 1.0 / 16.0; // texels
// Covers the curvature of a surface between texels, in texels along the surface. Only where the
// map shows a surface parallel to the receiver's: a wall below the edge of a roof is in shadow.
const float SHADOW_SLOPE_TOLERANCE = 1.0 / 4.0;
const float SHADOW_PARALLEL = 0.7; // cosine of normals

#endif
