// Draws the balls that show probes.
#include "overlay.h"

#include "viewer/inspect/probe_balls.h"

enum { MOST_INDICES = 8192 };

// Three indices of each triangle.
static int triangles_of(const struct ball *ball, int *out)
{
    const int n = ball->segments;
    int count = 0;
    for (int k = 0; k < n; k++) {
        const int next = (k + 1) % n;
        const int fan[3] = { 0, 1 + k, 1 + next };
        for (int i = 0; i < 3; i++) out[count++] = fan[i];
        for (int ring = 1; ring < ball->rings; ring++) {
            const int inner = 1 + (ring - 1) * n, outer = inner + n;
            const int two[6] = { inner + k, outer + k,    outer + next,
                                 inner + k, outer + next, inner + next };
            for (int i = 0; i < 6; i++) out[count++] = two[i];
        }
    }
    return count;
}

void overlay_probes(struct viewer *v)
{
    const struct probe_balls *b = &v->probe_balls;
    int indices[MOST_INDICES];
    if (!b->shown) return;
    probe_balls_update(v);
    for (int i = 0; i < b->count; i++) {
        const struct ball *ball = &b->balls[i];
        const int count = triangles_of(ball, indices);
        ui_triangles(b->vertices + ball->first, 1 + ball->rings * ball->segments, indices, count);
    }
}
