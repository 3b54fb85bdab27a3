// Octahedral encoding of unit vectors in −1…1 squared (Cigolle et al. 2014, "A Survey of Efficient
// Representations for Independent Unit Vectors", oct). C twin: octahedral.h.
#ifndef AG_FRAME_OCTAHEDRAL_GLSL
#define AG_FRAME_OCTAHEDRAL_GLSL

vec2 octahedral_encode(vec3 n)
{
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 folded = (1.0 - abs(p.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
    return n.z < 0.0 ? folded : p;
}

// The direction of a point of the map, of any length.
vec3 octahedral_direction(vec2 e)
{
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float below = max(-n.z, 0.0);
    n.xy -= mix(vec2(-below), vec2(below), greaterThanEqual(n.xy, vec2(0.0)));
    return n;
}

vec3 octahedral_decode(vec2 e)
{
    return normalize(octahedral_direction(e));
}

#endif
