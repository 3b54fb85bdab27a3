// An image of the light that arrives from all directions: equirectangular, without its sun, which
// is a directional light. It never changes after its creation, so that scenes and their copies
// share it.
#pragma once

#include "core/sh.h"
#include "image/image.h"
#include "scene/environment/find_sun.h"
#include "scene/environment/sun_sky.h"

#include <stdatomic.h>

// Wider images are averaged to this width.
#define ENVIRONMENT_MAX_WIDTH 4096

struct environment_map {
    struct host *host;
    const char *name;           // of the file, for messages
    uint64_t key;               // hash of the content
    struct image radiance;      // cd/m², 3 channels, finite, ≥ 0, without the sun
    struct image coarse;        // the same, averaged over texels of 5.6°
    struct environment_sun sun; // in the map's space
    float sh_error[4];          // of 2 to 5 bands: RMS of the difference over that of the radiance
    float sh[3][SH_MAX_COUNT];  // of the radiance, in the map's space
    float peak;                 // largest value
    atomic_int users;
};

// Reads .hdr and .exr files. With one user; NULL on failure.
struct environment_map *environment_map_load(struct host *host, const char *path);
// From an image of 1 or 3 channels or more, cd/m². Values that are negative or not finite become 0,
// with a warning.
struct environment_map *environment_map_create(struct host *host, const char *name,
                                               const struct image *equirectangular);
// The same from the image and the sun of another map, unchanged. The image is at most
// ENVIRONMENT_MAX_WIDTH wide.
struct environment_map *environment_map_restore(struct host *host, const char *name,
                                                const struct image *radiance,
                                                const struct environment_sun *sun);
// A clear sky with its sun.
struct environment_map *environment_map_of_sky(struct host *host, const struct sun_sky *sky);
void environment_map_retain(const struct environment_map *map);  // accepts NULL
void environment_map_release(const struct environment_map *map); // accepts NULL
// Moves a use to another host with the same memory, which the map then needs instead of its own:
// the same map where there is no other use, else a copy. NULL, and nothing has changed: no memory.
const struct environment_map *environment_map_move(const struct environment_map *map,
                                                   struct host *host);

// The largest value of the image and the sun.
float environment_map_strongest(const struct environment_map *map);

// Interpolated linearly; direction: unit, in the map's space.
vec3s environment_map_radiance(const struct environment_map *map, vec3s direction);
vec3s environment_map_coarse(const struct environment_map *map, vec3s direction);
