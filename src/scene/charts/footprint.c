#include "scene/charts/footprint.h"

#include "scene/charts/raster.h"

#include <string.h>

static bool touch(void *user, int32_t x, int32_t y, const struct raster_polygon *part)
{
    const struct footprint_grid *grid = user;
    const uint32_t column = (uint32_t)x + CHART_GUTTER, row = (uint32_t)y + CHART_GUTTER;
    if (raster_polygon_area(part) > 0.0) grid->taken[(size_t)row * grid->width + column] = 1;
    return true;
}

static void draw_triangle(struct footprint_grid *grid, double place[3][2])
{
    struct raster_polygon whole = { .count = 3 };
    memcpy(whole.at, place, 3 * sizeof *whole.at);
    raster_parts(&whole, touch, grid);
}

// Gutters of touched texels.
static void widen(const struct footprint_grid *grid, const uint8_t *touched)
{
    const int64_t width = grid->width, height = grid->height, g = CHART_GUTTER;
    memset(grid->taken, 0, (size_t)(width * height));
    for (int64_t y = g; y < height - g; y++)
        for (int64_t x = g; x < width - g; x++)
            for (int64_t row = y - g; touched[y * width + x] && row <= y + g; row++)
                memset(&grid->taken[row * width + x - g], 1, 2 * CHART_GUTTER + 1);
}

// Rows and columns beyond the last touched texel's gutter: corners on the border of two texels have
// one more than they touch.
static void shrink(struct footprint_grid *grid)
{
    const uint32_t before = grid->width;
    uint32_t width = 0, height = 0;
    for (uint32_t y = 0; y < grid->height; y++)
        for (uint32_t x = 0; x < before; x++) {
            if (!grid->taken[(size_t)y * before + x]) continue;
            if (x >= width) width = x + 1;
            height = y + 1;
        }
    for (uint32_t y = 0; y < height; y++)
        memmove(&grid->taken[(size_t)y * width], &grid->taken[(size_t)y * before], width);
    grid->width = width;
    grid->height = height;
}

void footprint_draw(struct footprint_grid *grid, uint8_t *spare, const struct grown *grown,
                    const struct grown_chart *chart)
{
    const size_t size = (size_t)grid->width * grid->height;
    const size_t first = (size_t)CHART_GUTTER * (grid->width + 1);
    memset(grid->taken, 0, size);
    for (uint32_t i = 0; i < chart->triangle_count && !chart->single_texel; i++)
        draw_triangle(grid, grown->place[grown->order[chart->first_triangle + i]]);
    // A chart has a texel even if rounding leaves no area.
    if (!memchr(grid->taken, 1, size)) grid->taken[first] = 1;
    memcpy(spare, grid->taken, size);
    widen(grid, spare);
    shrink(grid);
}

// ---- bits

bool footprint_takes(const struct footprint_grid *grid, uint32_t turns, uint32_t x, uint32_t y)
{
    const uint32_t w = grid->width, h = grid->height;
    const uint32_t column[4] = { x, y, w - 1 - x, w - 1 - y };
    const uint32_t row[4] = { y, h - 1 - x, h - 1 - y, x };
    return grid->taken[(size_t)row[turns] * w + column[turns]];
}

// Edges of the largest squares whose last corner is at each bit of a row, from those of the row
// before.
static void find_squares(struct footprint *out, uint32_t y, uint32_t *edge)
{
    uint32_t corner = 0; // of the row before, one bit to the left
    for (uint32_t x = 0; x < out->width; x++) {
        const uint32_t above = edge[x], left = x > 0 ? edge[x - 1] : 0;
        uint32_t least = above < left ? above : left;
        if (corner < least) least = corner;
        const bool set = out->bits[y][x / 64] >> x % 64 & 1;
        edge[x] = set ? least + 1 : 0;
        out->count += set;
        corner = above;
        if (edge[x] <= out->square) continue;
        out->square = edge[x];
        out->square_y = y + 1 - edge[x];
    }
}

uint32_t footprint_level(const struct footprint_grid *grid)
{
    const uint32_t side = grid->width > grid->height ? grid->width : grid->height;
    uint32_t level = 0;
    while ((side - 1) >> level >= FOOTPRINT_SIDE) level++;
    return level;
}

void footprint_make(struct footprint *out, const struct footprint_grid *grid, uint32_t turns,
                    uint32_t level)
{
    uint32_t edge[FOOTPRINT_SIDE] = { 0 };
    const uint32_t width = turns % 2 == 0 ? grid->width : grid->height;
    const uint32_t height = turns % 2 == 0 ? grid->height : grid->width;
    *out = (struct footprint){ .width = ((width - 1) >> level) + 1,
                               .height = ((height - 1) >> level) + 1 };
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const uint32_t column = x >> level;
            if (footprint_takes(grid, turns, x, y))
                out->bits[y >> level][column / 64] |= (uint64_t)1 << column % 64;
        }
    for (uint32_t y = 0; y < out->height; y++) find_squares(out, y, edge);
}
