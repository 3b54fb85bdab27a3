// A record of a light map by paths, for a later update: the light of its texels, and hashes of the
// scene that it was baked for. A file beside the maps.
#pragma once

#include "lightmap/lightmap.h"

#define LIGHTMAP_RECORD_FILE "bake.safetensors"

// An instance of the scene in world space. triangles 0: it is dynamic or removed.
struct record_instance {
    struct hash128 shape, surface; // surface: attributes of vertices, and the material
    uint32_t triangles;
    struct box3 bounds;
};

struct record_chart {
    struct hash128 key; // of its triangles' instances, and which triangles of these
    uint32_t width, height, first_texel, texel_count, first_back;
};

struct record_place {
    uint16_t x, y; // in the chart's own frame
};

struct lightmap_record {
    struct host *host;
    char *options; // of the bake's identity, "texels=65536,…,samples=256"
    int version;   // likewise
    uint64_t seed;
    float texels_per_m;
    struct charts_search search; // of the charts
    uint64_t environment;        // environment_key
    struct record_instance *instances;
    uint32_t instance_count;
    struct world_light *lights; // those that are on
    uint32_t light_count;
    struct record_chart *charts;
    uint32_t chart_count;
    struct record_place *places; // [texel_count] of the texels of one side
    uint32_t texel_count;
    float *rest; // [row_count][LIGHTMAP_COLUMNS] LIGHTMAP_REST; NULL: the record describes a scene
                 // alone
    uint32_t row_count;
    struct hash128 content; // of a record that was read
};

// The record of a scene; charts NULL: without charts. Copies `rest` (may be NULL).
// lightmap_record_finish accepts zero.
bool lightmap_record_init(struct lightmap_record *out, struct host *host,
                          const struct scene_pose *statics, const struct charts *charts,
                          const float *rest);
void lightmap_record_finish(struct lightmap_record *record);
bool lightmap_record_add_charts(struct lightmap_record *record, const struct charts *charts);

bool lightmap_record_write(const struct lightmap_record *record, const char *path);
// Reads a file, untrusted. FAIL_FILE, FAIL_FORMAT: one sentence, and *out is zero.
bool lightmap_record_read(struct lightmap_record *out, struct host *host, const char *path);
