// Samples of interface lightfields, and lookups.
#include "lightfield.h"

#include "techniques/mrt/dictionary/tube.h"

#include "core/sampling.h"

#include <math.h>

static size_t directions_of(struct mrt_lightfield l)
{
    return (size_t)l.directions * (size_t)l.directions;
}

vec3s mrt_lightfield_position(struct mrt_lightfield l, size_t sample)
{
    int position = (int)(sample / directions_of(l)), n = l.positions;
    vec2s at = { { ((float)(position % n) + 0.5f) / (float)n,
                   ((float)(position / n) + 0.5f) / (float)n } };
    if (!l.round) return vec3_of(at.x - 0.5f, at.y - 0.5f, 0.0f);
    vec2s disk = sample_disk(at);
    return vec3_of(TUBE_RADIUS * disk.x, TUBE_RADIUS * disk.y, 0.0f);
}

vec3s mrt_lightfield_direction(struct mrt_lightfield l, size_t sample, int sub)
{
    int direction = (int)(sample % directions_of(l)), n = l.directions, m = l.supersampling;
    float fine = (float)(n * m);
    int a = direction % n * m + sub % m, b = direction / n * m + sub / m;
    vec2s square = { { ((float)a + 0.5f) / fine, ((float)b + 0.5f) / fine } };
    return sample_hemisphere_cosine(square);
}

// The inverse of sample_disk (Shirley & Chiu 1997).
static vec2s square_of_disk(float x, float y)
{
    float r = sqrtf(x * x + y * y);
    if (r == 0.0f) return (vec2s){ { 0.5f, 0.5f } };
    bool wide = fabsf(x) > fabsf(y);
    float major = copysignf(r, wide ? x : y);
    float minor = major * (wide ? atanf(y / x) : atanf(x / y)) / GLM_PI_4f;
    return (
        vec2s){ { 0.5f + 0.5f * (wide ? major : minor), 0.5f + 0.5f * (wide ? minor : major) } };
}

struct blend {
    size_t at[2];
    float weight[2];
};

static struct blend blend_of(float x, int n)
{
    float place = glm_clamp(x * (float)n - 0.5f, 0.0f, (float)(n - 1));
    int low = (int)place, high = low + 1 < n ? low + 1 : low;
    float part = place - (float)low;
    return (struct blend){ { (size_t)low, (size_t)high }, { 1.0f - part, part } };
}

void mrt_lightfield_look_up(struct mrt_lightfield l, float x, float y, vec3s direction,
                            struct mrt_lightfield_lookup *out)
{
    vec2s square = square_of_disk(direction.x, direction.y), at = { { x + 0.5f, y + 0.5f } };
    if (l.round) at = square_of_disk(x / TUBE_RADIUS, y / TUBE_RADIUS);
    struct blend i = blend_of(at.x, l.positions), j = blend_of(at.y, l.positions);
    struct blend a = blend_of(square.x, l.directions), b = blend_of(square.y, l.directions);
    size_t positions = (size_t)l.positions, directions = (size_t)l.directions;
    for (int k = 0; k < LIGHTFIELD_LOOKUP; k++) {
        int ki = k & 1, kj = k >> 1 & 1, ka = k >> 2 & 1, kb = k >> 3;
        size_t position = j.at[kj] * positions + i.at[ki];
        out->sample[k] = (position * directions + b.at[kb]) * directions + a.at[ka];
        out->weight[k] = j.weight[kj] * i.weight[ki] * b.weight[kb] * a.weight[ka];
    }
}
