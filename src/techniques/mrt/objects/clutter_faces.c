// Parts of charts in blocks, merged into faces. The largest parts of a block begin a face; each
// other one joins the face whose place and normal are nearest to its own.
#include "techniques/mrt/objects/clutter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A sort key of texels: by block, then by side of a chart or face.
struct texel_place {
    int block;
    uint32_t group, texel;
};

// Texels of a side of a chart in a block.
struct piece {
    int block, face;
    uint32_t side, first, count; // of the sorted texels
    float area_m2;
    vec3s centre, normal;
};

struct builder {
    struct mrt_clutter *clutter;
    const struct mrt_block_map *map;
    struct texel_place *places;
    struct piece *pieces;
    uint32_t piece_count;
};

// Sides of charts: twice the chart, and 1 more for the back.
static uint32_t side_of(uint32_t chart, bool back)
{
    return 2 * chart + back;
}

static vec3s side_normal(const struct charts *charts, uint32_t side)
{
    const vec3s normal = charts->charts[side / 2].normal;
    return side % 2 ? glms_vec3_negate(normal) : normal;
}

// ---- blocks of texels

// The block of a point; outside all blocks, the one whose middle is nearest.
static int block_of(const struct mrt_block_map *map, vec3s position)
{
    vec3s cell;
    int nearest = mrt_block_of_point(map, position, &cell);
    float least = INFINITY;
    if (nearest >= 0) return nearest;
    for (int b = 0; b < map->count; b++) {
        const vec3s middle = mrt_warp_point(map->blocks[b].corner, glms_vec3_zero());
        const float distance2 = glms_vec3_distance2(position, middle);
        if (!(distance2 < least)) continue;
        least = distance2;
        nearest = b;
    }
    return nearest < 0 ? 0 : nearest;
}

static int compare_places(const void *a, const void *b)
{
    const struct texel_place *p = a, *q = b;
    if (p->block != q->block) return p->block < q->block ? -1 : 1;
    if (p->group != q->group) return p->group < q->group ? -1 : 1;
    return p->texel < q->texel ? -1 : p->texel > q->texel;
}

static void place_side(const struct builder *s, uint32_t chart, uint32_t first, bool back)
{
    const struct charts *charts = &s->clutter->charts;
    for (uint32_t texel = first; texel < first + charts->charts[chart].texel_count; texel++)
        s->places[texel] =
            (struct texel_place){ block_of(s->map, chart_texel_of(charts, texel)->position),
                                  side_of(chart, back), texel };
}

static void place_texels(const struct builder *s)
{
    const struct charts *charts = &s->clutter->charts;
    for (uint32_t c = 0; c < charts->count; c++) {
        place_side(s, c, charts->charts[c].first_texel, false);
        if (charts->charts[c].first_back != CHART_NONE)
            place_side(s, c, charts->charts[c].first_back, true);
    }
    qsort(s->places, charts->side_texel_count, sizeof *s->places, compare_places);
}

// ---- pieces

static void add_to_piece(struct piece *piece, const struct chart_texel *texel)
{
    piece->count++;
    piece->area_m2 += texel->area_m2;
    piece->centre = glms_vec3_muladds(texel->position, texel->area_m2, piece->centre);
}

static void make_pieces(struct builder *s)
{
    const struct charts *charts = &s->clutter->charts;
    struct piece *last = NULL;
    for (uint32_t i = 0; i < charts->side_texel_count; i++) {
        const struct texel_place *place = &s->places[i];
        if (!last || last->block != place->block || last->side != place->group) {
            last = &s->pieces[s->piece_count++];
            *last = (struct piece){ .block = place->block,
                                    .side = place->group,
                                    .first = i,
                                    .normal = side_normal(charts, place->group) };
        }
        add_to_piece(last, chart_texel_of(charts, place->texel));
    }
    for (uint32_t i = 0; i < s->piece_count; i++)
        s->pieces[i].centre = glms_vec3_divs(s->pieces[i].centre, s->pieces[i].area_m2);
}

