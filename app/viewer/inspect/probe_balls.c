#include "probe_balls.h"

#include "viewer/camera/vectors.h"
#include "viewer/operations.h"
#include "shell/srgb.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COEFFICIENTS = 27, MOST_RINGS = 16, MOST_SEGMENTS = 64, TONE_WIDTH = 256 };
static const float RADIUS = 0.12f; // of the spacing of probes, as in the debug view
static const float RING_PIXELS = 4.0f, INV_PI = 0.31830989f, TAU = 6.2831853f;
static const uint32_t DARK = 0xb030c0ffu;

bool probe_balls_published(const struct viewer *v)
{
    const char *gi = ag_renderer_gi(v->main.renderer);
    return gi && (strstr(gi, ":probes=true") || strstr(gi, ",probes=true"));
}

// ---- the camera

struct axes {
    float eye[3], right[3], up[3], forward[3];
    float half_x, half_y;    // tangents of half the fields of view
    float pixels, middle[2]; // of the window: of a tangent of 1, and the middle of the image
};

// A unit vector.
static void perpendicular(const float a[3], const float b[3], float out[3])
{
    vec_cross(a, b, out);
    vec_normalize(out);
}

static struct axes axes_of(const struct viewer *v)
{
    const struct ag_camera *camera = &v->camera;
    const struct region r = viewer_region(v);
    struct axes a = { .half_y = tanf(0.5f * camera->vertical_fov_rad) };
    for (int i = 0; i < 3; i++) {
        a.eye[i] = camera->eye[i];
        a.forward[i] = camera->target[i] - camera->eye[i];
    }
    vec_normalize(a.forward);
    perpendicular(a.forward, camera->up, a.right);
    perpendicular(a.right, a.forward, a.up);
    a.half_x = a.half_y * (r.x1 - r.x0) / (r.y1 - r.y0);
    a.pixels = 0.5f * (r.y1 - r.y0) / a.half_y;
    a.middle[0] = 0.5f * (r.x0 + r.x1);
    a.middle[1] = 0.5f * (r.y0 + r.y1);
    return a;
}

// ---- which probes

struct candidate {
    float distance, depth, x, y, radius; // metres; pixels of the window
    float position[3];
    const float *coefficients;
};

struct source {
    const struct ag_probes *probes;
    const struct ag_image *depth;
    struct axes axes;
    float scale, radius; // of the image; metres
    float right;         // end of the image of the method, pixels
};

// A surface is nearer than `depth` there.
static bool hides(const struct source *s, float x, float y, float depth)
{
    const int px = (int)(s->scale * x), py = (int)(s->scale * y);
    if (px < 0 || py < 0 || px >= s->depth->width || py >= s->depth->height) return false;
    const float surface = s->depth->pixels[(size_t)py * (size_t)s->depth->width + (size_t)px];
    return surface > 0 && surface < depth;
}

static bool is_hidden(const struct source *s, const struct candidate *c)
{
    static const float at[5][2] = { { 0, 0 }, { 1, 0 }, { -1, 0 }, { 0, 1 }, { 0, -1 } };
    for (int i = 0; i < 5; i++)
        if (!hides(s, c->x + at[i][0] * c->radius, c->y + at[i][1] * c->radius,
                   c->depth - (i ? 0 : s->radius)))
            return false;
    return true;
}

static bool place(const struct source *s, const int at[3], struct candidate *out)
{
    const struct ag_probes *probes = s->probes;
    float to[3];
    for (int i = 0; i < 3; i++) {
        out->position[i] = probes->first[i] + probes->spacing * (float)at[i];
        to[i] = out->position[i] - s->axes.eye[i];
    }
    out->depth = vec_dot(to, s->axes.forward);
    if (out->depth < probes->spacing) return false; // it would fill the image
    out->distance = sqrtf(vec_dot(to, to));
    const float pixels = s->axes.pixels / out->depth;
    out->radius = pixels * s->radius;
    out->x = s->axes.middle[0] + pixels * vec_dot(to, s->axes.right);
    out->y = s->axes.middle[1] - pixels * vec_dot(to, s->axes.up);
    return out->x > -out->radius && out->x < s->right && out->y > -out->radius &&
           out->y < 2.0f * s->axes.middle[1] + out->radius && !is_hidden(s, out);
}

