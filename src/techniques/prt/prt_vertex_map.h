// Light at vertices on the GPU, in place of a light map: pixels find their triangle, and weigh the
// light of its corners.
#pragma once

#include "techniques/common/light_map/map.h"
#include "techniques/prt/receivers/vertices.h"

struct frame_view;

struct prt_vertex_map {
    struct host *host;
    struct gpu *gpu;
    const struct prt_vertices *vertices;
    struct light_map_surfaces surfaces; // a place is the weights of the second and third corner
    bool emits;                         // some vertex has light of emissive surfaces
    gpu_image corners;                  // [side][triangle] vertices whose light a triangle shows
    gpu_image light;                    // [part][vertex], the newest
    gpu_pipeline apply[2][2];           // [with moves][whether there is FRAME_DIELECTRIC]
    struct light_map_columns columns;
};

// vertices: stay where they are.
void prt_vertex_map_init(struct prt_vertex_map *out, struct host *host, struct gpu *gpu,
                         const struct prt_vertices *vertices);
// Adds the objects of a map with vertices at this offset of the state. The constants 0 …
// LIGHT_MAP_CONSTANTS − 1 of the table are those of a light map; this one is set too.
enum { PRT_HAS_EMITTED_AT = LIGHT_MAP_CONSTANTS + 3 };
void prt_vertex_map_list(const struct prt_vertex_map *map, size_t base, bool specular,
                         struct gpu_objects *out);
// instances: of the scene. nearest_valid: [vertices]. emitted: [vertices][3][4]
// irradiance and vector irradiance of emissive surfaces. table: of the normals and that light.
bool prt_vertex_map_upload(struct prt_vertex_map *map, uint32_t instances,
                           const uint32_t *nearest_valid, const float *emitted, gpu_image *table);
// Irradiance and specular light of a view's pixels. Needs FRAME_ID.
void prt_vertex_map_record_apply(const struct prt_vertex_map *map, struct gpu_cmd *cmd,
                                 const struct frame_view *view);
