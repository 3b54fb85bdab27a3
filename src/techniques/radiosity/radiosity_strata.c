#include "techniques/radiosity/radiosity_strata.h"

#include "techniques/radiosity/radiosity_shared.h"

uint32_t radiosity_stratum_source(uint32_t node, uint32_t stratum)
{
    return node | stratum << RADIOSITY_NODE_BITS;
}

uint32_t radiosity_source_node(uint32_t source)
{
    return source & ((1u << RADIOSITY_NODE_BITS) - 1u);
}

uint32_t radiosity_source_stratum(uint32_t source)
{
    return source >> RADIOSITY_NODE_BITS;
}

uint32_t radiosity_block_after(const struct radiosity_block_rows *rows, uint32_t first)
{
    uint32_t end = first + 1;
    while (end < rows->texels && rows->start[end] == 0) end++;
    return end;
}

// Entries of the block of these texels.
static size_t entries_of(const struct radiosity_block_rows *rows, uint32_t first, uint32_t end)
{
    const size_t at = first * rows->sources, most = (end - first) * rows->sources;
    size_t count = 0;
    while (count < most && rows->share[at + count] != 0) count++;
    return count;
}

// Counts the entries of a block's strata in first[1 + stratum]; returns the number of strata.
static uint32_t count_block(const struct radiosity_block_rows *rows, uint32_t texel, uint32_t end,
                            uint32_t *first)
{
    const uint32_t *source = rows->source + texel * rows->sources;
    const size_t entries = entries_of(rows, texel, end);
    uint32_t strata = 1;
    for (size_t k = 0; k < entries; k++) {
        const uint32_t stratum = radiosity_source_stratum(source[k]);
        first[1 + stratum]++;
        strata = stratum >= strata ? stratum + 1 : strata;
    }
    return strata;
}

// first: [texels · sources + 1], becomes the entries of each stratum, after its number.
static void number_strata(struct radiosity_strata *out, const struct radiosity_block_rows *rows)
{
    for (uint32_t texel = 0; texel < rows->texels;) {
        const uint32_t end = radiosity_block_after(rows, texel);
        const uint32_t strata = count_block(rows, texel, end, out->first + out->count);
        for (; texel < end; texel++) out->of[texel] = out->count;
        out->count += strata;
    }
    for (uint32_t i = 0; i < out->count; i++) {
        out->most = out->first[i + 1] > out->most ? out->first[i + 1] : out->most;
        out->first[i + 1] += out->first[i];
    }
}

static void fill_block(struct radiosity_strata *out, const struct radiosity_block_rows *rows,
                       uint32_t texel, uint32_t end, uint32_t *next)
{
    const size_t at = texel * rows->sources, entries = entries_of(rows, texel, end);
    for (size_t k = at; k < at + entries; k++) {
        const uint32_t stratum = out->of[texel] + radiosity_source_stratum(rows->source[k]);
        const uint32_t entry = out->first[stratum] + next[stratum]++;
        out->node[entry] = radiosity_source_node(rows->source[k]);
        out->share[entry] = rows->share[k];
    }
}

bool radiosity_strata_init(struct radiosity_strata *out, struct host *host,
                           const struct radiosity_block_rows *rows)
{
    const size_t most = rows->texels * rows->sources;
    *out = (struct radiosity_strata){ .host = host };
    out->first = host_alloc(host, most + 1, sizeof *out->first);
    out->of = host_alloc(host, rows->texels, sizeof *out->of);
    if (!out->first || !out->of) return false;
    number_strata(out, rows);
    out->node = host_alloc(host, out->first[out->count], sizeof *out->node);
    out->share = host_alloc(host, out->first[out->count], sizeof *out->share);
    uint32_t *next = host_alloc(host, out->count, sizeof *next);
    const bool ok = out->node && out->share && next;
    for (uint32_t texel = 0; ok && texel < rows->texels;) {
        const uint32_t end = radiosity_block_after(rows, texel);
        fill_block(out, rows, texel, end, next);
        texel = end;
    }
    host_free(host, next);
    return ok;
}

void radiosity_strata_finish(struct radiosity_strata *strata)
{
    if (!strata->host) return;
    host_free(strata->host, strata->first);
    host_free(strata->host, strata->node);
    host_free(strata->host, strata->share);
    host_free(strata->host, strata->of);
    *strata = (struct radiosity_strata){ 0 };
}
