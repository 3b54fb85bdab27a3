// A small scene and a reference of it, for tests that know what it must look like.
#pragma once

#include "framework/test.h"
#include "trace/trace.h"

struct stage {
    struct scene *scene;
    struct scene_pose pose;
    struct world_camera camera;
    struct reference_options options;
    int width, height, samples;
};

// An empty scene, a camera at the origin looking along −z, 16 × 16 pixels, diffuse surfaces.
void stage_init(struct stage *s);
void stage_builtin(struct stage *s, const char *name);
void stage_finish(struct stage *s);

int stage_matte(struct stage *s, vec3s albedo, vec3s emission);
int stage_material(struct stage *s, const struct material *material);
// Corners counter-clockwise from the front; uv (0,1) (1,1) (1,0) (0,0).
void stage_quad(struct stage *s, vec3s a, vec3s b, vec3s c, vec3s d, int material);
// A regular polygon around `centre`, facing along `normal`, of this area.
void stage_disk(struct stage *s, vec3s centre, vec3s normal, float area_m2, int corners,
                int material);
// A cube around the origin whose faces look inwards.
void stage_room(struct stage *s, float half, int material);
void stage_light(struct stage *s, enum light_type type, vec3s position, vec3s direction,
                 vec3s intensity);
void stage_look(struct stage *s, vec3s eye, vec3s target, float fov_rad);

struct reference *stage_reference(struct stage *s);
// A picture of `samples` samples: the mean of a layer over all pixels, and the standard error of
// the colour's.
struct stage_mean {
    double mean[3], error;
};
struct stage_mean stage_mean(struct stage *s, enum reference_layer layer);
struct image stage_layer(struct stage *s, enum reference_layer layer);
double image_mean(const struct image *image, int channel);
