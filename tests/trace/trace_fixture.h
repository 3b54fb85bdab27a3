// Fixture: a small scene and its reference.
#pragma once

#include "framework/test.h"
#include "trace/trace.h"

struct trace_fixture {
    struct scene *scene;
    struct scene_pose pose;
    struct world_camera camera;
    struct reference_options options;
    int width, height, samples;
};

// An empty scene, a camera at the origin looking along −z, 16 × 16 pixels, no specular lobe.
void fixture_init(struct trace_fixture *s);
void fixture_builtin(struct trace_fixture *s, const char *name);
void fixture_finish(struct trace_fixture *s);

int fixture_diffuse(struct trace_fixture *s, vec3s albedo, vec3s emission);
int fixture_material(struct trace_fixture *s, const struct material *material);
// Corners counter-clockwise from the front; uv (0,1) (1,1) (1,0) (0,0).
void fixture_quad(struct trace_fixture *s, vec3s a, vec3s b, vec3s c, vec3s d, int material);
// A regular polygon with this centre, normal and area.
void fixture_disk(struct trace_fixture *s, vec3s centre, vec3s normal, float area_m2, int corners,
                  int material);
// A cube around the origin, faces inwards.
void fixture_room(struct trace_fixture *s, float half, int material);
void fixture_light(struct trace_fixture *s, enum light_type type, vec3s position, vec3s direction,
                   vec3s intensity);
void fixture_aim_camera(struct trace_fixture *s, vec3s position, vec3s target, float fov_rad);

struct reference *fixture_reference(struct trace_fixture *s);
// The mean of a layer over all pixels after `samples` samples, and the standard error of the mean
// of REFERENCE_COLOR.
struct layer_mean {
    double mean[3], error;
};
struct layer_mean fixture_mean(struct trace_fixture *s, enum reference_layer layer);
struct image fixture_layer(struct trace_fixture *s, enum reference_layer layer);
double image_mean(const struct image *image, int channel);
