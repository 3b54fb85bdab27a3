// Self-transfer in an object's own pixels, in frames, against the bake, evaluated on the CPU.
#include "techniques/dnrt/probe_fixture.h"
#include "techniques/dnrt/sphere_fixture.h"

#include "core/half.h"
#include "core/sh.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SOURCE "lpv:geometry=off,dim=16,cascades=1,bounces=0,probes=true"
enum { CRATE = 2 }; // its instance
static const vec3s CENTRE = { { 0.1f, 0.6f, 0.2f } };
static const float HALF_EDGE = 0.4f;

static versors turn(void)
{
    return glms_quatv(0.4f, vec3_of(0.48f, 0.6f, -0.64f));
}

// A floor and a red wall in the sun, and an open crate.
static void open_scene(struct frame_fixture *s, struct baked_fixture *run, struct gpu *gpu,
                       const char *gi)
{
    struct node node = node_default();
    node.translation = CENTRE;
    node.rotation = turn();
    node.scale = vec3_of(HALF_EDGE, HALF_EDGE, HALF_EDGE);
    fixture_init(s, gpu);
    fixture_floor(s, 3, fixture_matte(s, vec3_of(0.7f, 0.7f, 0.7f)));
    fixture_quad(s, vec3_of(-3, 0, -2), vec3_of(3, 0, -2), vec3_of(3, 3, -2), vec3_of(-3, 3, -2),
                 fixture_matte(s, vec3_of(0.8f, 0.1f, 0.1f)));
    const int mesh = crate_fixture_add(s->scene, fixture_matte(s, vec3_of(0.2f, 0.4f, 0.9f)));
    s->scene->instances[fixture_instance(s, mesh, &node)].movable = true;
    fixture_add_sun(s, vec3_of(0.3f, -1, -0.6f), vec3_of(1000, 1000, 1000));
    fixture_look(s, vec3_of(0.2f, 2.4f, 1.4f), CENTRE);
    s->input.want_id_layer = true;
    baked_fixture_open(run, s, gi);
    s->indirect.needs |= FRAME_LEAVES_DYNAMIC; // also of a source alone
    fixture_render(s);
}

struct crate {
    float light[3][9], lamps[3][9]; // in its frame, lux
    const struct tensor *corners, *patches, *self;
};

static float coefficient_of(const struct crate *crate, uint32_t point, int j, int channel)
{
    const size_t count = (size_t)crate->self->shape[1];
    const uint16_t *at = crate->self->data;
    return float_from_half(at[(point * count + (size_t)j) * 4 + (size_t)channel]);
}

// Number of point (i, j) of a patch of n steps.
static uint32_t point_of(uint32_t first, int n, int i, int j)
{
    for (int row = 0; row < j; row++) first += (uint32_t)(n - row + 1);
    return first + (uint32_t)i;
}

// Weights of the second and third corner.
static vec2s weights_of(const struct crate *crate, uint32_t triangle, vec3s p)
{
    const float *c = (const float *)crate->corners->data + (size_t)9 * triangle;
    const vec3s a = vec3_of(c[0], c[1], c[2]);
    const vec3s u = glms_vec3_sub(vec3_of(c[3], c[4], c[5]), a);
    const vec3s v = glms_vec3_sub(vec3_of(c[6], c[7], c[8]), a), w = glms_vec3_sub(p, a);
    const vec3s n = glms_vec3_cross(u, v);
    const float area2 = glms_vec3_norm2(n);
    return (vec2s){ { glms_vec3_dot(glms_vec3_cross(w, v), n) / area2,
                      glms_vec3_dot(glms_vec3_cross(u, w), n) / area2 } };
}

static float change_by(const struct crate *crate, uint32_t point, int colour)
{
    float sum = 0;
    for (int j = 0; j < (int)crate->self->shape[1]; j++) {
        const float s = coefficient_of(crate, point, j, colour);
        sum += crate->light[colour][j] * s +
               crate->lamps[colour][j] * (s + coefficient_of(crate, point, j, 3));
    }
    return sum;
}

