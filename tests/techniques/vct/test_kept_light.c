// Light that is kept while nothing changes equals that of frames that keep nothing, to the bit.
#include "techniques/vct/vct_fixture.h"

#include <stdlib.h>
#include <string.h>

struct event {
    float light, sky, ev, box; // intensity, scaled; exposure value; the box moves
};

static const struct event EVENTS[] = {
    { 1, 0, 8, 0 },      { 1, 0, 8, 0 },     { 0.5f, 0, 8, 0 }, { 0.5f, 0, 8, 0 },
    { 0.5f, 30, 8, 0 },  { 0.5f, 30, 9, 0 }, { 0, 30, 9, 0 },   { 0, 30, 9, 0.3f },
    { 0, 30, 9, -0.1f }, { 0.7f, 30, 9, 0 }, { 0.7f, 0, 9, 0 }, { 0.7f, 0, 9, 0.2f },
    { 0.7f, 0, 9, 0 },
};

static void change(struct vct_fixture *fixture, int box, const struct event *event)
{
    struct frame_input *input = &fixture->frame_fixture.input;
    input->auto_exposure = false;
    input->exposure_ev = event->ev;
    input->environment.sky = vec3_of(event->sky, event->sky, event->sky);
    input->light_count = event->light > 0 ? 1 : 0;
    fixture->frame_fixture.lights[0].intensity = vec3_of(900 * event->light, 800, 700);
    if (event->box != 0) vct_fixture_move_box(fixture, box, vec3_of(event->box, 0, event->box));
}

TEST_GPU(kept_light_equals_that_of_frames_that_keep_nothing)
{
    enum { EVENT_COUNT = sizeof EVENTS / sizeof EVENTS[0], FRAMES_OF_EVENT = 3 };
    struct vct_fixture fixtures[2];
    int boxes[2];
    for (int i = 0; i < 2; i++) {
        boxes[i] = vct_fixture_room(&fixtures[i], gpu);
        vct_fixture_open(&fixtures[i], "resolution=32");
    }
    const size_t bytes =
        3 * sizeof(float) * fixtures[0].frame_fixture.width * fixtures[0].frame_fixture.height;
    for (int k = 0; k < EVENT_COUNT * FRAMES_OF_EVENT; k++) {
        float *e[2];
        struct event event = EVENTS[k / FRAMES_OF_EVENT];
        for (int i = 0; i < 2; i++) {
            change(&fixtures[i], boxes[i], &event);
            if (i == 1) technique_vct.invalidate(fixtures[i].vct, CHANGED_LIGHT);
            e[i] = vct_fixture_irradiance_after(&fixtures[i], 1);
        }
        if (memcmp(e[0], e[1], bytes) != 0) print_message("frame %d differs\n", k);
        CHECK(memcmp(e[0], e[1], bytes) == 0);
        free(e[0]), free(e[1]);
    }
    for (int i = 0; i < 2; i++) vct_fixture_finish(&fixtures[i]);
}
