// The closing of seams: places of the light map beside seams show weighted sums of texels.
#pragma once

#include "techniques/radiosity/bake/gather.h"
#include "techniques/radiosity/radiosity_seams.h"

struct bake_plan;

// radiosity_closing_finish accepts zero.
struct radiosity_closing {
    struct host *host;
    const struct radiosity_map *map;
    struct radiosity_seams seams; // without points that a wall divides
    uint32_t *first;              // [places + 1] of the place, in `points`
    uint32_t *points;             // those at each place
};
bool radiosity_closing_init(struct radiosity_closing *out, const struct radiosity_scene *scene);
void radiosity_closing_finish(struct radiosity_closing *closing);

// What a task needs. radiosity_closing_room_finish accepts zero.
struct radiosity_closing_room {
    struct host *host;
    uint32_t *local;       // [places] number in `place`, from 1; all 0 between the calls
    bool *has;             // [points] it is in `point`; likewise
    uint32_t *place;       // near ones, the nearest first
    uint32_t *point;       // [points] those at near places
    double *x, *r, *d, *q; // of the conjugate gradients
};
bool radiosity_closing_room_init(struct radiosity_closing_room *room, struct host *host,
                                 const struct radiosity_closing *closing);
void radiosity_closing_room_finish(struct radiosity_closing_room *room);

struct radiosity_closing_entry {
    uint32_t texel;
    float weight;
};
// Weights of a place, which sum to 1; unused entries have weight 0.
void radiosity_close(const struct radiosity_closing *closing, struct radiosity_closing_room *room,
                     uint32_t place, struct radiosity_closing_entry out[RADIOSITY_SEAM_ENTRIES]);

// ---- seams.c

// places: of the seams.
bool radiosity_add_seams(struct bake_plan *plan, const struct radiosity_closing *closing,
                         uint32_t places);
