// Data kept from earlier frames change no bit of the light, whatever moves or changes.
#include "frame/frame_fixture.h"
#include "techniques/lpv/lpv_fixture.h"

#include <stdlib.h>
#include <string.h>

enum { SLAB = 1, DOOR = 2 };

struct run {
    struct frame_fixture s;
    struct lpv *lpv;
    const char *options; // at first
    vec3s camera;
};

static void record(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    technique_lpv.update(user, cmd, view);
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

// Changes in a frame, and whether the light of the frame before stays.
struct event {
    float sun, sky;           // intensity
    float slab, door, camera; // moved along x, m
    int steps;                // 0: as before
    bool kept;
};

static const struct event EVENTS[] = {
    { .sun = 1 },
    { .sun = 1, .kept = true },
    { .sun = 1, .slab = 0.31f },
    { .sun = 1, .slab = 0.21f },
    { .sun = 1, .kept = true },
    { .sun = 0.8f }, // the slab comes to rest
    { .sun = 0.6f },
    { .sun = 0.6f, .slab = -0.4f },
    { .sun = 0.6f, .door = 0.7f }, // starts to move
    { .slab = 0.17f },             // in the dark
    { .sun = 0.6f },
    { .sun = 0.6f, .kept = true },
    { .sun = 0.6f, .camera = 1.3f }, // and the cascades
    { .sun = 0.6f, .camera = -0.9f, .slab = -0.3f },
    { .sun = 0.6f, .camera = 0.01f, .kept = true }, // within the grid's step
    { .sun = 0.6f, .sky = 0.2f },
    { .sun = 0.6f, .sky = 0.2f, .kept = true },
    { .sun = 0.6f, .sky = 0.2f, .steps = 5 },
    { .sun = 0.6f, .sky = 0.2f, .kept = true },
};

static void set_options(struct run *run, const struct event *event)
{
    struct lpv_options options = run->lpv->options;
    if (event->steps == 0) return;
    options.steps = event->steps;
    technique_set_options(&technique_lpv, run->lpv, &options);
}

static void change(struct run *run, const struct event *event)
{
    if (event->slab != 0.0f) move(run, SLAB, event->slab);
    if (event->door != 0.0f) move(run, DOOR, event->door);
    run->s.input.light_count = event->sun > 0.0f ? 1 : 0;
    run->s.lights[0].intensity = vec3_of(event->sun, 0.9f * event->sun, 0.8f * event->sun);
    run->s.input.environment.sky = vec3_of(event->sky, event->sky, event->sky);
    run->camera.x += event->camera;
    fixture_look(&run->s, run->camera, vec3_of(run->camera.x, 0.5f, 0));
    set_options(run, event);
}

static float *render(struct run *run, const struct event *event)
{
    change(run, event);
    run->s.indirect =
        (struct frame_indirect){ .record = record, .user = run->lpv, .needs = technique_lpv.needs };
    fixture_render(&run->s);
    return fixture_read(&run->s, READ_IRRADIANCE);
}

static void forget(struct run *run)
{
    const struct lpv_options options = run->lpv->options;
    struct gpu *gpu = run->s.gpu;
    lpv_fixture_destroy(run->lpv);
    run->lpv = lpv_fixture_create(gpu, run->options);
    technique_set_options(&technique_lpv, run->lpv, &options);
}

static float brightest(const float *e, size_t count)
{
    float most = 0;
    for (size_t i = 0; i < count; i++) most = e[i] > most ? e[i] : most;
    return most;
}

static bool is_kept(const struct lpv *lpv)
{
    bool kept = true;
    for (const struct lpv_cascade *c = lpv->cascades; c; c = c->coarser) kept &= c->kept.same;
    return kept;
}

TEST_GPU(lpv_equals_to_the_bit_that_without_earlier_frames)
{
    static const char *const options[] = { "lpv:dim=16,cascades=2,cell=0.29,steps=3,bounces=2",
                                           "holpv:dim=8,cascades=2,cell=0.5,steps=3,bounces=1" };
    for (int i = 0; i < 2; i++) {
        struct run kept, fresh;
        run_init(&kept, gpu, options[i]);
        run_init(&fresh, gpu, options[i]);
        const size_t count = 3 * (size_t)kept.s.width * kept.s.height;
        for (size_t k = 0; k < sizeof EVENTS / sizeof *EVENTS; k++) {
            forget(&fresh);
            float *a = render(&kept, &EVENTS[k]), *b = render(&fresh, &EVENTS[k]);
            assert_memory_equal(a, b, count * sizeof *a);
            CHECK((brightest(a, count) > 0) == (EVENTS[k].sun > 0));
            CHECK(EVENTS[k].sun == 0 || is_kept(kept.lpv) == EVENTS[k].kept);
            free(a);
            free(b);
        }
        run_finish(&kept);
        run_finish(&fresh);
    }
}
