// Reverse reprojection: position and distance of a pixel's surface in the previous frame. `motion`
// is a texel of FRAME_MOTION. The caller decides which of the four pixels around that position show
// the same surface.
#ifndef AG_REPROJECT_GLSL
#define AG_REPROJECT_GLSL

// In pixels, with the points that the previous frame sampled at whole numbers; outside the image if
// the surface was behind the camera. jitter_step: of frame_constants, since motion excludes jitter.
vec2 reproject_place(vec4 motion, ivec2 pixel, vec2 size, vec2 jitter_step)
{
    return vec2(pixel) - motion.xy * size + jitter_step;
}

// Distance along the previous view axis of a point at distance_m along the current one; 0: it was
// behind the camera.
float reproject_distance(vec4 motion, float distance_m)
{
    return distance_m * (1.0 + motion.z);
}

// The i-th of the four pixels around the position.
ivec2 reproject_tap(vec2 place, int i)
{
    return ivec2(floor(place)) + ivec2(i & 1, i >> 1);
}

// Its bilinear weight.
float reproject_share(vec2 place, int i)
{
    vec2 between = fract(place);
    vec2 share = mix(1.0 - between, between, equal(ivec2(i & 1, i >> 1), ivec2(1)));
    return share.x * share.y;
}

#endif
