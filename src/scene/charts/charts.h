// Charts: a parameterisation of a pose's triangles without overlaps, in one atlas, for light maps.
// Each instance has charts of its own. A mesh whose TEXCOORD_1, or another set of coordinates, is a
// valid unwrap (unwrap.h) keeps its islands, each scaled to the density; triangles of other meshes
// are clustered by normal, connected, and projected onto planes.
//
// Around the texels that a chart's surface touches is a gutter of CHART_GUTTER texels, for bilinear
// lookups. Texels and gutters of charts do not overlap, but their rectangles may: `owner` tells
// whose a place is. Charts are turned by quarters. Coordinates in the atlas are in texels, centres
// at ½; its sides are multiples of eight.
//
// Charts that would fit in a texel may be joined to single-texel charts: all corners are at the
// centre of the texel.
//
// An atlas may be divided into pages (pages.c), each an image for an engine: all charts of an
// instance lie on one of them.
#pragma once

#include "scene/pose.h"

enum { CHART_GUTTER = 1, CHART_MAX_SIDE = 16384 };
// Sides of the atlas and of pages: images of such sizes have whole blocks of compression formats,
// at half size, too.
enum { CHART_SIDE_MULTIPLE = 8 };
#define CHART_NONE UINT32_MAX

// Normals within a chart of clusters differ from its plane's by at most acos of this. Lengths are
// therefore shortened, and areas, by at most this factor.
#define CHART_MIN_COSINE 0.75f

// Small charts that share a single-texel chart: they fit in a texel, are visible from each other
// within a texel's length, and have similar normals.
enum charts_join {
    CHARTS_APART,         // none; there are no single-texel charts
    CHARTS_JOINED,        // those of an instance
    CHARTS_JOINED_ACROSS, // those of all instances, if all or none are double-sided
};

// The texture coordinates whose islands a mesh keeps, where they are a valid unwrap.
enum charts_coordinates {
    CHARTS_TEXCOORD_1,
    CHARTS_TEXCOORD_0,      // FAIL_UNSUPPORTED names a mesh where they are not
    CHARTS_TEXCOORD_0_OR_1, // the first valid ones
    CHARTS_NO_TEXCOORD,     // none: charts of normals
};

struct charts_options {
    float texels_per_m;  // wanted; the density is lowered until the atlas fits
    uint32_t max_texels; // width × height of the atlas
    // [scene_triangle_count], instance after instance: triangles to have charts. NULL: all.
    const bool *chosen;
    // Wanted area of the surface in texels; charts touch more texels. 0: no wish.
    uint32_t surface_texels;
    enum charts_join join;
    enum charts_coordinates coordinates;
    // For the message where charts do not fit: texels of the atlas for one of the option `texels`,
    // the maximum of that option, and of charts. 0: there is no such option.
    uint32_t atlas_per_texel, most_texels, most_charts;
};

struct chart {
    int instance;   // of a single-texel chart: of its first triangle
    bool unwrapped; // an island of texture coordinates
    bool single_texel;
    uint32_t first_triangle, triangle_count;
    uint32_t first_texel, texel_count;
    uint32_t first_back;          // of the texels of both sides; CHART_NONE: it has no back
    uint32_t x, y, width, height; // gutters included
    uint32_t turns;               // quarter turns by which it was packed
    uint32_t page;                // of the atlas
    float area_m2;
    vec3s normal; // unit; the plane's for clusters, the mean for islands
};

struct chart_triangle {
    int instance;
    uint32_t triangle; // of the instance's mesh
    uint32_t chart;
    vec3s corner[3];        // world, in the order of the mesh's indices
    vec3s vertex_normal[3]; // of the corners, in the frame of the mesh, not deformed
    vec3s normal;           // unit, of the front
    float area_m2;
    vec2s place[3]; // of the corners, in the atlas
};

// A texel that the surface touches. Areas of all texels sum to the area of all triangles.
struct chart_texel {
    uint32_t x, y;
    uint32_t triangle; // in charts.triangles: the one with the largest part of the texel
    float u, v;        // barycentric weights of its second and third corner
    vec3s position;    // world, on that triangle and inside the texel: of that part's middle
    float area_m2;     // of the surface inside the texel, all triangles
    vec3s centroid;    // world, of the same surface; beside it where that is curved
};

// Its place in the atlas. Pages do not overlap.
struct chart_page {
    uint32_t x, y, width, height;
};

// The end of a search for charts of a number of texels. surface_texels 0: there was none.
struct charts_search {
    uint32_t surface_texels;
    bool across; // CHARTS_JOINED_ACROSS
};

struct charts {
    struct host *host;
    struct charts_search search; // of charts_init_wanted
    float texels_per_m;          // reached
    uint32_t width, height;
    struct chart *charts;
    uint32_t count;
    struct chart_triangle *triangles; // chart after chart
    uint32_t triangle_count;
    // Chart after chart; in each row by row, or in squares (squares.h).
    struct chart_texel *texels;
    uint32_t texel_count;
    // Texels of both sides: those of all fronts, in the order of `texels`, then the backs of charts
    // with a double-sided material.
    uint32_t side_texel_count;
    uint32_t *front_of; // [side_texel_count − texel_count] the front of a back, in `texels`
    // [width × height] the texel whose value an atlas texel has: its own, in gutters the nearest of
    // the same chart, CHART_NONE elsewhere.
    uint32_t *owner;
    size_t *triangle_0;       // [instances + 1] first triangle of an instance, in chart_triangle
    uint32_t *chart_triangle; // [triangles of the scene] in `triangles`; CHART_NONE: in no chart
    uint32_t without_area;    // chosen triangles that are in no chart
    struct chart_page *pages; // [page_count]; NULL: the atlas is the only one
    uint32_t page_count;
};

