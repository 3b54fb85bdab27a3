// Rays just above the surface tell which sample points a part of a texel sees, and where the wall
// is that hides the others.
#include "trace/texels/walls.h"

#include "trace/trace_scene.h"

#include <math.h>

enum { AROUND = 9, MIDDLE = 4, MOST_TRIANGLES = 16, ACROSS = 8, POINTS_TRIED = 4 };

struct search {
    const struct trace_scene *scene;
    const struct charts *charts;
    const struct texel_point *points;
    uint32_t texel;
    uint32_t around[AROUND]; // 3 · row + column; CHART_NONE: none of the chart
    const struct chart_triangle *triangles[MOST_TRIANGLES];
    int triangle_count;
};

// ---- points

static vec3s sample_of(const struct search *s, int at)
{
    return s->points[s->around[at]].position;
}

static bool is_open(const struct search *s, int at)
{
    return s->around[at] != CHART_NONE && s->points[s->around[at]].share > 0.0f;
}

static bool sees(const struct search *s, vec3s from, vec3s to)
{
    return texel_sees(s->scene, s->charts, s->texel, from, to);
}

static void find_around(struct search *s)
{
    const struct charts *charts = s->charts;
    const struct chart_texel *t = chart_texel_of(charts, s->texel);
    const uint32_t chart = chart_triangle_of(charts, s->texel)->chart;
    const size_t side = chart_is_back(charts, s->texel) ? charts->height : 0;
    for (int i = 0; i < AROUND; i++) {
        const int64_t x = (int64_t)t->x + i % 3 - 1, y = (int64_t)t->y + i / 3 - 1;
        s->around[i] = CHART_NONE;
        if (x < 0 || y < 0 || x >= charts->width || y >= charts->height) continue;
        const uint32_t texel =
            chart_texel_of_place(charts, (side + (size_t)y) * charts->width + (size_t)x);
        if (texel != CHART_NONE && chart_triangle_of(charts, texel)->chart == chart)
            s->around[i] = texel;
    }
    s->around[MIDDLE] = s->texel;
}

static bool meets(const struct chart_triangle *c, const struct chart_texel *t)
{
    const vec2s low = glms_vec2_minv(glms_vec2_minv(c->place[0], c->place[1]), c->place[2]);
    const vec2s high = glms_vec2_maxv(glms_vec2_maxv(c->place[0], c->place[1]), c->place[2]);
    return high.x >= (float)t->x && low.x <= (float)t->x + 1.0f && high.y >= (float)t->y &&
           low.y <= (float)t->y + 1.0f;
}

static void find_triangles(struct search *s)
{
    const struct charts *charts = s->charts;
    const struct chart_texel *t = chart_texel_of(charts, s->texel);
    const struct chart *chart = &charts->charts[charts->triangles[t->triangle].chart];
    s->triangles[s->triangle_count++] = &charts->triangles[t->triangle];
    for (uint32_t i = 0; i < chart->triangle_count && s->triangle_count < MOST_TRIANGLES; i++) {
        const struct chart_triangle *c = &charts->triangles[chart->first_triangle + i];
        if (c != s->triangles[0] && meets(c, t)) s->triangles[s->triangle_count++] = c;
    }
}

// The surface at a place of the texel, from its centre. False: the chart has none there.
static bool point_on_surface(const struct search *s, const float p[2], vec3s *out)
{
    const struct chart_texel *t = chart_texel_of(s->charts, s->texel);
    for (int i = 0; i < s->triangle_count; i++) {
        const struct chart_triangle *c = s->triangles[i];
        float u, v;
        if (!texel_weigh(c, (float)t->x + 0.5f + p[0], (float)t->y + 0.5f + p[1], &u, &v)) continue;
        *out = glms_vec3_scale(c->corner[0], 1.0f - u - v);
        *out = glms_vec3_muladds(c->corner[1], u, *out);
        *out = glms_vec3_muladds(c->corner[2], v, *out);
        return true;
    }
    return false;
}

// ---- the line

// The plane of the texel's triangle: centre + p.x x + p.y y, p in texels.
struct plane {
    vec3s centre, x, y;
};

static struct plane plane_of(const struct search *s)
{
    const struct chart_texel *t = chart_texel_of(s->charts, s->texel);
    const struct chart_triangle *c = s->triangles[0];
    const vec2s a = glms_vec2_sub(c->place[1], c->place[0]);
    const vec2s b = glms_vec2_sub(c->place[2], c->place[0]);
    const vec3s to_a = glms_vec3_sub(c->corner[1], c->corner[0]);
    const vec3s to_b = glms_vec3_sub(c->corner[2], c->corner[0]);
    const float per_area = 1.0f / (a.x * b.y - a.y * b.x);
    struct plane plane = {
        .x = glms_vec3_scale(glms_vec3_sub(glms_vec3_scale(to_a, b.y), glms_vec3_scale(to_b, a.y)),
                             per_area),
        .y = glms_vec3_scale(glms_vec3_sub(glms_vec3_scale(to_b, a.x), glms_vec3_scale(to_a, b.x)),
                             per_area)
    };
    plane.centre = glms_vec3_muladds(plane.x, (float)t->x + 0.5f - c->place[0].x, c->corner[0]);
    plane.centre = glms_vec3_muladds(plane.y, (float)t->y + 0.5f - c->place[0].y, plane.centre);
    return plane;
}

