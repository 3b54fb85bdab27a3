// Boxes as a scene and as a G-buffer.
#include "host_surfaces.h"

#include <math.h>
#include <string.h>

static const struct box room[BOXES] = {
    { { 0, -0.05f, 0 }, { 2.2f, 0.1f, 2.2f }, { 0.7f, 0.7f, 0.7f }, 0 },
    { { 0, 2.05f, 0 }, { 2.2f, 0.1f, 2.2f }, { 0.7f, 0.7f, 0.7f }, 0 },
    { { 0, 1, -1.05f }, { 2, 2, 0.1f }, { 0.7f, 0.7f, 0.7f }, 0 },
    { { -1.05f, 1, 0 }, { 0.1f, 2, 2.2f }, { 0.6f, 0.06f, 0.05f }, 0 },
    { { 1.05f, 1, 0 }, { 0.1f, 2, 2.2f }, { 0.1f, 0.45f, 0.08f }, 0 },
    { { -0.35f, 0.6f, -0.35f }, { 0.55f, 1.2f, 0.55f }, { 0.7f, 0.7f, 0.7f }, 0 },
    { { 0.4f, 0.25f, 0.3f }, { 0.5f, 0.5f, 0.5f }, { 0.6f, 0.6f, 0.7f }, 0 },
};

void boxes_begin(struct box *boxes)
{
    memcpy(boxes, room, sizeof room);
}

// ---- the scene

static enum ag_result add_cube(struct ag_scene *scene, int material, int *mesh)
{
    // Corner i is at ±0.5 by bits 0, 1 and 2 of i for x, y and z.
    static const uint32_t indices[] = { 1, 3, 7, 1, 7, 5, 0, 4, 6, 0, 6, 2, 2, 6, 7, 2, 7, 3,
                                        0, 1, 5, 0, 5, 4, 4, 5, 7, 4, 7, 6, 0, 2, 3, 0, 3, 1 };
    float positions[24];
    for (int i = 0; i < 24; i++) positions[i] = (i / 3 >> i % 3 & 1) ? 0.5f : -0.5f;
    struct ag_mesh_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.positions = positions;
    desc.vertex_count = 8;
    desc.indices = indices;
    desc.index_count = 36;
    desc.material = material;
    return ag_scene_add_mesh(scene, &desc, mesh);
}

static void world_from_cube(const struct box *box, float out[16])
{
    memset(out, 0, 16 * sizeof *out);
    for (int i = 0; i < 3; i++) {
        out[5 * i] = box->size[i];
        out[12 + i] = box->center[i];
    }
    out[15] = 1;
}

enum ag_result boxes_add(struct box *boxes, struct ag_scene *scene)
{
    enum ag_result result = AG_OK;
    for (int i = 0; i < BOXES && result == AG_OK; i++) {
        struct ag_material_desc material;
        ag_material_desc_default(&material);
        memcpy(material.base_color, boxes[i].color, sizeof boxes[i].color);
        int index = 0;
        float placed[16];
        world_from_cube(&boxes[i], placed);
        result = ag_scene_add_material(scene, &material, &index);
        if (result == AG_OK) result = add_cube(scene, index, &index);
        if (result == AG_OK)
            result = ag_scene_add_instance(scene, index, placed, &boxes[i].instance);
    }
    return result;
}

enum ag_result boxes_add_light(struct ag_scene *scene)
{
    struct ag_light_desc light;
    ag_light_desc_default(&light, AG_LIGHT_POINT);
    light.position[0] = -0.3f;
    light.position[1] = 1.6f;
    for (int i = 0; i < 3; i++) light.intensity[i] = 100; // candela
    return ag_scene_add_light(scene, &light, NULL);
}

enum ag_result box_move(const struct box *box, struct ag_scene *scene)
{
    float placed[16];
    world_from_cube(box, placed);
    return ag_scene_set_instance_transform(scene, box->instance, placed);
}

// ---- the G-buffer

static void cross(const float a[3], const float b[3], float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void scale_to(float v[3], float length)
{
    const float factor = length / sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) v[i] *= factor;
}

// Axes of the image: `right` and `up` are half its width and height at distance 1.
struct view {
    float eye[3], forward[3], right[3], up[3];
};

