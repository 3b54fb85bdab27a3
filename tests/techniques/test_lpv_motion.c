// Frames with moving objects: what is kept from earlier frames changes no bit of the light.
#include "frame/frame_fixture.h"
#include "techniques/lpv_fixture.h"

#include <stdlib.h>
#include <string.h>

enum { FRAMES = 13, SLAB = 1, DOOR = 2 };

struct run {
    struct frame_fixture s;
    struct lpv *lpv;
    const char *options;
    vec3s camera;
};

static void record(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    technique_lpv.record(user, cmd, view);
}

static void run_init(struct run *run, struct gpu *gpu, const char *options)
{
    struct frame_fixture *s = &run->s;
    fixture_init(s, gpu);
    run->options = options;
    run->camera = vec3_of(0, 1.5f, 3);
    fixture_look(s, run->camera, vec3_of(0, 0.5f, 0));
    fixture_add_sun(s, vec3_of(0.3f, -1, -0.2f), vec3_of(1, 0.9f, 0.8f));
    fixture_floor(s, 4, fixture_matte(s, vec3_of(0.5f, 0.6f, 0.7f)));
    fixture_quad(s, vec3_of(-1, 0.2f, 0), vec3_of(1, 0.2f, 0), vec3_of(1, 1.5f, 0),
                 vec3_of(-1, 1.5f, 0), fixture_matte(s, vec3_of(0.9f, 0.2f, 0.1f)));
    fixture_quad(s, vec3_of(-2, 0.1f, -1), vec3_of(0, 0.1f, -1), vec3_of(0, 1, -1),
                 vec3_of(-2, 1, -1), fixture_matte(s, vec3_of(0.1f, 0.3f, 0.9f)));
    fixture_box(s, vec3_of(1.5f, 0, -2), vec3_of(2, 3, -1), false,
                fixture_matte(s, vec3_of(0.8f, 0.8f, 0.8f)));
    fixture_open(s);
    run->lpv = lpv_fixture_create(gpu, options);
}

static void run_finish(struct run *run)
{
    lpv_fixture_destroy(run->lpv);
    fixture_finish(&run->s);
}

static void move(struct run *run, int instance, float x)
{
    mat4s *m = &run->s.pose.world_from_node[run->s.scene->instances[instance].node];
    *m = glms_translate(*m, vec3_of(x, 0, 0));
}

// Objects move, rest, and move in a frame without light; another starts to move; the camera moves,
// and the cascades with it.
static void change(struct run *run, int frame)
{
    static const int lights[FRAMES] = { 1, 1, 1, 1, 1, 1, 1, 1, 0, 1, 1, 1, 1 };
    static const float slab[FRAMES] = {
        [2] = 0.31f, [3] = 0.21f, [6] = -0.4f, [8] = 0.17f, [11] = -0.3f
    };
    static const float camera[FRAMES] = { [10] = 1.3f, [11] = -0.9f, [12] = -0.7f };
    if (slab[frame] != 0.0f) move(run, SLAB, slab[frame]);
    if (frame == 7) move(run, DOOR, 0.7f);
    run->s.input.light_count = lights[frame];
    run->camera.x += camera[frame];
    fixture_look(&run->s, run->camera, vec3_of(run->camera.x, 0.5f, 0));
}

static float *render(struct run *run, int frame)
{
    change(run, frame);
    run->s.indirect = (struct frame_indirect){ record, run->lpv, technique_lpv.needs };
    fixture_render(&run->s);
    return fixture_read(&run->s, READ_IRRADIANCE);
}

static void forget(struct run *run)
{
    struct gpu *gpu = run->s.gpu;
    lpv_fixture_destroy(run->lpv);
    run->lpv = lpv_fixture_create(gpu, run->options);
}

static float brightest(const float *e, size_t count)
{
    float most = 0;
    for (size_t i = 0; i < count; i++) most = e[i] > most ? e[i] : most;
    return most;
}

TEST_GPU(lpv_of_moving_objects_equals_that_without_earlier_frames)
{
    static const char *const options[] = { "lpv:dim=16,cascades=2,cell=0.29,steps=3,bounces=2",
                                           "holpv:dim=8,cascades=2,cell=0.5,steps=3,bounces=1" };
    for (int i = 0; i < 2; i++) {
        struct run kept, fresh;
        run_init(&kept, gpu, options[i]);
        run_init(&fresh, gpu, options[i]);
        const size_t count = 3 * (size_t)kept.s.width * kept.s.height;
        for (int frame = 0; frame < FRAMES; frame++) {
            forget(&fresh);
            float *a = render(&kept, frame), *b = render(&fresh, frame);
            assert_memory_equal(a, b, count * sizeof *a);
            CHECK((brightest(a, count) > 0) == (kept.s.input.light_count > 0));
            free(a);
            free(b);
        }
        run_finish(&kept);
        run_finish(&fresh);
    }
}
