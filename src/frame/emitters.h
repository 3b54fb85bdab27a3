// Emissive surfaces as virtual lights: points on all emissive triangles of a moment, for techniques
// that gather the light of emission (Martin 2012 lights its Cornell box so) and for automatic
// exposure. Pure CPU, deterministic.
//
// A point of flux Φ and normal n radiates Φ/π (n·ω)₊ lm/sr. A triangle of area A and mean radiance
// L̄ emits π L̄ A lumen from its front, and as much from its back where its material is double-sided.
// The points of a side share its flux in proportion to what the emissive map holds around each of
// them, so the total is that of the surfaces whatever their number.
//
// The points are handed out by a mixture of two measures, both independent of how finely a mesh is
// cut: half by flux, so that every side with 2/EMITTERS_MAX of all flux has a point of its own
// however small it is, half by √(flux · area), so that a wide surface is covered evenly however
// dim. The flux of sides too weak for one goes to the next point of the list.
#pragma once

#include "frame/frame_shared.h"
#include "scene/pose.h"

#define EMITTERS_MAX 4096

struct emitters {
    struct host *host;
    const struct scene *scene;
    struct emission_maps *maps;         // [material_count]: emitters.c's own
    struct emitter_instance *instances; // [instance_count]: the emissive ones
    int instance_count;
    struct emitter_triangle *triangles; // of all of them, one after the other
    struct frame_emitter *points;       // [EMITTERS_MAX], lumen
    struct frame_emitter *scaled;       // [EMITTERS_MAX], scaled lumen, see emitters_scale
    int count;
    vec3s flux; // of all points, lumen
};

// The scene must outlive this. False after a failure; emitters_finish accepts the half-built rest.
bool emitters_init(struct emitters *out, struct host *host, const struct scene *scene);
void emitters_finish(struct emitters *emitters); // accepts zero

// Brings the points to a moment of the scene. Allocates nothing; does nothing while no emissive
// instance moves.
void emitters_update(struct emitters *emitters, const struct scene_pose *pose);
// Fills `scaled` with the points as shaders read them: flux × radiance_scale.
void emitters_scale(struct emitters *emitters, float radiance_scale);

// Mean irradiance in lux of surfaces of any orientation in the box `bounds`, by the light of
// emission on its straight way out: a point's light goes ℓ̄ = ⅔ d on average, d its distance to the
// box along the normal (a cube's wall: Cauchy's mean chord 4V/S = ⅔ of the edge), and light of flux
// Φ on a way ℓ̄ has the mean fluence rate Φ ℓ̄/V, a quarter of which is irradiance: E = Σ Φ ℓ̄ / (4V).
// In a closed cube with emissive walls that is Φ/S. 0 where the box has no volume.
vec3s emitters_irradiance(const struct emitters *emitters, struct box3 bounds);
