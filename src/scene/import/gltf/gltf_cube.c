// The cube map of an image-based light (EXT_lights_image_based): its largest mip level. A cube that
// cannot be decoded is noted, like textures.
#include "scene/import/gltf/gltf.h"

#include "scene/environment/cube_map.h"
#include "scene/environment/environment_map.h"
#include "scene/images/image_decode.h"
#include "scene/import/import_files.h"
#include "scene/import/import_image.h"

struct cube_files {
    struct import_files files;
    struct image_source sources[CUBE_FACES];
    void *owned[CUBE_FACES]; // bytes of data URIs
    uint8_t *texels;         // [CUBE_FACES][size][size][4]
    struct cube_map cube;
};

static void finish(struct host *host, struct cube_files *c)
{
    for (int i = 0; i < CUBE_FACES; i++) host_free(host, c->owned[i]);
    import_files_finish(&c->files);
    host_free(host, c->texels);
}

// Fails with messages of invalid glTF.
static bool find_faces(struct gltf *gltf, struct gltf_object light, struct cube_files *c)
{
    static const char KEY[] = "specularImages";
    json_t *faces = json_array_get(gltf_array(light, KEY), 0);
    if (json_array_size(faces) != CUBE_FACES)
        return gltf_wrong(light, "%s[0] is not an array of six images", KEY);
    for (int i = 0; i < CUBE_FACES; i++) {
        const int image =
            gltf_index_value(light, KEY, json_array_get(faces, (size_t)i), gltf->images);
        if (image < 0 ||
            !gltf_find_image(gltf, (size_t)image, &c->files, &c->sources[i], &c->owned[i]))
            return false;
    }
    return true;
}

// NULL, or why the face has no size. The cube gets the size of its first face.
static const char *find_size(struct cube_files *c, int face, char why[DECODE_WHY_SIZE])
{
    const struct image_source *source = &c->sources[face];
    int width, height;
    if (!source->data) return "no such file";
    const enum image_kind kind = image_kind_of(source->data, source->size);
    if (kind != IMAGE_JPEG && kind != IMAGE_PNG) return "neither JPEG nor PNG";
    const char *problem = image_decode_size(source->data, source->size, &width, &height, why);
    if (problem) return problem[0] ? problem : "it cannot be decoded";
    if (width != height) return "it is not square";
    if (face == 0) c->cube.size = width;
    return width == c->cube.size ? NULL : "its size is not that of the first face";
}

static bool note(struct gltf *gltf, int face, const char *problem)
{
    static const char *const names[CUBE_FACES] = { "+X", "-X", "+Y", "-Y", "+Z", "-Z" };
    import_note(gltf->import, "image-based light (face %s: %s)", names[face], problem);
    return false;
}

static bool find_sizes(struct gltf *gltf, struct cube_files *c)
{
    char why[DECODE_WHY_SIZE];
    for (int i = 0; i < CUBE_FACES; i++) {
        const char *problem = find_size(c, i, why);
        if (problem) return note(gltf, i, problem);
    }
    return true;
}

// The texels, the equirectangular image, its copy without invalid values and the map.
static bool allocate(struct gltf *gltf, struct cube_files *c)
{
    const size_t texels = (size_t)c->cube.size * (size_t)c->cube.size;
    const size_t width = (size_t)cube_map_width(&c->cube);
    if (!import_charge(gltf->import, texels, 4 * CUBE_FACES) ||
        !import_charge(gltf->import, width * width / 2, 2 * 3 * sizeof(float)))
        return false;
    c->texels = host_alloc(gltf->import->host, texels, 4 * CUBE_FACES);
    for (size_t i = 0; i < CUBE_FACES; i++)
        if (c->texels) c->cube.faces[i] = c->texels + 4 * texels * i;
    return c->texels;
}

static bool decode(struct gltf *gltf, struct cube_files *c)
{
    const size_t texels = (size_t)c->cube.size * (size_t)c->cube.size;
    char why[DECODE_WHY_SIZE];
    for (int i = 0; i < CUBE_FACES; i++) {
        const char *problem = image_decode(c->sources[i].data, c->sources[i].size, c->cube.size,
                                           c->cube.size, c->texels + 4 * texels * (size_t)i, why);
        if (problem) return note(gltf, i, problem[0] ? problem : "it cannot be decoded");
    }
    return true;
}

const struct environment_map *gltf_cube_map(struct gltf *gltf, struct gltf_object light,
                                            versors world_from_cube, bool *ok)
{
    struct host *host = gltf->import->host;
    struct cube_files c = { 0 };
    struct image equirect = { 0 };
    const struct environment_map *map = NULL;
    const char *name =
        import_name(gltf->import, gltf_string(light, "name"), "image-based light", light.index);
    *ok = name && import_files_init(&c.files, gltf->import, CUBE_FACES) &&
          find_faces(gltf, light, &c);
    const bool sized = *ok && find_sizes(gltf, &c);
    if (sized) *ok = allocate(gltf, &c);
    if (sized && *ok && decode(gltf, &c)) {
        *ok = cube_map_to_equirect(host, &c.cube, world_from_cube, &equirect);
        if (*ok) map = environment_map_create(host, name, &equirect);
        *ok = map;
    }
    image_finish(&equirect, host);
    finish(host, &c);
    return map;
}
