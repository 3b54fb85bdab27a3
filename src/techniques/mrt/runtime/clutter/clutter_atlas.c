#include "techniques/mrt/runtime/clutter/clutter_atlas.h"

#include <string.h>

bool mrt_clutter_atlas_init(struct mrt_clutter_atlas *out, struct host *host, int blocks)
{
    *out = (struct mrt_clutter_atlas){ .host = host };
    out->rows = host_alloc(host, (size_t)blocks, sizeof *out->rows);
    out->input.rows = out->rows;
    return out->rows;
}

static bool add_openings(struct host *host, struct mrt_clutter_rows_input *rows,
                         const struct mrt_level_operators *operators,
                         const struct mrt_clutter_transfer *transfer,
                         const struct mrt_clutter_transfer_input *input,
                         const struct mrt_opening_input *openings, int opening_count)
{
    bool ok = true;
    for (int i = 0; ok && i < opening_count; i++) {
        const int face = openings[i].face;
        if (face < 0) {
            // Faces are the first columns.
            ok = matrix_f32_copy(host, &transfer->c, (size_t)operators->input.k_r, &rows->u_r[i]);
            continue;
        }
        const struct mrt_response_input *response =
            &operators->responses[mrt_response_of(&input->map->blocks[rows->block], face)];
        ok = mrt_clutter_transfer_response(transfer, host, input, face, &response->u[MRT_PROBE],
                                           operators->input.probes, &rows->u_r[i]);
    }
    return ok;
}

static bool keep_inside(struct mrt_clutter_atlas *out, const struct mrt_clutter_transfer *transfer,
                        const struct charts *charts)
{
    if (!out->inside)
        out->inside = host_alloc(out->host, charts->side_texel_count, sizeof *out->inside);
    if (out->inside)
        memcpy(out->inside + transfer->first_texel, transfer->inside,
               transfer->texel_count * sizeof *transfer->inside);
    return out->inside;
}

bool mrt_clutter_atlas_add(struct mrt_clutter_atlas *out,
                           const struct mrt_level_operators *operators,
                           struct mrt_delta_cache *cache,
                           const struct mrt_clutter_transfer_input *input, int block,
                           const struct mrt_opening_input *openings, int opening_count)
{
    const struct mrt_clutter_transfer *transfer = mrt_kept_transfer(cache, input, block);
    if (!transfer) return false;
    struct mrt_clutter_rows_input *rows = &out->rows[out->input.count++];
    *rows = (struct mrt_clutter_rows_input){ .block = block,
                                             .first_texel = (int)transfer->first_texel,
                                             .texel_count = (int)transfer->texel_count };
    return matrix_f32_copy(out->host, &transfer->b, transfer->b.columns, &rows->u_b) &&
           keep_inside(out, transfer, &input->clutter->charts) &&
           add_openings(out->host, rows, operators, transfer, input, openings, opening_count);
}

// ---- the atlas

// source: [places] in mrt_clutter.texels, of the texels that hidden ones show.
static bool fill_sources(struct mrt_clutter_atlas *out, const struct mrt_clutter *clutter,
                         bool *hidden, uint32_t *place_of)
{
    const struct charts *charts = &clutter->charts;
    for (uint32_t i = 0; i < charts->side_texel_count; i++) {
        place_of[clutter->texels[i]] = i;
        hidden[clutter->texels[i]] = out->inside[i];
    }
    uint32_t *nearest_valid = charts_fill(charts, hidden);
    for (size_t i = 0; nearest_valid && i < charts_place_count(charts); i++) {
        const uint32_t texel = chart_texel_of_place(charts, i);
        out->source[i] = texel == CHART_NONE ? CHART_NONE : place_of[nearest_valid[texel]];
    }
    const bool ok = nearest_valid;
    host_free(charts->host, nearest_valid);
    return ok;
}

bool mrt_clutter_atlas_place(struct mrt_clutter_atlas *out, const struct mrt_clutter *clutter)
{
    const struct charts *charts = &clutter->charts;
    struct host *host = out->host;
    bool *hidden = host_alloc(host, charts->side_texel_count, sizeof *hidden);
    uint32_t *place_of = host_alloc(host, charts->side_texel_count, sizeof *place_of);
    out->source = host_alloc(host, charts_place_count(charts), sizeof *out->source);
    const bool ok = hidden && place_of && out->source &&
                    (out->inside || charts->texel_count == 0) &&
                    fill_sources(out, clutter, hidden, place_of);
    if (ok) {
        out->input.source = out->source;
        out->input.clutter = clutter;
    }
    host_free(host, hidden);
    host_free(host, place_of);
    return ok;
}

void mrt_clutter_atlas_finish(struct mrt_clutter_atlas *atlas)
{
    if (!atlas->host) return;
    for (int i = 0; i < atlas->input.count; i++) {
        matrix_f32_finish(atlas->host, &atlas->rows[i].u_b);
        for (int k = 0; k <= CUBE_FACES; k++)
            matrix_f32_finish(atlas->host, &atlas->rows[i].u_r[k]);
    }
    host_free(atlas->host, atlas->rows);
    host_free(atlas->host, atlas->inside);
    host_free(atlas->host, atlas->source);
    *atlas = (struct mrt_clutter_atlas){ 0 };
}
