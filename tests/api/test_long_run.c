// Memory that the process keeps after hundreds of frames with each technique, the driver's
// included: lavapipe compiles a pipeline again for values of uniforms that decide a branch, and
// keeps each version. No validation: its layer keeps records of its own.
#include "api/renderer_fixture.h"

#include <limits.h>
#include <malloc.h>
#include <stdio.h>
#include <string.h>

enum { WARM = 20, BOUND_KIB = 2048 };

// Bytes in use on the heap and in executable memory. Resident memory has the allocator's free
// blocks too, whose number depends on the threads that compute light of moved clutter.
static long used_kib(void)
{
    const struct mallinfo2 heap = mallinfo2();
    size_t used = heap.uordblks + heap.hblkhd;
    char line[512];
    FILE *maps = fopen("/proc/self/maps", "r");
    assert_non_null(maps);
    while (fgets(line, sizeof line, maps)) {
        unsigned long first, end, offset, inode;
        char access[8];
        if (sscanf(line, "%lx-%lx %7s %lx %*s %lu", &first, &end, access, &offset, &inode) == 5 &&
            access[2] == 'x' && inode == 0)
            used += end - first;
    }
    fclose(maps);
    return (long)(used / 1024);
}

// ---- The scene

// A tetrahedron in the Cornell box. As a movable instance it is lit by dnrt; the others of drt's
// clutter move as well.
static int add_object(struct ag_scene *scene, bool movable)
{
    static const float corners[12] = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1 };
    static const uint32_t faces[12] = { 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3 };
    const struct ag_mesh_desc desc = {
        .positions = corners, .vertex_count = 4, .indices = faces, .index_count = 12, .material = 0
    };
    const float matrix[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -0.5f, 1, 1, 1 };
    int mesh = -1, instance = -1;
    assert_int_equal(ag_scene_add_mesh(scene, &desc, &mesh), AG_OK);
    assert_int_equal(ag_scene_add_instance(scene, mesh, matrix, &instance), AG_OK);
    if (movable)
        assert_int_equal(ag_scene_set_instance_mobility(scene, instance, AG_MOBILITY_MOVABLE),
                         AG_OK);
    return instance;
}

// The same again after PERIOD frames.
enum { PERIOD = 10 };

static void change(struct ag_scene *scene, int instance, int frame)
{
    const float t = 0.1f * (float)(frame % PERIOD);
    const float matrix[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, t - 0.5f, 1, 1, 1 };
    struct ag_light_info light;
    assert_int_equal(ag_scene_get_light(scene, 0, 0, 0, &light), AG_OK);
    light.light.position[0] = t;
    light.light.intensity[1] = 100.0f + 100.0f * t;
    assert_int_equal(ag_scene_set_light(scene, 0, &light.light), AG_OK);
    assert_int_equal(ag_scene_set_instance_transform(scene, instance, matrix), AG_OK);
}

// ---- Frames

struct run {
    struct own_device own;
    struct renderer_fixture s;
    int instance;
};

// A spec with the cheapest bake, in 2 * FIXTURE_SPEC bytes. Volumes are small: their passes are
// those of large ones.
static void print_spec(int technique, const struct ag_technique_info *info, char *out)
{
    static const char volume[] = "dim=8,steps=2";
    char base[FIXTURE_SPEC];
    fixture_print_base(technique, info, base);
    if (strcmp(info->role, "delta") == 0)
        snprintf(out, 2 * FIXTURE_SPEC, "lpv:%s+%s", volume, base);
    else if (strstr(info->name, "lpv"))
        snprintf(out, 2 * FIXTURE_SPEC, "%s:%s", info->name, volume);
    else
        snprintf(out, 2 * FIXTURE_SPEC, "%s", base);
}

static void open_run(struct run *run, int technique, const struct ag_technique_info *info)
{
    char gi[2 * FIXTURE_SPEC];
    *run = (struct run){ 0 };
    own_device_open(&run->own, 0);
    const struct ag_device_adopt adopt = fixture_lend(&run->own);
    run->s = fixture_open("none", &adopt);
    ag_renderer_destroy(run->s.renderer);
    run->instance = add_object(run->s.scene, strcmp(info->name, "drt") != 0);
    print_spec(technique, info, gi);
    struct ag_bake *bake = fixture_bake(&run->s, gi, info);
    const struct ag_bake *const bakes[] = { bake };
    struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    desc.bakes = bakes;
    desc.bake_count = bake != NULL;
    if (ag_renderer_create(run->s.device, run->s.scene, &desc, &run->s.renderer) != AG_OK)
        fail_msg("%s: %s", gi, ag_context_last_error(run->s.context));
    ag_bake_destroy(bake); // surfaces of a scene stay while a bake uses it
}

static void close_run(struct run *run)
{
    ag_renderer_destroy(run->s.renderer);
    run->s.renderer = NULL;
    fixture_close(&run->s);
    own_device_close(&run->own);
}

static void render(struct run *run, int frame, bool changing)
{
    if (changing) change(run->s.scene, run->instance, frame);
    assert_int_equal(ag_renderer_render(run->s.renderer, &run->s.frame), AG_OK);
}

// The least of a period: threads that compute light of changed clutter come and go.
static long least_kib(struct run *run, bool changing)
{
    long least = LONG_MAX;
    for (int i = 0; i < PERIOD; i++) {
        render(run, i, changing);
        assert_int_equal(ag_renderer_wait(run->s.renderer), AG_OK);
        const long now = used_kib();
        if (now < least) least = now;
    }
    return least;
}

static long growth_kib(struct run *run, int frames, bool changing)
{
    for (int i = 0; i < WARM; i++) render(run, i, changing);
    const long before = least_kib(run, changing);
    for (int i = 0; i < frames; i++) render(run, i, changing);
    return least_kib(run, changing) - before;
}

// Objects and lights that move run the passes that a still scene skips.
TEST(hundreds_of_frames_of_each_technique_keep_no_memory)
{
    struct ag_technique_info info;
    int failed = 0;
    printf("KiB kept of 300 frames of a still scene and of 60 frames of a changing one:\n");
    for (int t = 0; ag_technique_get(t, &info); t++) {
        struct run run;
        open_run(&run, t, &info);
        const long still = growth_kib(&run, 300, false), changing = growth_kib(&run, 60, true);
        close_run(&run);
        printf("%-9s %7ld %7ld\n", info.name, still, changing);
        failed += still > BOUND_KIB || changing > BOUND_KIB;
    }
    if (failed > 0) fail_msg("%d techniques keep more than %d KiB", failed, BOUND_KIB);
}
