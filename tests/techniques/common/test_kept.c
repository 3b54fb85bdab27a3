// Which light of earlier frames serves again.
#include "framework/test.h"

#include "techniques/common/kept.h"

// Events of a frame, and the expected answers.
struct event {
    bool moved, forget, unlit; // forget: everything; unlit: the light
    uint64_t index, light, since;
    bool follows, still, same;
};

static const struct event EVENTS[] = {
    { .index = 0, .light = 5, .since = 0 },
    { .index = 1, .light = 5, .since = 0, .follows = true, .still = true, .same = true },
    { .index = 2, .light = 5, .since = 0, .follows = true, .still = true, .same = true },
    { .index = 3, .light = 6, .since = 3, .follows = true, .still = true },
    { .index = 4, .light = 6, .since = 3, .follows = true, .still = true, .same = true },
    { .index = 5, .light = 6, .since = 5, .follows = true, .moved = true },
    { .index = 6, .light = 6, .since = 5, .follows = true, .still = true, .same = true },
    { .index = 8, .light = 6, .since = 8 }, // a frame was not recorded
    { .index = 9, .light = 6, .since = 8, .follows = true, .still = true, .same = true },
    { .index = 10, .light = 6, .since = 10, .follows = true, .still = true, .unlit = true },
    { .index = 11, .light = 6, .since = 10, .follows = true, .still = true, .same = true },
    { .index = 12, .light = 6, .since = 12, .forget = true },
    { .index = 0, .light = 6, .since = 0 }, // another size or scene
    { .index = 1, .light = 6, .since = 0, .follows = true, .still = true, .same = true },
};

TEST(light_is_kept_from_the_frame_before_if_nothing_moved_and_light_is_the_same)
{
    struct kept kept = { 0 };
    for (size_t i = 0; i < sizeof EVENTS / sizeof *EVENTS; i++) {
        const struct event *e = &EVENTS[i];
        const struct frame_view view = { .index = e->index, .geometry_moved = e->moved };
        if (e->forget) kept.known = false;
        if (e->unlit) kept.lit = false;
        kept_update(&kept, &view, e->light);
        CHECK(kept.follows == e->follows);
        CHECK(kept.still == e->still);
        CHECK(kept.same == e->same);
        CHECK(kept.since == e->since);
    }
}

TEST(the_first_frame_of_a_technique_follows_none)
{
    struct kept kept = { 0 };
    const struct frame_view view = { .index = 1 }; // a technique that was added to a stack
    kept_update(&kept, &view, 0);
    CHECK(!kept.follows && !kept.still && !kept.same && kept.since == 1);
}