// Deterministic. A warning, one for a scene, names the meshes whose TEXCOORD_1 cannot be used.
// FAIL_MEMORY where no density fits. charts_finish accepts zero.
bool charts_init(struct charts *out, struct host *host, const struct scene_pose *pose,
                 const struct charts_options *options);
void charts_finish(struct charts *charts);
// instance_count: of the scene.
bool charts_copy(struct charts *out, const struct charts *from, int instance_count);
// The place of a texel in its chart's own frame, gutters included: it does not depend on where
// other charts are packed.
struct chart_place {
    uint32_t x, y;
};
static inline struct chart_place chart_own_place(const struct chart *chart,
                                                 const struct chart_texel *texel)
{
    const uint32_t x = texel->x - chart->x, y = texel->y - chart->y;
    const uint32_t right = chart->width - 1 - x, below = chart->height - 1 - y;
    const struct chart_place turned[4] = { { x, y }, { y, right }, { right, below }, { below, x } };
    return turned[chart->turns];
}
// Bounds of the triangles in charts.
struct box3 charts_bounds(const struct charts *charts);

// Charts for the light map of a technique.
struct charts_wish {
    const char *technique; // in messages
    uint32_t texels;       // wanted number of both sides, without gutters; reached within an eighth
    float density;         // texels/m, in place of `texels`; 0: not given
    float most_density;    // texels/m, even if there are fewer than `texels`; 0: any
    uint32_t most_charts;
    enum charts_coordinates coordinates;
    // The end of an earlier search with these options, for a surface of the same area: this one
    // begins there. NULL: at the start.
    const struct charts_search *begin;
};
bool charts_init_wanted(struct charts *out, struct host *host, const struct scene_pose *pose,
                        const struct charts_wish *wish);

// ---- pages.c

enum { CHART_LEAST_PAGE = 64 };

static inline uint32_t charts_page_count(const struct charts *charts)
{
    return charts->pages ? charts->page_count : 1;
}

static inline struct chart_page charts_page(const struct charts *charts, uint32_t page)
{
    return charts->pages ? charts->pages[page]
                         : (struct chart_page){ .width = charts->width, .height = charts->height };
}

// Places of all pages.
static inline double charts_page_places(const struct charts *charts)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < charts_page_count(charts); i++) {
        const struct chart_page page = charts_page(charts, i);
        sum += (double)page.width * page.height;
    }
    return sum;
}

// Texels over places of the pages.
static inline float charts_utilisation(const struct charts *charts)
{
    const double places = charts_page_places(charts);
    return places > 0.0 ? (float)((double)charts->texel_count / places) : 0.0f;
}

// Moves the charts onto pages of `side` places' width, a multiple of CHART_SIDE_MULTIPLE; the last
// page may be less high. An atlas that fits on one page stays the same. Charts keep their
// orientation, and texels keep their numbers. FAIL_MEMORY names an instance that does not fit on a
// page.
bool charts_set_pages(struct charts *charts, const struct scene *scene, uint32_t side);

// ---- sides.c: texels of both sides

static inline bool chart_is_back(const struct charts *charts, uint32_t texel)
{
    return texel >= charts->texel_count;
}

// In `texels`.
static inline uint32_t chart_front(const struct charts *charts, uint32_t texel)
{
    return chart_is_back(charts, texel) ? charts->front_of[texel - charts->texel_count] : texel;
}

static inline const struct chart_texel *chart_texel_of(const struct charts *charts, uint32_t texel)
{
    return &charts->texels[chart_front(charts, texel)];
}

static inline const struct chart_triangle *chart_triangle_of(const struct charts *charts,
                                                             uint32_t texel)
{
    return &charts->triangles[chart_texel_of(charts, texel)->triangle];
}

// The normal of a texel's triangle, of the texel's side.
static inline vec3s chart_texel_normal(const struct charts *charts, uint32_t texel)
{
    const vec3s normal = chart_triangle_of(charts, texel)->normal;
    return chart_is_back(charts, texel) ? glms_vec3_negate(normal) : normal;
}

// The texel at a point of a triangle of the scene; CHART_NONE: it is in no chart, or has no back.
uint32_t chart_texel_at(const struct charts *charts, int instance, uint32_t triangle, float u,
                        float v, bool back);
// Places of the light map, (side · height + y) · width + x.
static inline uint32_t charts_sides(const struct charts *charts)
{
    return charts->side_texel_count > charts->texel_count ? 2 : 1;
}
static inline size_t charts_place_count(const struct charts *charts)
{
    return (size_t)charts_sides(charts) * charts->width * charts->height;
}
// The texel of a place; CHART_NONE: none.
uint32_t chart_texel_of_place(const struct charts *charts, size_t place);
// [side_texel_count] nearest valid texel of each: itself, or where `hidden` the nearest on the same
// side of its chart that is not; itself where all are. Owned by the caller.
uint32_t *charts_fill(const struct charts *charts, const bool *hidden);
