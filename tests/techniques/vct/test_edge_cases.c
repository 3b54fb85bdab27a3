// Edge cases: empty scenes, lights inside of walls, a million triangles, more voxels than the
// capacity.
#include "techniques/vct/vct_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PIXELS = 32 * 32 };

// The mean of a frame's irradiance. Checks that all of it is finite.
static double mean_irradiance(struct vct_fixture *fixture)
{
    fixture_render(&fixture->frame_fixture);
    float *e = fixture_read(&fixture->frame_fixture, READ_IRRADIANCE);
    double sum = 0.0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        CHECK(isfinite(e[i]) && e[i] >= 0.0f);
        sum += (double)e[i] / (3.0 * PIXELS);
    }
    free(e);
    return sum;
}

static uint32_t argument(const struct vct_fixture *fixture, int which)
{
    uint32_t arguments[5];
    CHECK(gpu_buffer_download(fixture->frame_fixture.gpu,
                              fixture->vct->voxels.levels[0].static_set.arguments, 0, arguments,
                              sizeof arguments));
    return arguments[which];
}

static uint32_t listed(const struct vct_fixture *fixture)
{
    return argument(fixture, 3);
}

static uint32_t overflow(const struct vct_fixture *fixture)
{
    return argument(fixture, 4);
}

TEST_GPU(an_empty_scene_has_no_indirect_light)
{
    struct vct_fixture fixture;
    vct_fixture_init(&fixture, gpu);
    fixture_add_point(&fixture.frame_fixture, vec3_of(0, 1, 0), vec3_of(100, 100, 100));
    fixture.frame_fixture.input.environment.sky = vec3_of(5, 5, 5);
    vct_fixture_open(&fixture, "resolution=32");
    CHECK(mean_irradiance(&fixture) == 0.0);
    vct_fixture_finish(&fixture);
}

// ---- Lights in walls

// A point light in the middle of a voxel of a wall, in the plane of the wall, and in a corner of
// the room: the irradiance of voxels is bounded.
TEST_GPU(a_light_inside_of_a_wall_has_bounded_irradiance)
{
    const vec3s positions[] = { { { 3.02f, 4, 4 } }, { { 3, 4, 4 } }, { { 0, 0, 0 } } };
    for (int i = 0; i < 3; i++) {
        struct vct_fixture fixture;
        vct_fixture_init(&fixture, gpu);
        struct frame_fixture *s = &fixture.frame_fixture;
        const int matte = fixture_matte(s, vec3_of(0.8f, 0.8f, 0.8f));
        fixture_box(s, vec3_of(0, 0, 0), vec3_of(11, 8, 9), true, matte);
        fixture_box(s, vec3_of(3, 0, 0), vec3_of(3.05f, 7, 9), false, matte);
        fixture_add_point(s, positions[i], vec3_of(100, 100, 100));
        fixture_look(s, vec3_of(1, 6, 8), vec3_of(3, 3, 3));
        vct_fixture_open(&fixture, "resolution=32,bounces=2");
        double last = 0.0;
        for (int frame = 0; frame < 4; frame++) last = mean_irradiance(&fixture);
        // 400π lm, multiplied by at most 1/(1 − 0.8), on 520 m² of surfaces. The distance of a
        // voxel to the light is clamped to half a voxel: less than twice the flux through a sphere
        // around it. One half of the room may receive all of it.
        CHECK(last < 4.0 * 400.0 * 3.14159 / 0.2 / 520.0);
        vct_fixture_finish(&fixture);
    }
}

// ---- Many triangles

enum { SIDE = 708 }; // squares along a side: 1 002 528 triangles

static void add_field(struct vct_fixture *fixture, int squares)
{
    const uint32_t across = (uint32_t)squares + 1;
    const size_t vertices = (size_t)across * across;
    struct mesh mesh = { .name = "field",
                         .vertex_count = (uint32_t)vertices,
                         .index_count = 6 * (uint32_t)squares * (uint32_t)squares,
                         .positions = malloc(vertices * sizeof(vec3s)),
                         .normals = malloc(vertices * sizeof(vec3s)),
                         .material =
                             fixture_matte(&fixture->frame_fixture, vec3_of(0.5f, 0.5f, 0.5f)) };
    mesh.indices = malloc(mesh.index_count * sizeof *mesh.indices);
    CHECK(mesh.positions && mesh.normals && mesh.indices);
    for (uint32_t i = 0; i < vertices; i++) {
        const float step = 11.4f / (float)squares;
        mesh.positions[i] =
            vec3_of(0.3f + step * (float)(i % across), 0.4f, 0.3f + step * (float)(i / across));
        mesh.normals[i] = vec3_of(0, 1, 0);
    }
    uint32_t *at = mesh.indices;
    for (uint32_t y = 0; y + 1 < across; y++)
        for (uint32_t x = 0; x + 1 < across; x++, at += 6) {
            const uint32_t first = y * across + x;
            const uint32_t square[] = { first, first + across,     first + across + 1,
                                        first, first + across + 1, first + 1 };
            memcpy(at, square, sizeof square);
        }
    const int index = scene_add_mesh(fixture->frame_fixture.scene, &mesh);
    CHECK(index >= 0);
    fixture_instance(&fixture->frame_fixture, index, NULL);
    free(mesh.positions);
    free(mesh.normals);
    free(mesh.indices);
}

