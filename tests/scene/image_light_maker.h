// glTF files with an image-based light, whose faces are PNG images in the buffer.
#pragma once

#include "scene/gltf_maker.h"

#include "image/png_file.h"

enum { MADE_FACES = 6, MADE_MAX_BYTES = 1 << 16 };

struct made_faces {
    uint8_t bytes[MADE_MAX_BYTES];
    size_t size, offset[MADE_FACES], length[MADE_FACES];
};

static inline void add_face(struct made_faces *made, int face, const uint8_t *rgba, int width,
                            int height)
{
    uint8_t *png = NULL;
    size_t size = 0;
    CHECK(png_encode(test_host(), rgba, width, height, &png, &size));
    CHECK(made->size + size <= MADE_MAX_BYTES);
    memcpy(made->bytes + made->size, png, size);
    made->offset[face] = made->size;
    made->length[face] = size;
    made->size += size;
    host_free(test_host(), png);
}

// light: members of the light, which follow its specularImages. The text is owned by the caller.
static inline char *light_json(const struct made_faces *made, const char *images, const char *light)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    CHECK(out);
    fprintf(out,
            "{" ASSET ",'extensionsUsed':['EXT_lights_image_based'],"
            "'extensionsRequired':['EXT_lights_image_based'],"
            "'extensions':{'EXT_lights_image_based':{'lights':[{'specularImages':%s%s}]}},"
            "'scenes':[{'extensions':{'EXT_lights_image_based':{'light':0}}}],"
            "'buffers':[{'uri':'made.bin','byteLength':%zu}],'bufferViews':[",
            images, light, made->size);
    for (int i = 0; i < MADE_FACES; i++)
        fprintf(out, "%s{'buffer':0,'byteOffset':%zu,'byteLength':%zu}", i ? "," : "",
                made->offset[i], made->length[i]);
    fprintf(out, "],'images':[");
    for (int i = 0; i < MADE_FACES; i++)
        fprintf(out, "%s{'bufferView':%d,'mimeType':'image/png'}", i ? "," : "", i);
    fprintf(out, "]}");
    CHECK(fclose(out) == 0);
    return text;
}

#define ALL_FACES "[[0,1,2,3,4,5]]"

static inline struct scene *load_light(const struct made_faces *made, const char *images,
                                       const char *light)
{
    char *json = light_json(made, images, light);
    struct scene *scene = load_gltf(json, made->bytes, made->size);
    free(json);
    return scene;
}

// 8 x 8 texels: red tells the face, green the right half, blue the lower half.
static inline void quadrants(struct made_faces *made, uint8_t alpha)
{
    enum { SIZE = 8 };
    uint8_t rgba[SIZE * SIZE][4];
    for (int face = 0; face < MADE_FACES; face++) {
        for (int i = 0; i < SIZE * SIZE; i++) {
            rgba[i][0] = (uint8_t)(40 * (face + 1));
            rgba[i][1] = i % SIZE < SIZE / 2 ? 60 : 200;
            rgba[i][2] = i / SIZE < SIZE / 2 ? 80 : 220;
            rgba[i][3] = alpha;
        }
        add_face(made, face, rgba[0], SIZE, SIZE);
    }
}
