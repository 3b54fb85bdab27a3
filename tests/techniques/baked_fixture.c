#include "techniques/baked_fixture.h"

void baked_fixture_open(struct baked_fixture *run, struct frame_fixture *s, const char *text)
{
    fixture_open(s);
    CHECK(gi_spec_parse(&run->spec, test_host(), text));
    CHECK(gi_bake_all(&run->baked, test_host(), &run->spec, &s->pose));
    run->gi = gi_create_baked(test_host(), s->gpu, &run->spec, &run->baked.bakes, &s->pose,
                              s->width, s->height);
    assert_non_null(run->gi);
    s->indirect = gi_hook(run->gi);
}

void baked_fixture_close(struct baked_fixture *run, struct frame_fixture *s)
{
    gi_destroy(run->gi);
    gi_baked_finish(&run->baked);
    gi_spec_finish(&run->spec);
    fixture_finish(s);
}