static int compare(const void *a, const void *b)
{
    const float x = ((const struct candidate *)a)->distance,
                y = ((const struct candidate *)b)->distance;
    return x < y ? -1 : x > y;
}

// Candidates in view, the nearest first, owned by the caller.
static struct candidate *choose(const struct source *s, int *count)
{
    const int *n = s->probes->counts;
    struct candidate *list =
        malloc((size_t)n[0] * (size_t)n[1] * (size_t)n[2] * sizeof(struct candidate));
    int at[3], used = 0;
    for (at[2] = 0; at[2] < n[2] && list; at[2]++)
        for (at[1] = 0; at[1] < n[1]; at[1]++)
            for (at[0] = 0; at[0] < n[0]; at[0]++) {
                const size_t index = (size_t)(at[2] * n[1] + at[1]) * (size_t)n[0] + (size_t)at[0];
                if (!place(s, at, &list[used])) continue;
                list[used++].coefficients = s->probes->coefficients + COEFFICIENTS * index;
            }
    if (list) qsort(list, (size_t)used, sizeof *list, compare);
    *count = list ? used : 0;
    return list;
}

// ---- vertices

// No light, as a probe inside geometry has: its mean is not above 0, or not finite.
static bool is_dark(const struct candidate *c)
{
    const float mean = c->coefficients[0] + c->coefficients[1] + c->coefficients[2];
    return !(mean > 0 && isfinite(mean));
}

static struct ball shape_of(const struct candidate *c, int first)
{
    const int rings = (int)(c->radius / RING_PIXELS) + 1;
    struct ball ball = { first, rings < MOST_RINGS ? rings : MOST_RINGS, MOST_SEGMENTS };
    if (8 + 4 * rings < MOST_SEGMENTS) ball.segments = 8 + 4 * rings;
    ball.rings++; // the transparent one
    return ball;
}

static int vertices_of(const struct ball *ball)
{
    return 1 + ball->rings * ball->segments;
}

// The normal of a ball's vertex, `out` of the middle along the image's axes x and y, each −1…1.
static void normal_at(const struct source *s, const struct candidate *c, float x, float y,
                      float out[3])
{
    float to_eye[3], right[3], up[3];
    const float towards = sqrtf(fmaxf(1.0f - x * x - y * y, 0.0f));
    for (int i = 0; i < 3; i++) to_eye[i] = s->axes.eye[i] - c->position[i];
    vec_normalize(to_eye);
    perpendicular(s->axes.up, to_eye, right);
    perpendicular(to_eye, right, up);
    for (int i = 0; i < 3; i++) out[i] = x * right[i] - y * up[i] + towards * to_eye[i];
}

static void add_ball(const struct source *s, const struct candidate *c, const struct ball *ball,
                     struct ui_vertex *vertices, float *radiance)
{
    const int count = vertices_of(ball), solid = ball->rings - 1;
    const bool dark = is_dark(c);
    for (int i = 0; i < count; i++) {
        const int ring = (i + ball->segments - 1) / ball->segments; // 0: the middle
        const float angle = TAU * (float)(i - 1) / (float)ball->segments;
        const bool edge = ring > solid;
        const float inside = edge ? 1.0f : (float)ring / (float)solid;
        const float out = inside * c->radius + (edge ? 1.0f : 0.0f);
        const float x = ring ? cosf(angle) : 0, y = ring ? sinf(angle) : 0;
        float n[3];
        normal_at(s, c, inside * x, inside * y, n);
        const float front = sqrtf(1.0f - inside * inside);
        vertices[i].x = c->x + out * x;
        vertices[i].y = c->y + out * y;
        const bool hidden = hides(s, vertices[i].x, vertices[i].y, c->depth - front * s->radius);
        vertices[i].rgba = edge || hidden ? 0 : 255; // its colour follows
        if (dark) vertices[i].rgba |= DARK & ~255u;
        ag_probes_irradiance(s->probes, c->position, n, radiance + 3 * i);
        for (int k = 0; k < 3; k++) radiance[3 * i + k] *= dark ? 0 : INV_PI;
    }
}

