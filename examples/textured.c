// A textured scene built by calls: a tiled floor, a wall with an emissive sign, and a fence cut out
// by an alpha mask. The texels are computed; PNG and JPEG bytes can be given as well.
// Usage: textured OUT.png
#include <afterglow/afterglow.h>

#include <stdio.h>
#include <string.h>

enum { WIDTH = 480, HEIGHT = 320, FRAMES = 4, TEXELS = 64, FLOOR = 0, WALL, FENCE, COUNT };

// Tiles with dark joints; a ring on black; crossed bars with alpha 0 between them.
static void texel_of(int image, int x, int y, uint8_t out[4])
{
    static const uint8_t rgb[COUNT][3] = { { 225, 215, 200 }, { 255, 170, 60 }, { 220, 130, 50 } };
    const int dx = 2 * x - TEXELS, dy = 2 * y - TEXELS, r2 = dx * dx + dy * dy;
    const bool covered[COUNT] = { x % 32 > 1 && y % 32 > 1, r2 > 600 && r2 < 2200,
                                  (x + y) % 16 < 3 || (x - y + TEXELS) % 16 < 3 };
    for (int c = 0; c < 3; c++)
        out[c] = covered[image] ? rgb[image][c] : (uint8_t)(image == FLOOR ? 70 : 0);
    out[3] = image == FENCE && !covered[image] ? 0 : 255;
}

// Squares of 4 m, facing up before they are placed (column-major matrices).
static const float positions[12] = { -2, 0, 2, 2, 0, 2, 2, 0, -2, -2, 0, -2 };
static const float uv[8] = { 0, 1, 1, 1, 1, 0, 0, 0 };
static const uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
static const float places[COUNT][16] = {
    { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 },
    { 1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 2, -2, 1 },
    { 0.5f, 0, 0, 0, 0, 0, 0.5f, 0, 0, -0.5f, 0, 0, 0.6f, 1, 0.3f, 1 },
};

static enum ag_result add_material(struct ag_scene *scene, int which, int image, int *index)
{
    struct ag_material_desc desc;
    struct ag_material_maps maps;
    ag_material_desc_default(&desc);
    ag_material_maps_default(&maps);
    desc.maps = &maps;
    struct ag_texture_map *map = which == WALL ? &maps.emissive : &maps.base_color;
    map->image = image;
    for (int i = 0; i < 2; i++) map->uv_scale[i] = which == FLOOR ? 4 : 1;
    for (int i = 0; i < 3; i++) desc.emissive[i] = which == WALL ? 1500 : 0; // cd/m² × texel
    desc.alpha_mode = which == FENCE ? AG_ALPHA_MASK : AG_ALPHA_OPAQUE;
    desc.double_sided = which == FENCE;
    return ag_scene_add_material(scene, &desc, index);
}

static enum ag_result add_square(struct ag_scene *scene, int which)
{
    static uint8_t texels[TEXELS * TEXELS][4]; // copied by ag_scene_add_image
    for (int i = 0; i < TEXELS * TEXELS; i++) texel_of(which, i % TEXELS, i / TEXELS, texels[i]);
    const struct ag_scene_image_desc image = {
        .pixels = texels[0], .width = TEXELS, .height = TEXELS, .channels = 4
    };
    struct ag_mesh_desc mesh = { .positions = positions,
                                 .vertex_count = 4,
                                 .indices = indices,
                                 .index_count = 6,
                                 .uv = { uv } };
    int index = -1;
    enum ag_result result = ag_scene_add_image(scene, &image, &index);
    if (result == AG_OK) result = add_material(scene, which, index, &mesh.material);
    if (result == AG_OK) result = ag_scene_add_mesh(scene, &mesh, &index);
    return result == AG_OK ? ag_scene_add_instance(scene, index, places[which], NULL) : result;
}

static enum ag_result build(struct ag_scene *scene)
{
    const float sky[3] = { 40, 55, 80 }; // cd/m²
    struct ag_light_desc sun;
    ag_light_desc_default(&sun, AG_LIGHT_SUN);
    memcpy(sun.direction, (float[3]){ -0.6f, -1, -0.5f }, sizeof sun.direction);
    for (int i = 0; i < 3; i++) sun.intensity[i] = 3000; // lux
    enum ag_result result = ag_scene_add_light(scene, &sun, NULL);
    if (result == AG_OK) result = ag_scene_set_sky(scene, sky);
    for (int i = 0; i < COUNT && result == AG_OK; i++) result = add_square(scene, i);
    return result;
}

static enum ag_result render(struct ag_context *context, struct ag_device *device,
                             struct ag_scene *scene, const char *path)
{
    static const float eye[3] = { -1.6f, 2.2f, 4.8f }, target[3] = { 0, 1.2f, -0.5f };
    struct ag_renderer *renderer = NULL;
    struct ag_image *display = NULL;
    struct ag_renderer_desc desc;
    struct ag_frame_desc frame;
    ag_renderer_desc_default(&desc);
    ag_frame_desc_default(&frame);
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.gi = "vct";
    enum ag_result result = ag_scene_look_at(scene, eye, target, 0.9f, &frame.camera);
    if (result == AG_OK) result = ag_renderer_create(device, scene, &desc, &renderer);
    for (int i = 0; i < FRAMES && result == AG_OK; i++)
        result = ag_renderer_render(renderer, &frame);
    if (result == AG_OK) result = ag_renderer_read(renderer, "display", &display);
    if (result == AG_OK) result = ag_image_write_png(context, path, display);
    ag_image_destroy(context, display);
    ag_renderer_destroy(renderer);
    return result;
}

int main(int argc, char **argv)
{
    struct ag_context *context = NULL;
    struct ag_device *device = NULL;
    struct ag_scene *scene = NULL;
    enum ag_result result = ag_context_create(NULL, &context);
    if (result == AG_OK) result = ag_device_create(context, NULL, &device);
    if (result == AG_OK) result = ag_scene_create(context, &scene);
    if (result == AG_OK) result = build(scene);
    if (result == AG_OK) result = render(context, device, scene, argc > 1 ? argv[1] : "out.png");
    if (result != AG_OK) fprintf(stderr, "textured: %s\n", ag_context_last_error(context));
    ag_scene_destroy(scene);
    ag_device_destroy(device);
    ag_context_destroy(context);
    return result == AG_OK ? 0 : 1;
}
