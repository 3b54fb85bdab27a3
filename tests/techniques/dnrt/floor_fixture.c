#include "techniques/dnrt/floor_fixture.h"

#include "techniques/gi_baked.h"
#include "techniques/gi_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

float *floor_irradiance(struct frame_fixture *s, struct gpu *gpu, const char *text, float bake_time,
                        float time)
{
    struct gi_spec spec;
    struct gi_baked baked;
    fixture_open(s);
    assert_int_equal(3 * s->width * s->height, FLOOR_VALUES);
    pose_update(&s->pose, 0, bake_time);
    CHECK(gi_spec_parse(&spec, test_host(), text));
    CHECK(gi_bake_all(&baked, test_host(), &spec, &s->pose));
    struct gi *gi =
        gi_create_baked(test_host(), gpu, &spec, &baked.bakes, &s->pose, s->width, s->height);
    assert_non_null(gi);
    s->indirect = gi_hook(gi);
    pose_update(&s->pose, 0, time);
    fixture_render(s);
    float *irradiance = fixture_read(s, READ_IRRADIANCE), *id = fixture_read(s, READ_ID);
    for (uint32_t i = 0; i < s->width * s->height; i++)
        if (id[2 * i] != 0) memset(irradiance + 3 * (size_t)i, 0, 12);
    free(id);
    gi_destroy(gi);
    gi_baked_finish(&baked);
    gi_spec_finish(&spec);
    return irradiance;
}

double floor_difference(const float *a, const float *b)
{
    double sum = 0;
    for (int i = 0; i < FLOOR_VALUES; i++) sum += fabs((double)a[i] - (double)b[i]);
    return sum;
}
