#include "techniques/radiosity/bake/block.h"

#include <string.h>

static size_t most_hits(uint64_t clusters, const struct radiosity_options *options)
{
    const uint64_t rays = (uint64_t)options->rays;
    return RADIOSITY_BLOCK * (size_t)(rays < clusters ? rays : clusters);
}

static size_t most_shares(const struct radiosity_options *options)
{
    return RADIOSITY_BLOCK * (size_t)options->sources;
}

bool radiosity_block_init(struct radiosity_block_rays *block, struct host *host,
                          const struct radiosity_scene *scene)
{
    const uint32_t clusters = scene->map.tree.leaves;
    *block = (struct radiosity_block_rays){ .host = host };
    block->sum.factor = host_alloc(host, clusters, sizeof *block->sum.factor);
    block->sum.hit = host_alloc(host, clusters, sizeof *block->sum.hit);
    block->hits = host_alloc(host, most_hits(clusters, &scene->options), sizeof *block->hits);
    block->shares = host_alloc(host, most_shares(&scene->options), sizeof *block->shares);
    block->row = host_alloc(host, (size_t)scene->options.sources, sizeof *block->row);
    return block->sum.factor && block->sum.hit && block->hits && block->shares && block->row;
}

void radiosity_block_finish(struct radiosity_block_rays *block)
{
    if (!block->host) return;
    host_free(block->host, block->sum.factor);
    host_free(block->host, block->sum.hit);
    host_free(block->host, block->hits);
    host_free(block->host, block->shares);
    host_free(block->host, block->row);
    *block = (struct radiosity_block_rays){ 0 };
}

size_t radiosity_block_bytes(uint64_t clusters, const struct radiosity_options *options)
{
    const struct radiosity_block_rays *block = NULL;
    return (size_t)clusters * (sizeof *block->sum.factor + sizeof *block->sum.hit) +
           most_hits(clusters, options) * sizeof *block->hits +
           most_shares(options) * sizeof *block->shares;
}

// ----

static bool are_neighbours(const struct charts *charts, uint32_t a, uint32_t b)
{
    const struct chart_texel *p = chart_texel_of(charts, a), *q = chart_texel_of(charts, b);
    return chart_is_back(charts, a) == chart_is_back(charts, b) &&
           charts->triangles[p->triangle].chart == charts->triangles[q->triangle].chart &&
           p->x / RADIOSITY_BLOCK_EDGE == q->x / RADIOSITY_BLOCK_EDGE &&
           p->y / RADIOSITY_BLOCK_EDGE == q->y / RADIOSITY_BLOCK_EDGE;
}

uint32_t radiosity_block_texels(const struct radiosity_scene *scene, uint32_t first, uint32_t most)
{
    uint32_t count = 1;
    while (count < most && are_neighbours(&scene->map.charts, first, first + count) &&
           radiosity_texels_see(scene, first, first + count))
        count++;
    return count;
}

void radiosity_block_begin(struct radiosity_block_rays *block)
{
    radiosity_gather_clear(&block->sum);
    block->texels = block->share_count = 0;
    block->first_hit[0] = 0;
}

void radiosity_block_add(struct radiosity_block_rays *block, const struct radiosity_gather *texel)
{
    struct radiosity_gather *sum = &block->sum;
    size_t at = block->first_hit[block->texels];
    for (uint32_t i = 0; texel && i < texel->hit_count; i++) {
        const uint32_t cluster = texel->hit[i];
        const struct radiosity_factor *factor = &texel->factor[cluster];
        block->hits[at++] = (struct radiosity_block_hit){ cluster, *factor };
        if (sum->factor[cluster].weight == 0.0f) sum->hit[sum->hit_count++] = cluster;
        sum->factor[cluster].weight += factor->weight;
    }
    block->first_hit[++block->texels] = at;
}

void radiosity_block_end(struct radiosity_block_rays *block, struct radiosity_rows *rows,
                         uint32_t strata, float phase)
{
    radiosity_clear_strata(rows);
    block->share_count = radiosity_make_strata(rows, &block->sum, strata, block->texels * strata,
                                               phase, block->shares);
}

const struct radiosity_factor *radiosity_block_row(struct radiosity_block_rays *block,
                                                   const struct radiosity_rows *rows,
                                                   uint32_t texel)
{
    memset(block->row, 0, rows->stratum_count * sizeof *block->row);
    for (size_t i = block->first_hit[texel]; i < block->first_hit[texel + 1]; i++) {
        const struct radiosity_block_hit *hit = &block->hits[i];
        struct radiosity_factor *sum = &block->row[radiosity_stratum_of(rows, hit->cluster)];
        sum->weight += hit->factor.weight;
        for (int a = 0; a < 3; a++) sum->along[a] += hit->factor.along[a];
    }
    for (uint32_t s = 0; s < rows->stratum_count; s++)
        for (int a = 0; block->row[s].weight > 0.0f && a < 3; a++)
            block->row[s].along[a] /= block->row[s].weight;
    return block->row;
}
