// Procedural textures of the built-in scenes: a painter gives colour and height at a point, from
// which a colour image and a normal map are computed. All repeat without a seam.
#pragma once

#include "scene/scene.h"

// Colour is linear, 0…1; height is a fraction of the texture's width.
struct paint {
    vec3s colour;
    float height;
};

// u to the right and v down, in 0…1; must repeat with period 1.
typedef struct paint (*painter)(float u, float v);

struct paint paint_bricks(float u, float v);  // 2 × 4 stones, courses shifted by half a stone
struct paint paint_tiles(float u, float v);   // 2 × 2 floor tiles, a chequerboard
struct paint paint_stone(float u, float v);   // fine-grained limestone
struct paint paint_cloth(float u, float v);   // white weave with a darker band
struct paint paint_wood(float u, float v);    // four planks
struct paint paint_plaster(float u, float v); // slightly uneven whitewash

// A material with such textures of size × size texels, repeated every `period_m` metres; `tint`
// multiplies the colour. -1 on failure.
struct painted {
    const char *name;
    painter paint;
    float period_m;
    vec3s tint;
    float roughness;
};
int builtin_painted(struct scene *scene, const struct painted *painted, int size);