struct line {
    float normal[2], offset;
    vec3s wall, at; // the wall's normal, and a point of it
    bool found;
};

// The line in which a wall with this normal that contains `at` meets the plane.
static struct line line_of(const struct plane *plane, vec3s normal, vec3s at)
{
    struct line line = { .normal = { glms_vec3_dot(normal, plane->x),
                                     glms_vec3_dot(normal, plane->y) },
                         .wall = normal,
                         .at = at };
    const float length = hypotf(line.normal[0], line.normal[1]);
    line.offset = glms_vec3_dot(normal, glms_vec3_sub(at, plane->centre)) / length;
    for (int a = 0; a < 2; a++) line.normal[a] /= length;
    line.found = isfinite(line.offset) && isfinite(line.normal[0]) && isfinite(line.normal[1]);
    return line;
}

// The point at which a ray above the surface meets a wall, brought down to the surface.
static bool hit_on_way(const struct search *s, vec3s from, vec3s to, vec3s *at, vec3s *normal)
{
    const vec3s way = glms_vec3_sub(to, from);
    const struct ray ray = { texel_above(s->charts, s->texel, from), way, 0.0f, 1.0f };
    struct ray_hit hit;
    if (!embree_closest(s->scene->embree, &ray, NULL, false, &hit)) return false;
    *at = glms_vec3_muladds(way, hit.distance, from);
    *normal = s->scene->meshes[hit.geometry].facets[hit.triangle].normal;
    return true;
}

// A wall between two sample points is in the middle of its faces, of a single sheet at it. Keeps
// the line nearest to the texel's centre.
static void add_wall(const struct search *s, const struct plane *plane, int a, int b,
                     struct line *line)
{
    const vec3s from = sample_of(s, a), to = sample_of(s, b);
    vec3s near, far, normal, other;
    if (sees(s, from, to) || !hit_on_way(s, from, to, &near, &normal)) return;
    if (!hit_on_way(s, to, from, &far, &other)) far = near;
    const struct line wall = line_of(plane, normal, glms_vec3_lerp(near, far, 0.5f));
    if (wall.found && (!line->found || fabsf(wall.offset) < fabsf(line->offset))) *line = wall;
}

static struct line find_line(const struct search *s)
{
    const struct plane plane = plane_of(s);
    struct line line = { .found = false };
    for (int i = 0; i < AROUND; i++) {
        const int other = is_open(s, MIDDLE) ? MIDDLE : AROUND - 1 - i;
        if (i == other || !is_open(s, other) || s->around[i] == CHART_NONE) continue;
        add_wall(s, &plane, other, i, &line);
    }
    return line;
}

// ---- lookups

// Finds the texels around that are open and seen from above `at`. Returns their number.
static int find_seen(const struct search *s, vec3s at, bool seen[AROUND])
{
    int count = 0;
    for (int i = 0; i < AROUND; i++) {
        seen[i] = is_open(s, i) && sees(s, at, sample_of(s, i));
        count += seen[i];
    }
    return count;
}

// Those on a side of the line.
static void find_beside(const struct search *s, const struct line *line, int side,
                        bool beside[AROUND])
{
    for (int i = 0; i < AROUND; i++) {
        beside[i] = is_open(s, i);
        if (!beside[i]) continue;
        const vec3s from = glms_vec3_sub(s->points[s->around[i]].position, line->at);
        beside[i] = (glms_vec3_dot(line->wall, from) > 0.0f) == side;
    }
}

struct candidate {
    vec3s at;
    float distance; // from the line
};

static void insert(struct candidate *list, int *count, struct candidate c)
{
    int at = *count;
    while (at > 0 && list[at - 1].distance < c.distance) at--;
    if (at == POINTS_TRIED) return;
    if (*count < POINTS_TRIED) ++*count;
    for (int i = *count - 1; i > at; i--) list[i] = list[i - 1];
    list[at] = c;
}

// Points of a quarter on one side of the line, the farthest from it first.
static int find_points(const struct search *s, const struct line *line, int side, int quarter,
                       struct candidate out[POINTS_TRIED])
{
    int count = 0;
    for (int i = 0; i < ACROSS / 2 * (ACROSS / 2); i++) {
        const int column = i % (ACROSS / 2) + (quarter & 1) * ACROSS / 2;
        const int row = i / (ACROSS / 2) + (quarter >> 1) * ACROSS / 2;
        const float p[2] = { ((float)column + 0.5f) / ACROSS - 0.5f,
                             ((float)row + 0.5f) / ACROSS - 0.5f };
        const float along = line->normal[0] * p[0] + line->normal[1] * p[1] - line->offset;
        struct candidate c = { .distance = line->found ? fabsf(along) : 1.0f };
        if (line->found ? (along > 0.0f) != side : side == 1) continue;
        if (point_on_surface(s, p, &c.at)) insert(out, &count, c);
    }
    return count;
}

