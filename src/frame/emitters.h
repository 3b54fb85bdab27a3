// Emissive surfaces as virtual point lights, for techniques that gather their light (as Martin 2012
// does for its Cornell box) and for automatic exposure. CPU only, deterministic.
//
// A point of flux Φ and normal n radiates Φ/π (n·ω)₊ lm/sr. A triangle of area A and mean radiance
// L̄ emits π L̄ A lumen from its front side, and the same from its back side if the material is
// double-sided. The points of a side share its flux in proportion to the emissive map around each
// of them, so the total flux is exact for any number of points.
//
// Points are allocated by a mixture of two measures that do not depend on tessellation: half by
// flux, so that each side with 2/EMITTERS_MAX of the total flux gets a point however small it is;
// half by √(flux · area), so that wide surfaces are covered evenly however dim. The flux of sides
// without a point is added to the next point of the list.
#pragma once

#include "frame/frame.h"

#define EMITTERS_MAX 4096

struct emitters {
    struct host *host;
    const struct scene *scene;
    struct emission_maps *maps; // [map_count], by material, private to emitters.c
    int map_count;
    struct emitter_instance *instances; // [instance_count], emissive instances
    int instance_count;
    struct emitter_triangle *triangles;   // of all emissive instances in order
    struct frame_emitter *points;         // [EMITTERS_MAX], lumen
    struct frame_emitter *scaled;         // [EMITTERS_MAX], scaled lumen, see emitters_scale
    struct frame_emitter_origin *origins; // [EMITTERS_MAX]
    int count;
    vec3s flux;        // of all points, lumen
    uint64_t revision; // of the scene
};

// The scene must outlive this. On failure (false) call emitters_finish.
bool emitters_init(struct emitters *out, struct host *host, const struct scene *scene);
void emitters_finish(struct emitters *emitters); // accepts zero
// Adapts to changes of the scene, before emitters_update; allocates where they concern emissive
// surfaces. false: out of memory; call it again before the next frame.
bool emitters_follow(struct emitters *emitters);

// Updates the points for a pose. Allocates nothing; does nothing while no emissive instance moves.
void emitters_update(struct emitters *emitters, const struct scene_pose *pose);
// Fills `scaled` with the points as shaders read them: flux × radiance_scale.
void emitters_scale(struct emitters *emitters, float radiance_scale);

// Mean irradiance in lux, over all positions and orientations in the box `bounds`, by unoccluded
// light of the emitters. The mean path length from a point to the box is ℓ̄ = ⅔ d, d the distance
// along its normal (for a cube's wall, Cauchy's mean chord length 4V/S = ⅔ of the edge). Flux Φ
// over a path ℓ̄ has the mean fluence rate Φ ℓ̄/V, a quarter of which is irradiance: E = Σ Φ ℓ̄ /
// (4V). In a closed cube with emissive walls that is Φ/S. 0 if the box has no volume.
vec3s emitters_irradiance(const struct emitters *emitters, struct box3 bounds);