// Colours as the image shows radiance.
static void expose(struct viewer *v, struct ui_vertex *vertices, int count,
                   const struct ag_image *radiance)
{
    struct ag_image *display = NULL;
    if (!viewer_check(v, ag_image_tonemap_curve(v->desc->context, radiance, viewer_exposure(v),
                                                v->tonemap, &display)))
        return;
    for (int i = 0; i < count; i++) {
        const float *rgb = display->pixels + 3 * (size_t)i;
        if (!(vertices[i].rgba & ~255u))
            vertices[i].rgba |= (uint32_t)srgb_byte(rgb[0]) << 24 |
                                (uint32_t)srgb_byte(rgb[1]) << 16 |
                                (uint32_t)srgb_byte(rgb[2]) << 8;
    }
    ag_image_destroy(v->desc->context, display);
}

static void shade(struct viewer *v, const struct source *s, const struct candidate *list, int count)
{
    struct probe_balls *b = &v->probe_balls;
    struct ag_image *radiance = NULL;
    int total = 0;
    for (int i = 0; i < count; i++) { // the farthest first
        b->balls[i] = shape_of(&list[count - 1 - i], total);
        total += vertices_of(&b->balls[i]);
    }
    struct ui_vertex *vertices = realloc(b->vertices, (size_t)(total + 1) * sizeof *vertices);
    if (vertices) b->vertices = vertices;
    if (!vertices || !viewer_check(v, ag_image_create(v->desc->context, TONE_WIDTH,
                                                      total / TONE_WIDTH + 1, 3, &radiance)))
        return;
    for (int i = 0; i < count; i++) {
        const int first = b->balls[i].first;
        add_ball(s, &list[count - 1 - i], &b->balls[i], vertices + first,
                 radiance->pixels + 3 * (size_t)first);
        b->dark += is_dark(&list[count - 1 - i]);
    }
    expose(v, vertices, total, radiance);
    ag_image_destroy(v->desc->context, radiance);
    b->count = count;
}

// ---- following the image

static void make(struct viewer *v, const struct ag_probes *probes, const struct ag_image *depth)
{
    struct source s = { .probes = probes,
                        .depth = depth,
                        .axes = axes_of(v),
                        .scale = v->scale,
                        .radius = RADIUS * probes->spacing };
    const struct region r = viewer_region(v);
    s.right = r.x0 + viewer_first_share(v) * (r.x1 - r.x0);
    struct candidate *list = choose(&s, &v->probe_balls.in_view);
    const int in_view = v->probe_balls.in_view;
    if (list) shade(v, &s, list, in_view < BALLS_MOST ? in_view : BALLS_MOST);
    free(list);
}

void probe_balls_update(struct viewer *v)
{
    struct probe_balls *b = &v->probe_balls;
    struct ag_probes *probes = NULL;
    struct ag_image *depth = NULL;
    if (b->version == v->version || !v->main.shown.vk_image) return;
    b->count = b->in_view = b->dark = 0;
    if (v->dirty == 0) b->version = v->version;
    if (probe_balls_published(v) &&
        viewer_check(v, ag_renderer_read_probes(v->main.renderer, &probes)) &&
        viewer_check(v, ag_renderer_read(v->main.renderer, "depth", &depth)))
        make(v, probes, depth);
    ag_probes_destroy(v->desc->context, probes);
    ag_image_destroy(v->desc->context, depth);
}

void probe_balls_close(struct viewer *v)
{
    free(v->probe_balls.vertices);
    v->probe_balls.vertices = NULL;
}
