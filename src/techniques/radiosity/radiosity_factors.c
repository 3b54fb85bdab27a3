// Form factors on the GPU, in blocks of rows that a binding can have. In a block entries of all
// rows are side by side, so that neighbouring invocations read neighbouring words.
#include "techniques/radiosity/radiosity_state.h"

// A block begins at a multiple of 256 bytes, which is enough for all devices.
enum { ROW_STEP = 64, TEXEL_WORDS = 2, CLUSTER_WORDS = 1 };

static struct radiosity_block block_at(const struct radiosity *s, uint32_t first, uint32_t rows,
                                       size_t row_bytes)
{
    const uint64_t fit = gpu_limits(s->gpu)->max_storage_bytes / row_bytes;
    const uint64_t most = fit < ROW_STEP ? ROW_STEP : fit / ROW_STEP * ROW_STEP;
    const uint32_t count = rows - first < most ? rows - first : (uint32_t)most;
    return (struct radiosity_block){ first, count, first * row_bytes, count * row_bytes };
}

static size_t texel_row_bytes(const struct radiosity *s)
{
    return (size_t)s->options.sources * TEXEL_WORDS * sizeof(uint32_t);
}

static size_t cluster_row_bytes(const struct radiosity *s)
{
    return 2 * (size_t)s->options.sources * CLUSTER_WORDS * sizeof(uint32_t);
}

struct radiosity_block radiosity_texel_block(const struct radiosity *s, uint32_t first)
{
    return block_at(s, first, s->map.texel_count, texel_row_bytes(s));
}

struct radiosity_block radiosity_cluster_block(const struct radiosity *s, uint32_t first)
{
    return block_at(s, first, s->map.cluster_count, cluster_row_bytes(s));
}

static uint32_t pack(uint32_t node, uint16_t factor)
{
    return node | (uint32_t)factor << RADIOSITY_NODE_BITS;
}

// A table to upload. pack: writes the words of a block.
struct table {
    const char *name;
    const uint32_t *source;
    const uint16_t *factor;
    size_t sources, row_bytes;
    uint32_t rows;
    void (*pack)(const struct table *table, const struct radiosity_block *block, uint32_t *words);
    gpu_buffer *out;
};

static void pack_texels(const struct table *of, const struct radiosity_block *block,
                        uint32_t *words)
{
    for (size_t row = 0; row < block->count; row++)
        for (size_t k = 0; k < of->sources; k++) {
            const size_t from = (block->first + row) * of->sources + k;
            uint32_t *to = &words[TEXEL_WORDS * (k * block->count + row)];
            to[0] = pack(of->source[from], of->factor[3 * from]);
            to[1] = of->factor[3 * from + 1] | (uint32_t)of->factor[3 * from + 2] << 16;
        }
}

static void pack_clusters(const struct table *of, const struct radiosity_block *block,
                          uint32_t *words)
{
    for (size_t row = 0; row < block->count; row++)
        for (size_t k = 0; k < of->sources; k++) {
            const size_t from = (block->first + row) * of->sources + k;
            words[k * block->count + row] = pack(of->source[from], of->factor[from]);
        }
}

static bool upload_block(struct radiosity *s, const struct table *of,
                         const struct radiosity_block *block)
{
    uint32_t *words = host_alloc(s->host, block->bytes, 1);
    if (words) of->pack(of, block, words);
    const bool ok =
        words && gpu_buffer_upload(s->gpu, *of->out, block->offset, words, block->bytes);
    host_free(s->host, words);
    return ok;
}

static bool upload_table(struct radiosity *s, const struct table *of)
{
    const struct gpu_buffer_desc desc = { of->name, of->rows * of->row_bytes, GPU_BUFFER_STORAGE };
    bool ok = gpu_buffer_create(s->gpu, &desc, of->out);
    for (uint32_t first = 0; ok && first < of->rows;) {
        const struct radiosity_block block = block_at(s, first, of->rows, of->row_bytes);
        ok = upload_block(s, of, &block);
        first += block.count;
    }
    return ok;
}

bool radiosity_upload_factors(struct radiosity *s, const uint32_t *source, const uint16_t *factor,
                              const uint32_t *cluster_source, const uint16_t *cluster_factor)
{
    const size_t sources = (size_t)s->options.sources;
    const struct table texels = { "factors",
                                  source,
                                  factor,
                                  sources,
                                  texel_row_bytes(s),
                                  s->map.texel_count,
                                  pack_texels,
                                  &s->buffers.factors };
    const struct table clusters = { "cluster_factors",    cluster_source,
                                    cluster_factor,       2 * sources,
                                    cluster_row_bytes(s), s->map.cluster_count,
                                    pack_clusters,        &s->buffers.cluster_factors };
    return upload_table(s, &texels) && upload_table(s, &clusters);
}
