// The edited block map in the image: edges of all blocks, openings of the chosen one.
#include "overlay.h"

#include "viewer/operations.h"

#include <stdio.h>

static const uint32_t EDGES = 0xffffff50, CHOSEN = 0xffc040ff, NEIGHBOR = 0x60e060d0,
                      OPEN = 0x60c0ffd0;

static void draw_line(const struct viewer *v, const float a[3], const float b[3], uint32_t color,
                      float width)
{
    float x0, y0, x1, y1;
    if (viewer_project(v, a, &x0, &y0) && viewer_project(v, b, &x1, &y1))
        ui_stroke(x0, y0, x1, y1, color, width * window_scale(v->window));
}

static void draw_edges(const struct viewer *v, const struct block *block, bool chosen)
{
    for (int c = 0; c < BLOCK_CORNERS; c++)
        for (int axis = 1; axis < BLOCK_CORNERS; axis *= 2)
            if (!(c & axis))
                draw_line(v, block->corner[c], block->corner[c | axis], chosen ? CHOSEN : EDGES,
                          chosen ? 2.5f : 1.0f);
}

// A frame inside of each face without a wall.
static void draw_openings(const struct viewer *v, const struct block *block)
{
    for (int f = 0; f < BLOCK_FACES; f++) {
        const enum opening opening = block_opening(block, f);
        float centre[3], corner[4][3];
        if (opening == OPENING_WALL) continue;
        block_face_centre(block, f, centre);
        for (int i = 0; i < 4; i++)
            for (int k = 0; k < 3; k++)
                corner[i][k] =
                    centre[k] + 0.8f * (block->corner[block_face_corner(f, i)][k] - centre[k]);
        for (int i = 0; i < 4; i++)
            draw_line(v, corner[i], corner[(i + 1) % 4], opening == OPENING_OPEN ? OPEN : NEIGHBOR,
                      1.5f);
    }
}

void overlay_blocks(const struct viewer *v)
{
    const struct blocks *blocks = &v->block_edit.blocks;
    const struct block *chosen = block_edit_chosen(v);
    for (int i = 0; i < blocks->count; i++) {
        float centre[3], x, y;
        char text[16];
        if (&blocks->at[i] != chosen) draw_edges(v, &blocks->at[i], false);
        block_centre(&blocks->at[i], centre);
        if (!viewer_project(v, centre, &x, &y) || x >= viewer_region(v).x1) continue;
        snprintf(text, sizeof text, "%d", i);
        ui_label(x - 0.5f * ui_label_width(text), y - 7.0f * window_scale(v->window),
                 &blocks->at[i] == chosen ? CHOSEN : 0xffffffc0, text);
    }
    if (!chosen) return;
    draw_edges(v, chosen, true);
    draw_openings(v, chosen);
}