// The voxels of a floor of squares² quads, and the irradiance of a wall above it.
static double field(struct gpu *gpu, int squares, uint32_t *mask, size_t mask_bytes)
{
    struct vct_fixture fixture;
    vct_fixture_init(&fixture, gpu);
    add_field(&fixture, squares);
    fixture_quad(&fixture.frame_fixture, vec3_of(0.3f, 0.4f, 0.3f), vec3_of(11.7f, 0.4f, 0.3f),
                 vec3_of(11.7f, 9, 0.3f), vec3_of(0.3f, 9, 0.3f),
                 fixture_matte(&fixture.frame_fixture, vec3_of(0.5f, 0.5f, 0.5f)));
    fixture_add_sun(&fixture.frame_fixture, vec3_of(0, -1, -0.1f), vec3_of(1000, 1000, 1000));
    fixture_look(&fixture.frame_fixture, vec3_of(6, 5, 10), vec3_of(6, 4, 0));
    vct_fixture_open(&fixture, "resolution=16");
    const double e = mean_irradiance(&fixture);
    uint32_t *now = vct_fixture_mask(&fixture, &fixture.vct->voxels.levels[0].static_set);
    memcpy(mask, now, mask_bytes);
    free(now);
    vct_fixture_finish(&fixture);
    return e;
}

TEST_GPU(tessellation_does_not_change_voxels)
{
    uint32_t two[16 * 16 * 16 / 32], million[16 * 16 * 16 / 32];
    const double e_two = field(gpu, 1, two, sizeof two);
    const double e_million = field(gpu, SIDE, million, sizeof million);
    CHECK(memcmp(two, million, sizeof two) == 0);
    CHECK(e_two > 1.0);
    // A triangle that contains no voxel centre line has a thousandth of a face as its weight in
    // colour and position, and no coverage.
    CHECK_NEAR(e_million, e_two, 0.02 * e_two);
}

// ---- Capacity

static int warnings;

static void record_log(void *user, enum log_level level, const char *message)
{
    (void)user;
    if (level == LOG_WARNING && strstr(message, "capacity of")) warnings++;
}

// A stack of sheets one voxel apart.
static void stack(struct vct_fixture *fixture, int sheets)
{
    struct material m = material_default();
    m.base_color = vec4_of(vec3_of(0.5f, 0.5f, 0.5f), 1);
    m.metallic = 0;
    m.double_sided = true;
    const int matte = fixture_material(&fixture->frame_fixture, &m);
    for (int i = 0; i < sheets; i++) {
        const float y = 0.5f + (float)i;
        fixture_quad(&fixture->frame_fixture, vec3_of(0, y, 28), vec3_of(28, y, 28),
                     vec3_of(28, y, 0), vec3_of(0, y, 0), matte);
    }
    fixture_add_sun(&fixture->frame_fixture, vec3_of(-0.2f, -1, -0.4f), vec3_of(1000, 1000, 1000));
    // The camera sees the uppermost sheet, which gets no light of its own.
    fixture->frame_fixture.input.environment.sky = vec3_of(1, 1, 1);
    fixture_look(&fixture->frame_fixture, vec3_of(14, 40, 40), vec3_of(14, 20, 14));
}

TEST_GPU(voxels_beyond_the_capacity_are_dropped_with_one_warning)
{
    const int sheets[] = { 20, 21 }; // of 1568 faces: 31 360 and 32 928; the capacity is 32 768
    for (int i = 0; i < 2; i++) {
        struct vct_fixture fixture;
        struct host host = *test_host();
        host.log = record_log;
        warnings = 0;
        vct_fixture_init(&fixture, gpu);
        fixture.host = &host;
        stack(&fixture, sheets[i]);
        vct_fixture_open(&fixture, "resolution=32");
        const uint32_t room = vct_capacity(&fixture.vct->options), all = 1568 * (uint32_t)sheets[i];
        const double e = mean_irradiance(&fixture);
        CHECK(e > 0.0);
        CHECK(fixture.vct->clipmap.levels[0].grid.cell_m == 1.0f);
        CHECK(listed(&fixture) == (all < room ? all : room));
        CHECK(overflow(&fixture) == (all > room ? all - room : 0));
        // The counter is read back some frames later; each level warns once.
        for (int frame = 0; frame < 4; frame++) fixture_render(&fixture.frame_fixture);
        CHECK(gpu_wait(gpu));
        fixture_render(&fixture.frame_fixture);
        CHECK(warnings == (all > room));
        technique_vct.invalidate(fixture.vct, CHANGED_GEOMETRY);
        for (int frame = 0; frame < 4; frame++) fixture_render(&fixture.frame_fixture);
        CHECK(gpu_wait(gpu));
        vct_fixture_finish(&fixture);
        CHECK(warnings == (all > room));
    }
}