// Interpolates between the three points of the patch around, by their hat functions.
static float change_of(const struct crate *crate, uint32_t triangle, vec3s position, int colour)
{
    const mat3s world = glms_quat_mat3(turn());
    const vec3s from_node = glms_vec3_sub(position, CENTRE);
    const vec3s p =
        glms_vec3_divs(glms_mat3_mulv(glms_mat3_transpose(world), from_node), HALF_EDGE);
    const uint32_t *patch = (const uint32_t *)crate->patches->data + (size_t)2 * triangle;
    const int n = (int)(patch[1] & 0xffff);
    // Corners are from the centre of the bounding sphere, that of the whole cube.
    vec2s at = glms_vec2_scale(weights_of(crate, triangle, p), (float)n);
    float sum = 0, weights = 0;
    for (int j = 0; j <= n; j++)
        for (int i = 0; i + j <= n; i++) {
            const float x = at.x - (float)i, y = at.y - (float)j;
            const float far = fmaxf(fmaxf(fabsf(x), fabsf(y)), fabsf(x + y));
            if (far >= 1) continue;
            sum += (1 - far) * change_by(crate, point_of(patch[0], n, i, j), colour);
            weights += 1 - far;
        }
    CHECK_NEAR(weights, 1, 0.02);
    return sum;
}

static void take_light(struct crate *crate, struct baked_fixture *run, struct frame_fixture *s,
                       bool direct)
{
    const mat3s object_from_world = glms_mat3_transpose(glms_quat_mat3(turn()));
    float c[3][9];
    probe_fixture_at(run, s, CENTRE, c);
    for (int i = 0; i < 3; i++) sh_rotate(3, object_from_world, c[i], crate->light[i]);
    if (!direct) return;
    float zonal[3], cosine[9];
    const vec3s to_sun = glms_vec3_normalize(vec3_of(-0.3f, 1, 0.6f));
    zh_clamped_cosine(3, zonal);
    zh_rotate(3, zonal, glms_mat3_mulv(object_from_world, to_sun), cosine);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 9; j++) crate->lamps[i][j] = 1000 * cosine[j];
}

static void check_pixels(struct gpu *gpu, const char *options)
{
    char gi[192];
    struct frame_fixture s, before_s;
    struct baked_fixture run, before_run;
    const bool direct = strstr(options, "direct") != NULL;
    // Without self-transfer an object changes nothing of its own pixels.
    open_scene(&before_s, &before_run, gpu, SOURCE);
    float *before = fixture_read(&before_s, READ_IRRADIANCE);
    baked_fixture_close(&before_run, &before_s);
    snprintf(gi, sizeof gi, "%s+dnrt:size=16,rays=64,self=true%s", SOURCE, options);
    open_scene(&s, &run, gpu, gi);
    const struct tensors *bake = run.baked.bakes.of_term[1];
    struct crate crate = { .corners = baked_tensor(bake, "corners"),
                           .patches = baked_tensor(bake, "patches"),
                           .self = baked_tensor(bake, "self") };
    float *after = fixture_read(&s, READ_IRRADIANCE), *position = fixture_read(&s, READ_POSITION);
    float *id = fixture_read(&s, READ_ID);
    take_light(&crate, &run, &s, direct);
    double most = 0, worst = 0;
    int own = 0;
    for (size_t i = 0; i < (size_t)s.width * s.height; i++) {
        if ((int)id[2 * i] != CRATE) continue;
        own++;
        const vec3s p = vec3_of(position[3 * i], position[3 * i + 1], position[3 * i + 2]);
        for (size_t c = 0; c < 3; c++) {
            const float change = change_of(&crate, (uint32_t)id[2 * i + 1], p, (int)c);
            const float expected = fmaxf(change, -before[3 * i + c]);
            most = fmax(most, fabs((double)expected));
            worst = fmax(worst, fabs((double)(after[3 * i + c] - before[3 * i + c] - expected)));
        }
    }
    print_message("%s: %d pixels, largest change %.3g lux, error %.2g of it\n", gi, own, most,
                  worst / most);
    CHECK(own > 100 && most > 1 && worst < 0.02 * most);
    free(before);
    free(after);
    free(position);
    free(id);
    baked_fixture_close(&run, &s);
}

TEST_GPU(own_pixels_change_as_the_bake_says)
{
    check_pixels(gpu, "");
    check_pixels(gpu, ",coefficients=9,direct=true");
}
