// Rays of a closed room meet texels of that room: those that reach through a wall count for others.
#include "techniques/trials/light_trial_scenes.h"
#include "techniques/ort/bake_fixture.h"

#include "bake/plan.h"
#include "techniques/ort/bake/texels.h"

#include <math.h>

struct count {
    size_t hits, beyond;
};

// The dark room, x in 0.025…4: the light of others does not reach it.
static bool is_in_dark_room(const struct ort_scene *scene, uint32_t texel)
{
    const vec3s at = glms_vec3_muladds(chart_texel_normal(&scene->map.charts, texel), 0.01f,
                                       chart_texel_of(&scene->map.charts, texel)->position);
    return at.x > 0.025f && at.x < 4 && at.y > 0 && at.y < 3 && fabsf(at.z) < 2;
}

static bool run(const struct bake_task *task)
{
    struct ort_texels texels;
    struct count *count = *(struct count *const *)task->argument;
    if (!ort_find_texels(&texels, task)) return false;
    const struct ort_scene *scene = texels.scene;
    const size_t rays = (size_t)scene->options.rays;
    for (uint32_t i = 0; i < scene->map.texel_count; i++) {
        const struct ort_texel texel = ort_texel_of(&texels, i);
        const uint32_t *hits = texels.hits + i * rays;
        if (!is_in_dark_room(scene, i) || texel.position.x < 0.025f) continue;
        for (size_t k = 0; k < rays && hits[k] != CHART_NONE; k++) {
            count->hits++;
            count->beyond += !is_in_dark_room(scene, hits[k]);
        }
    }
    return true;
}

TEST(rays_of_a_closed_room_meet_texels_of_that_room)
{
    struct ort_fixture f = { 0 };
    struct count count = { 0 }, *argument = &count;
    trial_two_rooms(&f.s, NULL, true);
    ort_fixture_open(&f, "texels=4096,offsets=50");
    struct bake *bake = ort_fixture_plan(&f, "", 0);
    const struct bake_stage stage = {
        .name = "hits", .wave = 4, .task_count = 1, .run = run, .argument = &argument
    };
    CHECK(bake_plan_add(bake_plan_of(bake), &stage));
    CHECK(bake_run(bake, &(struct bake_run_options){ 0 }));
    print_message("%zu of %zu rays meet texels whose middle is beyond a wall\n", count.beyond,
                  count.hits);
    CHECK(count.hits > 10000 && count.beyond == 0);
    bake_destroy(bake);
    ort_fixture_close(&f);
}
