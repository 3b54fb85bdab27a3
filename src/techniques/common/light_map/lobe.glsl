// Directions of specular lobes.
#ifndef AG_LIGHT_MAP_LOBE_GLSL
#define AG_LIGHT_MAP_LOBE_GLSL

// How far the mean direction of the lobe leans, over the mirror direction's. A fit within 0.04 from
// n·v = 0.25 on.
float lobe_lean(float alpha)
{
    return (1.0 - alpha) / (1.0 + 1.2 * alpha * alpha);
}

#endif
