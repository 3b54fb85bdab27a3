// Bakes of prt without a GPU: a scene by code, the charts of its light map, and the irradiance of
// texels by the transfer vectors of its bake.
//
//     struct prt_fixture f;
//     prt_fixture_init(&f);
//     fixture_floor(&f.s, 2, fixture_matte(&f.s, white));
//     prt_fixture_open(&f, "texels=512,rays=256");
//     struct prt_baked baked = prt_fixture_bake(&f, "transfer=shadowed", 0);
//     prt_irradiance(&baked, texel, &light, e);
//     prt_baked_finish(&baked);
//     prt_fixture_close(&f);
#pragma once

#include "frame/frame_fixture.h"
#include "scene/statics.h"
#include "techniques/gi_bake.h"
#include "techniques/gi_spec.h"
#include "techniques/prt/prt_shared.h"
#include "techniques/prt/prt_tensors.h"

struct prt_fixture {
    struct frame_fixture s; // its scene and pose alone
    const char *options;
    struct scene_statics statics;
    struct charts charts;
};

void prt_fixture_init(struct prt_fixture *f);
// A purely diffuse material.
int prt_fixture_diffuse(struct prt_fixture *f, float albedo);
// A sphere of facets: rings × 2 · rings quads in angles, of which the first `open` rings around +y
// are left out. inwards: normals point to its centre.
void prt_fixture_sphere(struct prt_fixture *f, vec3s center, float radius, int rings, int open,
                        bool inwards, int material);
// y = 0, facing up, from −half to half: steps × steps quads of shared vertices.
void prt_fixture_grid(struct prt_fixture *f, float half, int steps, int material);
// A regular polygon of 64 corners with the area of a disk of this radius, facing down.
void prt_fixture_disk(struct prt_fixture *f, vec3s center, float radius, int material);
// A scene made in f->s. options: without spaces; outlive the fixture.
void prt_fixture_open(struct prt_fixture *f, const char *options);
void prt_fixture_close(struct prt_fixture *f);

struct prt_baked {
    struct bake *bake;
    const struct tensors *tensors; // of a bake that has run
};
// Plans a bake with more options. It runs, or is run later.
struct bake *prt_fixture_plan(const struct prt_fixture *f, const char *more, uint64_t seed);
struct prt_baked prt_fixture_bake(const struct prt_fixture *f, const char *more, uint64_t seed);
void prt_baked_finish(struct prt_baked *baked);

// Whether a texel is not inside geometry.
bool prt_is_open(const struct prt_baked *baked, uint32_t texel);
// Coefficient k of the transfer of a texel: direct, and by colour of all bounces.
vec4s prt_coefficient(const struct prt_baked *baked, uint32_t texel, size_t k);
// E = Σ T_k L_k, by colour.
void prt_irradiance(const struct prt_baked *baked, uint32_t texel, const struct prt_light *light,
                    float out[3]);
// With `glossy`: the radiance that a texel reflects, over the albedo of its lobe.
void prt_reflected(const struct prt_baked *baked, uint32_t texel, const struct prt_light *light,
                   vec3s to_viewer, float out[3]);
// Distant light of radiance 1 from all directions; of random coefficients in [−1, 1].
void prt_uniform_light(struct prt_light *out);
void prt_random_light(uint32_t seed, struct prt_light *out);
