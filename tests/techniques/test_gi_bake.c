// Bakes of techniques: identity from the options, the plan, loading by a GI stack.
#include "techniques/gi_baked.h"

#include "bake/scene_key.h"
#include "frame/frame_fixture.h"
#include "framework/test.h"

#include <stdio.h>
#include <string.h>

struct fake_options {
    int32_t modes;
    float bias;
};
#define ROW(...) OPTION_ROW(struct fake_options, __VA_ARGS__)
static const struct option_row rows[] = { ROW(int32, modes, 4, 1, 64, "", REBAKE, "number of modes")
                                              ROW(float32, bias, 1, -1e6, 1e6, "", LIVE,
                                                  "a number") };

struct fake_state {
    struct fake_options options;
    float sum; // of the loaded modes
};
static struct fake_state newest;

static bool modes(const struct bake_task *task)
{
    ((float *)task->out[0])[0] = (float)task->index;
    return true;
}

static bool fake_bake(struct bake_plan *plan, const struct technique_bake *how)
{
    const struct fake_options *options = how->options;
    const struct bake_output out = { "modes",   TENSOR_F32, 1, { (uint64_t)options->modes },
                                     BAKE_ROWS, BAKE_SAVED };
    if (how->pose) bake_plan_depends(plan, scene_key(how->pose, SCENE_KEY_GEOMETRY));
    return bake_plan_add(plan, &(struct bake_stage){ .name = "modes",
                                                     .task_count = (size_t)options->modes,
                                                     .run = modes,
                                                     .outputs = &out,
                                                     .output_count = 1 });
}

static bool fake_create(void *state, const struct technique_create *how)
{
    (void)how;
    newest = (struct fake_state){ .sum = 0.0f };
    return state != NULL;
}

static bool fake_load(void *state, const struct tensors *bake)
{
    (void)state;
    const uint64_t shape[] = { 4 };
    const float *values = tensors_expect(test_host(), bake, "modes", TENSOR_F32, 1, shape);
    for (int i = 0; values && i < 4; i++) newest.sum += values[i];
    return values != NULL;
}

static void fake_record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    (void)state, (void)cmd, (void)view;
}

static void fake_destroy(void *state)
{
    (void)state;
}

static const struct technique fake = { .name = "fake",
                                       .title = "fake",
                                       .paper = "none",
                                       .role = ROLE_SOURCE,
                                       .capabilities = NEEDS_BAKE,
                                       .bake_version = 7,
                                       .options = OPTION_TABLE(struct fake_options, rows, NULL),
                                       .state_size = sizeof(struct fake_state),
                                       .bake = fake_bake,
                                       .create = fake_create,
                                       .load = fake_load,
                                       .record = fake_record,
                                       .destroy = fake_destroy };
static const struct technique *const known[] = { &fake, NULL };

static struct gi_spec spec_of(const char *text)
{
    struct gi_spec spec;
    CHECK(gi_spec_parse_among(&spec, test_host(), text, known));
    return spec;
}

static struct bake *bake_of(const struct gi_spec *spec, const struct scene_pose *pose,
                            struct technique_bake *how)
{
    *how = (struct technique_bake){ .pose = pose, .options = spec->options[0] };
    struct bake *bake =
        gi_bake_create(test_host(), &fake, how, (struct bake_identity){ .program = "1.0" });
    assert_non_null(bake);
    return bake;
}