// By block, then descending area.
static int compare_pieces(const void *a, const void *b)
{
    const struct piece *p = a, *q = b;
    if (p->block != q->block) return p->block < q->block ? -1 : 1;
    if (p->area_m2 != q->area_m2) return p->area_m2 > q->area_m2 ? -1 : 1;
    return p->side < q->side ? -1 : p->side > q->side;
}

static float edge2_of(const struct mrt_block *block)
{
    const mat3s j = mrt_warp_jacobian(block->corner, glms_vec3_zero());
    return powf(fabsf(glms_mat3_det(j)), 2.0f / 3.0f);
}

// Relative to the edge of a block, and to a right angle.
static float difference(const struct piece *a, const struct piece *b, float edge2)
{
    return glms_vec3_distance2(a->centre, b->centre) / edge2 + 1.0f -
           glms_vec3_dot(a->normal, b->normal);
}

static int nearest_face(const struct piece *begun, int count, const struct piece *piece,
                        float edge2)
{
    int nearest = 0;
    for (int k = 1; k < count; k++)
        if (difference(&begun[k], piece, edge2) < difference(&begun[nearest], piece, edge2))
            nearest = k;
    return begun[nearest].face;
}

static int number_faces(const struct builder *s, int max_faces)
{
    int faces = 0;
    for (uint32_t first = 0, i = 0; i < s->piece_count; i++) {
        struct piece *piece = &s->pieces[i];
        if (piece->block != s->pieces[first].block) first = i;
        if (i - first < (uint32_t)max_faces)
            piece->face = faces++;
        else
            piece->face = nearest_face(&s->pieces[first], max_faces, piece,
                                       edge2_of(&s->map->blocks[piece->block]));
    }
    return faces;
}

// ---- faces

static bool fill_faces(const struct builder *s)
{
    struct mrt_clutter *clutter = s->clutter;
    const uint32_t count = clutter->charts.side_texel_count;
    struct texel_place *order = host_alloc(clutter->host, count, sizeof *order);
    if (!order) return false;
    for (uint32_t i = 0; i < s->piece_count; i++) {
        const struct piece *piece = &s->pieces[i];
        clutter->faces[piece->face].block = piece->block;
        for (uint32_t t = 0; t < piece->count; t++)
            clutter->face_of_texel[s->places[piece->first + t].texel] = piece->face;
    }
    for (uint32_t t = 0; t < count; t++) {
        const int face = clutter->face_of_texel[t];
        order[t] = (struct texel_place){ clutter->faces[face].block, (uint32_t)face, t };
    }
    qsort(order, count, sizeof *order, compare_places);
    for (uint32_t i = 0; i < count; i++) {
        struct mrt_clutter_face *face = &clutter->faces[order[i].group];
        clutter->texels[i] = order[i].texel;
        if (face->texel_count++ == 0) face->first_texel = i;
    }
    host_free(clutter->host, order);
    return true;
}

static bool fill_chart_faces(const struct builder *s)
{
    struct mrt_clutter *clutter = s->clutter;
    const size_t sides = mrt_chart_sides(clutter);
    uint32_t *first = host_alloc(clutter->host, sides + 1, sizeof *first);
    clutter->first_chart_face = first;
    clutter->chart_faces = host_alloc(clutter->host, s->piece_count, sizeof *clutter->chart_faces);
    if (!first || !clutter->chart_faces) return false;
    for (uint32_t i = 0; i < s->piece_count; i++) first[s->pieces[i].side + 1]++;
    for (size_t c = 0; c < sides; c++) first[c + 1] += first[c];
    for (uint32_t i = s->piece_count; i > 0; i--) {
        const struct piece *piece = &s->pieces[i - 1];
        clutter->chart_faces[--first[piece->side + 1]] =
            (struct mrt_chart_face){ piece->block, piece->face };
    }
    // Each entry is now the first of its own side, one place too late.
    for (size_t c = 0; c < sides; c++) first[c] = first[c + 1];
    first[sides] = s->piece_count;
    return true;
}

