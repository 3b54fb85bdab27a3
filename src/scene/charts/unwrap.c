// The check rasterises all triangles into one bit per texel.
#include "scene/charts/unwrap.h"

#include "scene/charts/raster.h"
#include "scene/charts/triangle_area.h"

#include <math.h>

// Texels along the raster's side: a few for each triangle of a mesh that fills the texture.
static int32_t raster_side(uint32_t triangles)
{
    int32_t side = 512;
    while (side < 4096 && (double)side * side < 64.0 * triangles) side *= 2;
    return side;
}

struct raster_bits {
    uint8_t *bits;
    int32_t side;
    uint64_t covered, twice;
};

static bool cover_texel(void *user, int32_t x, int32_t y)
{
    struct raster_bits *raster = user;
    if (x < 0 || y < 0 || x >= raster->side || y >= raster->side) return true;
    const size_t at = (size_t)y * (size_t)raster->side + (size_t)x;
    const uint8_t bit = (uint8_t)(1u << at % 8u);
    if (raster->bits[at / 8] & bit)
        raster->twice++;
    else
        raster->covered++;
    raster->bits[at / 8] |= bit;
    return true;
}

struct unwrap_areas {
    double all, collapsed; // of the surface
};

static enum unwrap_fault check_triangle(const struct mesh *mesh, int set, uint32_t triangle,
                                        struct raster_bits *raster, struct unwrap_areas *areas)
{
    struct raster_triangle texels;
    vec3s corner[3];
    for (uint32_t k = 0; k < 3; k++) {
        const uint32_t v = mesh->indices[3 * (size_t)triangle + k];
        const vec2s uv = mesh->uv[set][v];
        corner[k] = mesh->positions[v];
        if (!isfinite(uv.x) || !isfinite(uv.y)) return UNWRAP_NOT_FINITE;
        if (uv.x < 0.0f || uv.x > 1.0f || uv.y < 0.0f || uv.y > 1.0f) return UNWRAP_OUTSIDE;
        for (int a = 0; a < 2; a++) texels.at[k][a] = (double)uv.raw[a] * (double)raster->side;
    }
    vec3s normal;
    const float area = triangle_area(corner, &normal);
    areas->all += (double)area;
    if (area == 0.0f) return UNWRAP_VALID;
    if (raster_area2(&texels) == 0.0)
        areas->collapsed += (double)area;
    else
        raster_centres(&texels, cover_texel, raster);
    return UNWRAP_VALID;
}

bool unwrap_is_collapsed(const vec2s uv[3])
{
    struct raster_triangle triangle;
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 2; a++) triangle.at[k][a] = (double)uv[k].raw[a];
    return raster_area2(&triangle) == 0.0;
}

bool unwrap_check(struct host *host, const struct mesh *mesh, int set, double tolerance,
                  enum unwrap_fault *fault)
{
    *fault = UNWRAP_ABSENT;
    if (!mesh->uv[set]) return true;
    struct raster_bits raster = { .side = raster_side(mesh->index_count / 3) };
    raster.bits = host_alloc(host, (size_t)raster.side * (size_t)raster.side / 8, 1);
    if (!raster.bits) return false;
    struct unwrap_areas areas = { 0 };
    *fault = UNWRAP_VALID;
    for (uint32_t t = 0; t < mesh->index_count / 3 && *fault == UNWRAP_VALID; t++)
        *fault = check_triangle(mesh, set, t, &raster, &areas);
    host_free(host, raster.bits);
    if (*fault != UNWRAP_VALID) return true;
    if (areas.collapsed > tolerance * areas.all) *fault = UNWRAP_COLLAPSED;
    if ((double)raster.twice > tolerance * (double)raster.covered) *fault = UNWRAP_OVERLAPS;
    return true;
}

const char *unwrap_fault_text(enum unwrap_fault fault)
{
    switch (fault) {
    case UNWRAP_VALID:
        return "is valid";
    case UNWRAP_ABSENT:
        return "is absent";
    case UNWRAP_NOT_FINITE:
        return "is not finite";
    case UNWRAP_OUTSIDE:
        return "leaves 0…1";
    case UNWRAP_COLLAPSED:
        return "collapses triangles";
    case UNWRAP_OVERLAPS:
        return "overlaps itself";
    }
    return "";
}
