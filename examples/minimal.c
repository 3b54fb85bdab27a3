// A first program: builds a small room by calls, lights it, renders it with light propagation
// volumes and writes a PNG.
//
//     minimal OUT.png
//
// Build it with an installed library:
//
//     cc minimal.c $(pkg-config --cflags --libs afterglow) -o minimal
#include <afterglow/afterglow.h>

#include <stdio.h>

enum { WIDTH = 320, HEIGHT = 240, FRAMES = 4 };

// A box: 6 faces of 4 vertices, counter-clockwise seen from the side of the normals.
static enum ag_result add_box(struct ag_scene *scene, const float low[3], const float high[3],
                              bool inside, int material)
{
    float positions[24][3];
    uint32_t indices[36];
    for (uint32_t face = 0; face < 6; face++) {
        uint32_t axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        bool far_side = face % 2, flip = far_side == inside;
        for (uint32_t corner = 0; corner < 4; corner++) {
            float *p = positions[4 * face + corner];
            p[axis] = far_side ? high[axis] : low[axis];
            p[u] = corner == 1 || corner == 2 ? high[u] : low[u];
            p[v] = corner >= 2 ? high[v] : low[v];
        }
        const uint32_t order[2][6] = { { 0, 1, 2, 0, 2, 3 }, { 0, 2, 1, 0, 3, 2 } };
        for (uint32_t i = 0; i < 6; i++) indices[6 * face + i] = 4 * face + order[flip][i];
    }
    const struct ag_mesh_desc desc = { .positions = positions[0],
                                       .vertex_count = 24,
                                       .indices = indices,
                                       .index_count = 36,
                                       .material = material };
    int mesh = -1;
    enum ag_result result = ag_scene_add_mesh(scene, &desc, &mesh);
    return result == AG_OK ? ag_scene_add_instance(scene, mesh, NULL, NULL) : result;
}

static enum ag_result add_material(struct ag_scene *scene, float r, float g, float b, int *index)
{
    struct ag_material_desc desc;
    ag_material_desc_default(&desc);
    desc.base_color[0] = r;
    desc.base_color[1] = g;
    desc.base_color[2] = b;
    return ag_scene_add_material(scene, &desc, index);
}

// A white room of 4 m with a red block and a spot that lights one wall.
static enum ag_result build(struct ag_scene *scene)
{
    const float room[2][3] = { { -2, -2, -2 }, { 2, 2, 2 } };
    const float block[2][3] = { { -1.2f, -2, -1 }, { 0, -0.6f, 0.2f } };
    int white = -1, red = -1;
    struct ag_light_desc spot;
    ag_light_desc_default(&spot, AG_LIGHT_SPOT);
    spot.position[1] = 1.8f;
    spot.direction[0] = -1.0f;
    spot.direction[1] = -0.6f;
    for (int i = 0; i < 3; i++) spot.intensity[i] = 1000.0f; // candela
    enum ag_result result = add_material(scene, 0.8f, 0.8f, 0.8f, &white);
    if (result == AG_OK) result = add_material(scene, 0.7f, 0.1f, 0.1f, &red);
    if (result == AG_OK) result = add_box(scene, room[0], room[1], true, white);
    if (result == AG_OK) result = add_box(scene, block[0], block[1], false, red);
    return result == AG_OK ? ag_scene_add_light(scene, &spot, NULL) : result;
}

static enum ag_result render(struct ag_device *device, struct ag_scene *scene,
                             struct ag_image **radiance, float *ev)
{
    struct ag_renderer_desc desc;
    ag_renderer_desc_default(&desc);
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.gi = "lpv";
    struct ag_frame_desc frame;
    ag_frame_desc_default(&frame);
    struct ag_renderer *renderer = NULL;
    const float eye[3] = { 0.6f, 0.2f, 1.9f }, target[3] = { -0.8f, -0.6f, -2 };
    enum ag_result result = ag_scene_look_at(scene, eye, target, 1.2f, &frame.camera);
    if (result == AG_OK) result = ag_renderer_create(device, scene, &desc, &renderer);
    for (int i = 0; i < FRAMES && result == AG_OK; i++)
        result = ag_renderer_render(renderer, &frame);
    if (result == AG_OK) result = ag_renderer_read(renderer, "color", radiance);
    if (result == AG_OK) result = ag_renderer_exposure(renderer, ev);
    ag_renderer_destroy(renderer);
    return result;
}

static enum ag_result run(struct ag_context *context, const char *path)
{
    struct ag_device *device = NULL;
    struct ag_scene *scene = NULL;
    struct ag_image *radiance = NULL, *display = NULL;
    float ev = 0.0f;
    enum ag_result result = ag_device_create(context, NULL, &device);
    if (result == AG_OK) result = ag_scene_create(context, &scene);
    if (result == AG_OK) result = build(scene);
    if (result == AG_OK) result = render(device, scene, &radiance, &ev);
    if (result == AG_OK) result = ag_image_tonemap(context, radiance, ev, &display);
    if (result == AG_OK) result = ag_image_write_png(context, path, display);
    ag_image_destroy(context, display);
    ag_image_destroy(context, radiance);
    ag_scene_destroy(scene);
    ag_device_destroy(device);
    return result;
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: minimal OUT.png\n");
        return 2;
    }
    struct ag_context *context = NULL;
    enum ag_result result = ag_context_create(NULL, &context);
    if (result == AG_OK) result = run(context, argv[1]);
    if (result != AG_OK)
        fprintf(stderr, "minimal: %s (%s)\n", ag_context_last_error(context),
                ag_result_string(result));
    ag_context_destroy(context);
    return result == AG_OK ? 0 : 1;
}
