#include "techniques/radiosity/radiosity_reflectance.h"

#include "core/half.h"
#include "core/parallel.h"

#include <math.h>
#include <string.h>

enum { GRAIN = 256 };

static bool allocate(struct radiosity_reflectance *r)
{
    const size_t texels = r->map->texel_count, clusters = r->map->cluster_count;
#define ALLOC(member, count) ((member) = host_alloc(r->host, count, sizeof *(member)))
    return ALLOC(r->factors, texels) && ALLOC(r->area, texels) && ALLOC(r->texels, texels) &&
           ALLOC(r->words, clusters * r->sources) && ALLOC(r->clusters, clusters) &&
           ALLOC(r->power[0], r->map->tree.count) && ALLOC(r->power[1], r->map->tree.count);
#undef ALLOC
}

bool radiosity_reflectance_init(struct radiosity_reflectance *out, struct host *host,
                                const struct radiosity_map *map, const int *material_of,
                                const struct radiosity_reflectance_input *from)
{
    *out = (struct radiosity_reflectance){
        .host = host, .map = map, .sources = from->sources, .material_of = material_of
    };
    if (!allocate(out)) return false;
    memcpy(out->factors, from->factors, map->texel_count * sizeof *out->factors);
    for (uint32_t i = 0; i < map->texel_count; i++)
        out->area[i] = from->point[4 * (size_t)i + 3] * chart_texel_of(&map->charts, i)->area_m2;
    for (size_t k = 0; k < map->cluster_count * from->sources; k++)
        out->words[k] = from->cluster_source[k] | (uint32_t)from->cluster_factor[k]
                                                      << RADIOSITY_NODE_BITS;
    return true;
}

void radiosity_reflectance_finish(struct radiosity_reflectance *r)
{
    if (!r->host) return;
    host_free(r->host, r->factors);
    host_free(r->host, r->area);
    host_free(r->host, r->words);
    host_free(r->host, r->texels);
    host_free(r->host, r->clusters);
    for (int k = 0; k < 2; k++) host_free(r->host, r->power[k]);
    *r = (struct radiosity_reflectance){ 0 };
}

// ---- reflectance

struct update {
    struct radiosity_reflectance *of;
    const struct material *materials;
};

static void find_texel(void *user, size_t i)
{
    const struct update *u = user;
    const struct radiosity_reflectance *r = u->of;
    const struct texel_factors *factors = &r->factors[i];
    const int instance = chart_triangle_of(&r->map->charts, (uint32_t)i)->instance;
    const struct material *material = &u->materials[r->material_of[instance]];
    r->texels[i] = vec4_of(texel_reflectance_with(factors, material), factors->cosine);
}

// Mean reflectance, and area of texels that are not hidden.
static void find_cluster(void *user, size_t cluster)
{
    const struct radiosity_reflectance *r = ((const struct update *)user)->of;
    vec3s reflected = vec3_of(0, 0, 0);
    float sum = 0.0f;
    for (uint32_t m = r->map->first[cluster]; m < r->map->first[cluster + 1]; m++) {
        const uint32_t texel = r->map->members[m];
        const float diffuse = 0.5f + 0.5f * r->texels[texel].w; // radiosity_direct.comp
        sum += r->area[texel];
        reflected =
            glms_vec3_muladds(vec3_xyz(r->texels[texel]), r->area[texel] * diffuse, reflected);
    }
    r->clusters[cluster] = vec4_of(sum > 0.0f ? glms_vec3_divs(reflected, sum) : reflected, sum);
}

// ---- the spectral radius

static void fill_nodes(const struct radiosity_reflectance *r, float *x)
{
    const struct radiosity_tree *tree = &r->map->tree;
    for (uint32_t n = tree->leaves; n < tree->count; n++) {
        const struct radiosity_node *node = &tree->nodes[n];
        float sum = 0.0f, area = 0.0f;
        if (node->count > RADIOSITY_GROUP) continue;
        for (uint32_t c = node->first; c < node->first + node->count; c++) {
            sum += r->clusters[c].w * x[c];
            area += r->clusters[c].w;
        }
        x[n] = area > 0.0f ? sum / area : 0.0f;
    }
}

static void multiply_row(void *user, size_t i)
{
    const struct radiosity_reflectance *r = user;
    float sum = 0.0f;
    for (size_t k = 0; k < r->sources; k++) {
        const uint32_t word = r->words[i * r->sources + k];
        const uint16_t factor = (uint16_t)(word >> RADIOSITY_NODE_BITS);
        if (factor == 0) break;
        sum += float_from_half(factor) * r->power[0][word & ((1u << RADIOSITY_NODE_BITS) - 1u)];
    }
    // Clusters that reflect nothing would end with the ratio 0/0.
    r->power[1][i] = fmaxf(sum * glms_vec3_max(glms_vec3(r->clusters[i])), 1e-30f);
}

// One step of the power method; the largest ratio bounds the spectral radius from above (Collatz
// 1942).
static float power_step(struct radiosity_reflectance *r)
{
    float most = 0.0f;
    fill_nodes(r, r->power[0]);
    parallel_for(r->map->tree.leaves, GRAIN, multiply_row, r);
    for (size_t i = 0; i < r->map->tree.leaves; i++)
        most = fmaxf(most, r->power[1][i] / r->power[0][i]);
    float *last = r->power[0];
    r->power[0] = r->power[1];
    r->power[1] = last;
    return most;
}

enum { POWER_STEPS = 24 };
static const float MOST_RADIUS = 0.999f;

static void find_spectral_radius(struct radiosity_reflectance *r)
{
    r->spectral_radius = MOST_RADIUS;
    for (uint32_t i = 0; i < r->map->cluster_count; i++) r->power[0][i] = 1.0f;
    for (int k = 0; k < POWER_STEPS; k++)
        r->spectral_radius = fminf(r->spectral_radius, power_step(r));
}

void radiosity_reflectance_update(struct radiosity_reflectance *r, const struct material *materials)
{
    struct update update = { r, materials };
    parallel_for(r->map->texel_count, GRAIN, find_texel, &update);
    parallel_for(r->map->cluster_count, GRAIN, find_cluster, &update);
    find_spectral_radius(r);
}
