// Writes small glTF files for tests: JSON with ' in place of ", and a buffer "made.bin".
#pragma once

#include "framework/test.h"

#include "scene/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ASSET "'asset':{'version':'2.0'}"
// 2 x 2 texels: red, green; blue, transparent white.
#define PNG_2X2                                                                                    \
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAYAAABytg0kAAAAE0lE"                   \
    "QVR42mP4z8DwHwyBNAgwAABIyQj4xTT9BQAAAABJRU5ErkJggg=="

static inline void write_bytes(const char *name, const void *data, size_t size)
{
    FILE *file = fopen(test_path(name), "wb");
    CHECK(file);
    CHECK(size == 0 || fwrite(data, 1, size, file) == size);
    CHECK(fclose(file) == 0);
}

static inline char *json_of(const char *text)
{
    char *json = strdup(text);
    CHECK(json);
    for (char *c = json; *c; c++) {
        if (*c == '\'') *c = '"';
    }
    return json;
}

// Writes made.gltf and made.bin and loads them.
static inline struct scene *load_gltf(const char *text, const void *buffer, size_t size)
{
    char *json = json_of(text);
    write_bytes("made.gltf", json, strlen(json));
    if (buffer) write_bytes("made.bin", buffer, size);
    free(json);
    test_forget_messages();
    return scene_load(test_host(), test_path("made.gltf"));
}

// A GLB of the JSON and the buffer, owned by the caller.
static inline uint8_t *make_glb(const char *text, const void *buffer, size_t size, size_t *glb_size)
{
    char *json = json_of(text);
    size_t json_size = (strlen(json) + 3) & ~(size_t)3, bin_size = (size + 3) & ~(size_t)3;
    size_t total = 12 + 8 + json_size + 8 + bin_size;
    uint8_t *glb = calloc(total, 1);
    CHECK(glb);
    uint32_t head[5] = { 0x46546c67, 2, (uint32_t)total, (uint32_t)json_size, 0x4e4f534a };
    uint32_t chunk[2] = { (uint32_t)bin_size, 0x004e4942 };
    memcpy(glb, head, sizeof head);
    memset(glb + 20, ' ', json_size);
    memcpy(glb + 20, json, strlen(json));
    memcpy(glb + 20 + json_size, chunk, sizeof chunk);
    memcpy(glb + 28 + json_size, buffer, size);
    free(json);
    *glb_size = total;
    return glb;
}