// Texels that a lookup reads along an axis, −1…1 from this one. Without `stays` exactly one.
struct reads {
    int first, last;
    int cost;
};

static struct reads reads_of(enum texel_lookup lookup, int after)
{
    const struct reads stays = { after ? 0 : -1, after ? 1 : 0, 0 };
    switch (lookup) {
    case LOOKUP_STAYS:
        return stays;
    case LOOKUP_BEFORE:
        return (struct reads){ -1, -1, after ? 4 : 2 };
    case LOOKUP_CENTRE:
        return (struct reads){ 0, 0, 1 };
    case LOOKUP_AFTER:
        break;
    }
    return (struct reads){ 1, 1, after ? 2 : 4 };
}

// Texels that the chart does not have are read without a weight, where a lookup stays.
static bool all_seen(const struct search *s, const bool seen[AROUND], struct reads x,
                     struct reads y)
{
    bool any = false;
    for (int row = y.first; row <= y.last; row++)
        for (int column = x.first; column <= x.last; column++) {
            const int i = 3 * (row + 1) + column + 1;
            if (s->around[i] != CHART_NONE && !seen[i]) return false;
            any |= seen[i];
        }
    return any;
}

// The lookup of least displacement that reads seen texels alone.
static void choose(const struct search *s, const bool seen[AROUND], int quarter, uint8_t out[2])
{
    int least = INT32_MAX;
    for (int i = 0; i < 16; i++) {
        const struct reads x = reads_of((enum texel_lookup)(i % 4), quarter & 1);
        const struct reads y = reads_of((enum texel_lookup)(i / 4), quarter >> 1);
        if (x.cost + y.cost >= least || !all_seen(s, seen, x, y)) continue;
        least = x.cost + y.cost;
        out[0] = (uint8_t)(i % 4);
        out[1] = (uint8_t)(i / 4);
    }
}

// A strip beside a wall that is narrower than the distance of points has the texels on its side.
static void find_lookup(const struct search *s, const struct line *line, int side, int quarter,
                        uint8_t out[2])
{
    struct candidate points[POINTS_TRIED];
    bool seen[AROUND];
    const int count = find_points(s, line, side, quarter, points);
    int seen_count = 0;
    for (int i = 0; i < count && seen_count == 0; i++)
        seen_count = find_seen(s, points[i].at, seen);
    if (seen_count == 0 && !line->found) return;
    if (seen_count == 0) find_beside(s, line, side, seen);
    choose(s, seen, quarter, out);
}

static bool is_free(const struct search *s)
{
    bool seen[AROUND];
    find_seen(s, s->points[s->texel].position, seen);
    bool all = s->points[s->texel].share == 1.0f;
    for (int i = 0; i < AROUND; i++) all &= s->around[i] == CHART_NONE || seen[i];
    return all;
}

struct texel_wall texel_find_wall(const struct trace_scene *scene, const struct charts *charts,
                                  const struct texel_point *points, uint32_t texel)
{
    struct search s = { .scene = scene, .charts = charts, .points = points, .texel = texel };
    struct texel_wall wall = { .offset = 1.0f };
    if (charts->charts[chart_triangle_of(charts, texel)->chart].single_texel) return wall;
    find_around(&s);
    if (is_free(&s)) return wall;
    find_triangles(&s);
    const struct line line = find_line(&s);
    for (int side = 0; side < WALL_SIDES; side++)
        for (int quarter = 0; quarter < WALL_QUARTERS; quarter++)
            find_lookup(&s, &line, side, quarter, wall.lookup[side][quarter]);
    if (!line.found) return wall;
    for (int a = 0; a < 2; a++) wall.normal[a] = line.normal[a];
    wall.offset = line.offset;
    return wall;
}

// ---- middles of texels

static vec3s middle_of(const struct search *s, int at)
{
    return chart_texel_of(s->charts, s->around[at])->position;
}

bool texel_is_beside_wall(const struct trace_scene *scene, const struct charts *charts,
                          uint32_t texel)
{
    struct search s = { .scene = scene, .charts = charts, .texel = texel };
    find_around(&s);
    for (int i = 0; i < AROUND; i++)
        if (s.around[i] != CHART_NONE && !sees(&s, middle_of(&s, MIDDLE), middle_of(&s, i)))
            return true;
    return false;
}

uint32_t texel_before_wall(const struct trace_scene *scene, const struct charts *charts,
                           uint32_t texel, vec3s at)
{
    static const int ORDER[AROUND] = { MIDDLE, 3, 5, 1, 7, 0, 2, 6, 8 };
    struct search s = { .scene = scene, .charts = charts, .texel = texel };
    find_around(&s);
    for (int i = 0; i < AROUND; i++)
        if (s.around[ORDER[i]] != CHART_NONE && sees(&s, at, middle_of(&s, ORDER[i])))
            return s.around[ORDER[i]];
    return texel;
}
