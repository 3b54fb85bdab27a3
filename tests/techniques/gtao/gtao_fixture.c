#include "techniques/gtao/gtao_fixture.h"

#include "techniques/gi_fixture.h"

#include <math.h>
#include <stdio.h>

float *gtao_visibility(struct frame_fixture *s, const char *options)
{
    char text[200];
    struct gi_spec spec;
    snprintf(text, sizeof text, "gtao:blur=false,%s", options);
    gi_fixture_parse(&spec, text);
    struct gi *gi = gi_fixture_create(s->gpu, &spec, &s->pose, s->width, s->height);
    if (!gi) fail_msg("%s: %s", text, test_last_message());
    s->indirect = gi_hook(gi);
    fixture_render(s);
    float *out = fixture_read(s, READ_VISIBILITY);
    gi_destroy(gi);
    gi_spec_finish(&spec);
    return out;
}

// Uniform points of the unit disk are cosine-weighted directions above it.
double gtao_share(bool (*open)(vec3s direction, const void *user), const void *user)
{
    enum { GRID = 96 };
    int total = 0, unoccluded = 0;
    for (int i = 0; i < GRID * GRID; i++) {
        const float x = 2.0f * ((float)(i % GRID) + 0.5f) / GRID - 1.0f;
        const float y = 2.0f * ((float)(i / GRID) + 0.5f) / GRID - 1.0f;
        const float squared = 1.0f - x * x - y * y;
        if (squared <= 0.0f) continue;
        total++;
        unoccluded += open(vec3_of(x, y, sqrtf(squared)), user);
    }
    return (double)unoccluded / total;
}
