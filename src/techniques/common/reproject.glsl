// Where a pixel's surface was in the last frame's picture, whatever moved, for what goes on from it
// (reverse reprojection). `motion` is a texel of FRAME_MOTION. Which of the four pixels about the
// place show that surface, too, the caller decides: each has its own history.
#ifndef AG_REPROJECT_GLSL
#define AG_REPROJECT_GLSL

// Pixels, whose centres are whole numbers; a picture's size away where it was behind the eye.
vec2 reproject_place(vec4 motion, ivec2 pixel, vec2 size)
{
    return vec2(pixel) - motion.xy * size;
}

// Along that frame's view axis, of what is at distance_m along this one's; 0 where it was behind
// the eye.
float reproject_distance(vec4 motion, float distance_m)
{
    return distance_m * (1.0 + motion.z);
}

// Number i of the four pixels about a place.
ivec2 reproject_tap(vec2 place, int i)
{
    return ivec2(floor(place)) + ivec2(i & 1, i >> 1);
}

// Its share in the value between them.
float reproject_share(vec2 place, int i)
{
    vec2 between = fract(place);
    vec2 share = mix(1.0 - between, between, equal(ivec2(i & 1, i >> 1), ivec2(1)));
    return share.x * share.y;
}

#endif