// scene_chart_triangle numbers the objects' triangles until now.
static void index_triangles(struct mrt_clutter *clutter)
{
    const size_t count = clutter->scene_triangle_0[clutter->objects.scene.instance_count];
    uint32_t *of_scene = clutter->scene_chart_triangle;
    for (size_t i = 0; i < count; i++)
        if (of_scene[i] != CHART_NONE) of_scene[i] = clutter->charts.chart_triangle[of_scene[i]];
}

static bool make_faces(struct builder *s, int max_faces)
{
    struct mrt_clutter *clutter = s->clutter;
    place_texels(s);
    make_pieces(s);
    qsort(s->pieces, s->piece_count, sizeof *s->pieces, compare_pieces);
    clutter->face_count = number_faces(s, max_faces);
    clutter->faces = host_alloc(clutter->host, (size_t)clutter->face_count, sizeof *clutter->faces);
    if (!clutter->faces) return false;
    index_triangles(clutter);
    return fill_faces(s) && fill_chart_faces(s);
}

bool mrt_make_clutter_faces(struct mrt_clutter *clutter, const struct mrt_block_map *map,
                            int max_faces)
{
    const size_t texels = clutter->charts.side_texel_count;
    struct host *host = clutter->host;
    struct builder s = { .clutter = clutter, .map = map };
    s.places = host_alloc(host, texels, sizeof *s.places);
    s.pieces = host_alloc(host, texels, sizeof *s.pieces);
    clutter->texels = host_alloc(host, texels, sizeof *clutter->texels);
    clutter->face_of_texel = host_alloc(host, texels, sizeof *clutter->face_of_texel);
    const bool ok = s.places && s.pieces && clutter->texels && clutter->face_of_texel &&
                    make_faces(&s, max_faces);
    host_free(host, s.places);
    host_free(host, s.pieces);
    return ok;
}

size_t mrt_chart_sides(const struct mrt_clutter *clutter)
{
    return 2 * (size_t)clutter->charts.count;
}

int mrt_face_of_chart(const struct mrt_clutter *clutter, int block, uint32_t chart, bool back)
{
    const uint32_t side = side_of(chart, back);
    for (uint32_t i = clutter->first_chart_face[side]; i < clutter->first_chart_face[side + 1]; i++)
        if (clutter->chart_faces[i].block == block) return clutter->chart_faces[i].face;
    return -1;
}

// Whether a hit is one of a side of its own.
static bool hits_back(const struct charts *charts, const struct trace_hit *hit, uint32_t chart)
{
    return !hit->front && charts->charts[chart].first_back != CHART_NONE;
}

static uint32_t chart_of_hit(const struct charts *charts, const struct trace_hit *hit)
{
    const uint32_t index =
        charts->chart_triangle[charts->triangle_0[hit->instance] + hit->triangle];
    return index == CHART_NONE ? CHART_NONE : charts->triangles[index].chart;
}

bool mrt_is_inside_at(const struct mrt_clutter *clutter, const struct trace_hit *hit)
{
    const struct scene *objects = &clutter->objects.scene;
    const int material = scene_mesh_of(objects, hit->instance)->material;
    return !hit->front && !objects->materials[material].double_sided;
}

int mrt_face_of_hit(const struct mrt_clutter *clutter, int block, const struct trace_hit *hit)
{
    const struct charts *charts = &clutter->charts;
    const uint32_t chart = chart_of_hit(charts, hit);
    if (chart == CHART_NONE) return -1;
    return mrt_face_of_chart(clutter, block, chart, hits_back(charts, hit, chart));
}

int mrt_face_at(const struct mrt_clutter *clutter, const struct trace_hit *hit)
{
    const struct charts *charts = &clutter->charts;
    const uint32_t chart = chart_of_hit(charts, hit);
    const bool back = chart != CHART_NONE && hits_back(charts, hit, chart);
    const uint32_t texel =
        chart_texel_at(charts, hit->instance, hit->triangle, hit->u, hit->v, back);
    return texel == CHART_NONE ? -1 : clutter->face_of_texel[texel];
}
