// The light x of the places beside seams minimises what trace/texels/close.c states. There the
// light is not known, and each place gets weights of some texels. Here it is: one linear system for
// all places, solved by conjugate gradients.
#include "lightmap/close.h"

#include <math.h>

enum { MOST_STEPS = 256 };
static const double ACCURACY = 1e-5; // residual over the light

struct system {
    const struct chart_seams *seams;
    double *before, *x; // [places] light; x: the solution
    double *r, *d, *q;  // [places] of conjugate gradients
};

static float *pixel_of(const struct lightmap *map, uint32_t place)
{
    const size_t places = (size_t)map->charts.width * map->charts.height;
    return map->irradiance[place / places].pixels + 3 * (place % places);
}

// q = (λ I + Σ l a aᵀ) d
static void apply(const struct system *s, const double *d, double *q)
{
    for (uint32_t i = 0; i < s->seams->count; i++) q[i] = SEAM_CLOSING_LAMBDA * d[i];
    for (uint32_t i = 0; i < s->seams->point_count; i++) {
        const struct chart_seam_point *p = &s->seams->points[i];
        double sum = 0.0;
        for (int k = 0; k < CHART_SEAM_PLACES; k++) sum += (double)p->weight[k] * d[p->place[k]];
        sum *= (double)p->length;
        for (int k = 0; k < CHART_SEAM_PLACES; k++) q[p->place[k]] += (double)p->weight[k] * sum;
    }
}

static double dot(const double *a, const double *b, uint32_t count)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) sum += a[i] * b[i];
    return sum;
}

// From the light before on: λ x₀ less what it gives is the first residual.
static void solve(const struct system *s)
{
    const uint32_t count = s->seams->count;
    for (uint32_t i = 0; i < count; i++) s->x[i] = s->before[i];
    apply(s, s->x, s->q);
    for (uint32_t i = 0; i < count; i++)
        s->r[i] = s->d[i] = SEAM_CLOSING_LAMBDA * s->before[i] - s->q[i];
    const double light = SEAM_CLOSING_LAMBDA * sqrt(dot(s->before, s->before, count));
    double square = dot(s->r, s->r, count);
    for (int step = 0; step < MOST_STEPS && sqrt(square) > ACCURACY * light; step++) {
        apply(s, s->d, s->q);
        const double alpha = square / dot(s->d, s->q, count);
        for (uint32_t i = 0; i < count; i++) {
            s->x[i] += alpha * s->d[i];
            s->r[i] -= alpha * s->q[i];
        }
        const double next = dot(s->r, s->r, count);
        for (uint32_t i = 0; i < count; i++) s->d[i] = s->r[i] + next / square * s->d[i];
        square = next;
    }
}

static void close_channel(struct lightmap *map, const struct system *s, int channel)
{
    for (uint32_t i = 0; i < s->seams->count; i++)
        s->before[i] = (double)pixel_of(map, s->seams->places[i])[channel];
    solve(s);
    for (uint32_t i = 0; i < s->seams->count; i++)
        pixel_of(map, s->seams->places[i])[channel] = (float)fmax(s->x[i], 0.0);
}

bool lightmap_close(struct lightmap *map, const struct seam_closing *closing)
{
    enum { ARRAYS = 5 };
    const size_t count = closing->seams.count;
    double *numbers = host_alloc(map->host, ARRAYS * count, sizeof *numbers);
    if (!numbers) return false;
    const struct system s = { .seams = &closing->seams,
                              .before = numbers,
                              .x = numbers + count,
                              .r = numbers + 2 * count,
                              .d = numbers + 3 * count,
                              .q = numbers + 4 * count };
    for (int channel = 0; channel < 3; channel++) close_channel(map, &s, channel);
    host_free(map->host, numbers);
    return true;
}