TEST(gi_bake_depends_on_options_of_effect_rebake_alone)
{
    struct gi_spec spec = spec_of("fake:modes=9,bias=3"), same = spec_of("fake:modes=9,bias=4"),
                   other = spec_of("fake:modes=8,bias=3");
    struct technique_bake how[3];
    struct bake *bakes[3] = { bake_of(&spec, NULL, &how[0]), bake_of(&same, NULL, &how[1]),
                              bake_of(&other, NULL, &how[2]) };
    char keys[3][HASH128_TEXT];
    for (int i = 0; i < 3; i++) bake_key(bakes[i], keys[i]);
    CHECK_STRING(bake_options_text(bakes[0]), "modes=9");
    CHECK_STRING(keys[0], keys[1]);
    CHECK(strcmp(keys[0], keys[2]) != 0);
    CHECK(bake_fits(bakes[0], bakes[1]) && !bake_fits(bakes[0], bakes[2]));
    for (int i = 0; i < 3; i++) bake_destroy(bakes[i]);
    gi_spec_finish(&spec);
    gi_spec_finish(&same);
    gi_spec_finish(&other);
}

static void print_key(const char *text, char out[HASH128_TEXT])
{
    struct gi_spec spec;
    CHECK(gi_spec_parse(&spec, test_host(), text));
    const struct technique_bake how = { .options = spec.options[0] };
    struct bake *bake = gi_bake_create(test_host(), spec.technique[0], &how,
                                       (struct bake_identity){ .program = "1.0" });
    assert_non_null(bake);
    bake_key(bake, out);
    bake_destroy(bake);
    gi_spec_finish(&spec);
}

TEST(drt_has_the_bake_of_mrt)
{
    static const char *const options[] = { "", ":texels=8", ":quality=low" };
    char mrt[HASH128_TEXT], drt[HASH128_TEXT], spec[64];
    for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
        snprintf(spec, sizeof spec, "mrt%s", options[i]);
        print_key(spec, mrt);
        snprintf(spec, sizeof spec, "drt%s", options[i]);
        print_key(spec, drt);
        CHECK_STRING(drt, mrt);
    }
}

TEST(gi_spec_lists_the_techniques_that_bake)
{
    struct gi_spec spec = spec_of("fake"), none;
    int term = -1;
    CHECK(gi_spec_bakes(&spec, 0, &term) == 1 && term == 0);
    CHECK(gi_spec_bakes(&spec, 1, &term) == 1 && term == -1);
    CHECK(gi_spec_parse(&none, test_host(), "ambient+vo"));
    CHECK(gi_spec_bakes(&none, 0, &term) == 0 && term == -1);
    gi_spec_finish(&spec);
    gi_spec_finish(&none);
}

TEST_GPU(gi_loads_the_bake_after_creation_and_refuses_to_do_without)
{
    struct frame_fixture s;
    struct technique_bake how;
    fixture_init(&s, gpu);
    fixture_floor(&s, 4, fixture_matte(&s, vec3_of(1, 1, 1)));
    fixture_open(&s);
    struct gi_spec spec = spec_of("fake");
    CHECK(!gi_create(test_host(), gpu, &spec, &s.pose, 32, 32));
    CHECK_STRING(test_last_message(), "cannot create fake: it needs a bake");
    struct gi_baked baked;
    CHECK(gi_bake_all(&baked, test_host(), &spec, &s.pose));
    struct gi *gi = gi_create_baked(test_host(), gpu, &spec, &baked.bakes, &s.pose, 32, 32);
    assert_non_null(gi);
    CHECK_NEAR(newest.sum, 0 + 1 + 2 + 3, 0.0);
    gi_destroy(gi);
    gi_baked_finish(&baked);
    // A bake of other options: the technique checks what it reads.
    struct gi_spec wide = spec_of("fake:modes=5");
    struct bake *bake = bake_of(&wide, &s.pose, &how);
    CHECK(bake_run(bake, &(struct bake_run_options){ 0 }));
    const struct gi_bakes wrong = { { bake_tensors(bake) } };
    CHECK(!gi_create_baked(test_host(), gpu, &spec, &wrong, &s.pose, 32, 32));
    CHECK(strstr(test_last_message(), "tensor modes is F32 [5], not F32 [4]"));
    bake_destroy(bake);
    gi_spec_finish(&wide);
    gi_spec_finish(&spec);
    fixture_finish(&s);
}
