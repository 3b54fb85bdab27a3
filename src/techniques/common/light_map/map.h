// A light map on the GPU, from the light of texels (table.glsl) to pixels: places show the light of
// texels, those beside seams weighted sums, and pixels look it up.
#pragma once

#include "techniques/common/light_map/columns.h"
#include "techniques/common/light_map/surface.h"
#include "techniques/common/light_map/table.h"

struct frame_view;
struct tensors;

// How pixels get specular light.
enum light_map_specular {
    LIGHT_MAP_DIFFUSE,    // none
    LIGHT_MAP_SPECULAR,   // of the map's light, and of the visible environment
    LIGHT_MAP_BY_FLUENCE, // as LIGHT_MAP_SPECULAR, of light whose fluence the map has, too
    LIGHT_MAP_REFLECTED,  // that of texels, light_map_record_reflected
};

struct light_map {
    struct host *host;
    struct gpu *gpu;
    const struct charts *charts; // stay where they are
    enum light_map_specular specular;
    struct light_map_surfaces surfaces;
    gpu_image owners;                 // places and their nearest valid texels
    gpu_image seam_places, seam_rows; // places beside seams and their sums
    uint32_t owner_count, seam_count; // of places
    gpu_image walls;                  // lookups beside walls, of texels (map_shared.h)
    gpu_image visible_sky;            // with LIGHT_MAP_SPECULAR (visible_sky.h)
    gpu_image images[2];              // a map appears whole: one is looked up, one is written
    gpu_image fluence[2];             // of both with LIGHT_MAP_BY_FLUENCE
    int front;                        // the image that lookups read
    gpu_image reflected;              // with LIGHT_MAP_REFLECTED, of the newest view
    gpu_sampler linear;
    gpu_pipeline show, seams, checker;
    gpu_pipeline apply[2][2]; // [with moves][whether there is FRAME_DIELECTRIC]
    gpu_pipeline mirror[2];   // of `apply` if `specular`, and with the environment's map
    struct light_map_columns columns;
};

// charts: may be empty yet; made before the other functions are called.
void light_map_init(struct light_map *out, struct host *host, struct gpu *gpu,
                    const struct charts *charts, enum light_map_specular specular);
// Adds the objects of a map at this offset of the state, none of an empty scene but the sampler.
// The constants 0 … LIGHT_MAP_CONSTANTS − 1 of the table are the map's.
enum { LIGHT_MAP_CONSTANTS = 8 };
void light_map_list(const struct light_map *map, size_t base, struct gpu_objects *out);
// Tables of the charts and of the seams of a bake, which is untrusted. instances: of the scene.
// nearest_valid: [side_texel_count] as of charts_fill. sky: [side_texel_count][4] visible sky of a
// texel, as struct light_map_texels has it.
bool light_map_upload(struct light_map *map, uint32_t instances, const uint32_t *nearest_valid,
                      const float *sky, const struct tensors *bake);
// Approximate bytes on the GPU of a map; texels: of both sides.
uint64_t light_map_bytes(uint64_t texels);

// Light of texels, [colour][texel], and fluence by colour, [texel], if the map has it.
struct light_map_tables {
    gpu_image light, fluence;
};
// Writes rows first … first + count − 1, of owner_count and seam_count, of the back image. Seams
// overwrite their places.
void light_map_record_show(const struct light_map *map, struct gpu_cmd *cmd,
                           struct light_map_tables from, uint32_t first, uint32_t count);
void light_map_record_seams(const struct light_map *map, struct gpu_cmd *cmd,
                            struct light_map_tables from, uint32_t first, uint32_t count);
// Writes the whole map in a scope, with or without closed seams, and swaps the images.
void light_map_record_all(struct light_map *map, struct gpu_cmd *cmd, gpu_image light, bool seams);
// The radiance that the specular lobes of texels reflect towards a view. light: [texel], four
// halves each.
void light_map_record_reflected(const struct light_map *map, struct gpu_cmd *cmd, gpu_image light,
                                bool seams);
// Irradiance and specular light of a view's pixels, from the front image. Needs FRAME_ID.
void light_map_record_apply(const struct light_map *map, struct gpu_cmd *cmd,
                            const struct frame_view *view);
// A debug view of techniques with a light map. `out`: as in struct technique.
#define LIGHT_MAP_TEXELS_VIEW      "texels"
#define LIGHT_MAP_TEXELS_VIEW_HELP "a checkerboard of the light map's texels"
void light_map_record_texels_view(const struct light_map *map, struct gpu_cmd *cmd,
                                  const struct frame_view *view, gpu_image out);