static struct view view_of(const struct ag_camera *camera, float aspect)
{
    struct view v;
    const float half = tanf(camera->vertical_fov_rad / 2);
    memcpy(v.eye, camera->eye, sizeof v.eye);
    for (int i = 0; i < 3; i++) v.forward[i] = camera->target[i] - camera->eye[i];
    scale_to(v.forward, 1);
    cross(v.forward, camera->up, v.right);
    scale_to(v.right, 1);
    cross(v.right, v.forward, v.up);
    scale_to(v.right, half * aspect);
    scale_to(v.up, half);
    return v;
}

// Distance at which the ray enters the box, INFINITY if it misses; *axis: of the face.
static float enter_box(const struct box *box, const float eye[3], const float ray[3], int *axis)
{
    float enter = 0, leave = INFINITY;
    for (int i = 0; i < 3; i++) {
        const float toward = box->center[i] - eye[i];
        const float reach = copysignf(box->size[i] / 2, ray[i]);
        const float in = (toward - reach) / ray[i], out = (toward + reach) / ray[i];
        if (in > enter) *axis = i;
        enter = fmaxf(enter, in);
        leave = fminf(leave, out);
    }
    return enter > 0 && enter < leave ? enter : INFINITY;
}

struct box_hit boxes_hit(const struct box *boxes, const float eye[3], const float ray[3])
{
    struct box_hit hit;
    memset(&hit, 0, sizeof hit);
    hit.distance = INFINITY;
    for (int b = 0; b < BOXES; b++) {
        int axis = 0;
        const float distance = enter_box(&boxes[b], eye, ray, &axis);
        if (distance >= hit.distance) continue;
        hit.distance = distance;
        hit.box = b;
        hit.axis = axis;
        hit.negative = ray[axis] > 0;
    }
    return hit;
}

float linear_from_srgb(uint8_t byte)
{
    const float v = (float)byte / 255.0f;
    return v <= 0.04045f ? v / 12.92f : powf((v + 0.055f) / 1.055f, 2.4f);
}

uint8_t srgb_byte(float linear)
{
    const float v =
        linear <= 0.0031308f ? 12.92f * linear : 1.055f * powf(linear, 1 / 2.4f) - 0.055f;
    return (uint8_t)(255 * v + 0.5f);
}

// A unit vector along an axis, octahedral, as two half floats: 0, 1 or −1.
static void encode_normal(int axis, bool negative, uint16_t out[2])
{
    const uint16_t one = negative ? 0xbc00 : 0x3c00;
    out[0] = axis == 0 ? one : axis == 2 && negative ? 0x3c00 : 0;
    out[1] = axis == 1 ? one : axis == 2 && negative ? 0x3c00 : 0;
}

void boxes_draw(const struct box *boxes, const struct ag_camera *camera,
                const struct host_gbuffer *out)
{
    const size_t width = (size_t)out->width, pixels = width * (size_t)out->height;
    float *depth = (float *)host_gbuffer_texels(out, SURFACE_DEPTH);
    uint16_t *normal = (uint16_t *)host_gbuffer_texels(out, SURFACE_NORMAL);
    uint8_t *albedo = (uint8_t *)host_gbuffer_texels(out, SURFACE_ALBEDO);
    const struct view view = view_of(camera, (float)out->width / (float)out->height);
    for (size_t p = 0; p < pixels; p++) {
        const float x = 2 * ((float)(p % width) + 0.5f) / (float)out->width - 1;
        const float y = 1 - 2 * ((float)(p / width) + 0.5f) / (float)out->height;
        float ray[3];
        for (int i = 0; i < 3; i++) ray[i] = view.forward[i] + x * view.right[i] + y * view.up[i];
        const struct box_hit hit = boxes_hit(boxes, view.eye, ray);
        const bool surface = hit.distance < INFINITY; // along the view axis
        depth[p] = surface ? camera->near_m / hit.distance : 0;
        encode_normal(hit.axis, hit.negative, normal + 2 * p);
        for (size_t c = 0; c < 3; c++) albedo[4 * p + c] = srgb_byte(boxes[hit.box].color[c]);
        albedo[4 * p + 3] = surface ? 255 : 0;
    }
}
