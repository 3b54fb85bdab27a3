// The bins on the GPU: an image with a layer for each.
#include "techniques/ort/bins.h"
#include "techniques/ort/ort_state.h"

#include <string.h>

enum { RUN_WORDS = 4 }; // of halves; of bytes half as many

struct filling {
    const struct ort_maps *maps;
    uint32_t *words; // of a bin
};

// A weight of a texel in a run, which is an entry of the bin. weight: its number in a bake.
static void write_weight(const struct filling *f, size_t entry, uint32_t in_run, size_t weight)
{
    if (f->maps->bytes)
        f->words[entry * RUN_WORDS / 2 + in_run / 4] |= (uint32_t)f->maps->bytes[weight]
                                                        << in_run % 4 * 8;
    else
        f->words[entry * RUN_WORDS + in_run / 2] |= (uint32_t)f->maps->weight[weight]
                                                    << in_run % 2 * 16;
}

static void write_texel(const struct filling *f, const struct ort_piece *piece, uint32_t x,
                        uint32_t y)
{
    size_t weight;
    if (!ort_maps_at(f->maps, piece->map, (struct ort_place){ piece->x + x, piece->y + y },
                     &weight))
        return;
    const size_t column = (piece->bin_x + x) / ORT_RUN;
    const size_t run = column * ORT_BIN_SIDE + piece->bin_y + y;
    for (size_t c = 0; c < 3; c++)
        write_weight(f, 3 * run + c, (piece->bin_x + x) % ORT_RUN, weight + c);
}

static uint32_t fill_bin(const struct filling *f, const struct ort_bins *bins, uint32_t bin,
                         uint32_t first)
{
    uint32_t p = first;
    for (; p < bins->piece_count && bins->pieces[p].bin == bin; p++)
        for (uint32_t y = 0; y < bins->pieces[p].height; y++)
            for (uint32_t x = 0; x < bins->pieces[p].width; x++)
                write_texel(f, &bins->pieces[p], x, y);
    return p;
}

static bool create_image(struct ort *s, uint32_t bins, enum gpu_format format)
{
    const struct gpu_limits *limits = gpu_limits(s->gpu);
    if (bins > limits->max_layers)
        return host_fail(s->host, FAIL_UNSUPPORTED,
                         "ort: %u bins of transfer maps, above the limit of %s, %u; give fewer "
                         "texels or offsets",
                         bins, gpu_info(s->gpu)->name, limits->max_layers);
    const struct gpu_image_desc desc = { .name = "bins",
                                         .dimension = GPU_2D_ARRAY,
                                         .format = format,
                                         .width = 3 * ORT_BIN_SIDE,
                                         .height = ORT_BIN_SIDE / ORT_RUN,
                                         .depth = bins,
                                         .usage = GPU_SAMPLED | GPU_STORAGE };
    return gpu_image_create(s->gpu, &desc, &s->tables.bins);
}

bool ort_upload_bins(struct ort *s, const struct ort_maps *maps, const struct ort_bins *bins)
{
    const enum gpu_format format = maps->bytes ? GPU_RG32U : GPU_RGBA32U;
    const size_t bytes =
        (size_t)(3 * ORT_BIN_SIDE * ORT_BIN_SIDE / ORT_RUN) * (size_t)gpu_format_bytes(format);
    const struct filling f = { maps, host_alloc(s->host, bytes, 1) };
    const uint32_t count = bins->bin_count > 0 ? bins->bin_count : 1;
    bool ok = f.words && create_image(s, count, format);
    for (uint32_t bin = 0, piece = 0; ok && bin < bins->bin_count; bin++) {
        memset(f.words, 0, bytes);
        piece = fill_bin(&f, bins, bin, piece);
        ok = gpu_image_upload(s->gpu, s->tables.bins, 0, bin, f.words, bytes);
    }
    host_free(s->host, f.words);
    return ok;
}
