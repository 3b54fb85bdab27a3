// Painted textures of the built-in scenes: a function of the place gives colour and height, from
// which an image and, by its slopes, a normal map are made. All of them repeat without a seam.
#pragma once

#include "scene/scene.h"

// What a painter says about a place. Colour is linear, 0…1; height in parts of the texture's width.
struct paint {
    vec3s colour;
    float height;
};

// u to the right and v down, in 0…1; must repeat with period 1.
typedef struct paint (*painter)(float u, float v);

struct paint paint_bricks(float u,
                          float v); // 2 × 4 dressed stones, courses shifted by half a stone
struct paint paint_tiles(float u, float v);   // 2 × 2 floor tiles, light and dark in turn
struct paint paint_stone(float u, float v);   // fine-grained limestone
struct paint paint_cloth(float u, float v);   // white weave with a darker band, to be tinted
struct paint paint_wood(float u, float v);    // four planks
struct paint paint_plaster(float u, float v); // whitewash, faintly uneven

// A material with such textures, size × size texels that repeat every `period_m` metres: `tint`
// multiplies the colour. -1 on failure.
struct painted {
    const char *name;
    painter paint;
    float period_m;
    vec3s tint;
    float roughness;
};
int builtin_painted(struct scene *scene, const struct painted *painted, int size);
