// From a bake, which is untrusted, to tables on the GPU.
#include "techniques/prt/prt_state.h"

#include <string.h>

struct content {
    struct light_map_texels texels;
    const uint16_t *direct; // PRT_DIRECT
    const uint16_t *bounce; // PRT_BOUNCE; NULL: without bounces
    struct compressed {
        const uint16_t *rows, *cluster, *weight; // PRT_CODEBOOK, PRT_CLUSTER, PRT_WEIGHT
    } vectors, matrices;                         // NULL: not compressed
    const uint16_t *matrix;                      // PRT_MATRIX
    float *emitted;          // [texels][3][4] with bounces, as LIGHT_MAP_EMITTED
    uint32_t *nearest_valid; // [texels]
};

// Bounced light comes from all around: its vector irradiance is along the normal.
static bool add_emitted_bounces(struct prt *s, const struct tensors *bake, struct content *c)
{
    const uint64_t texels = light_map_rows(s->receivers.count);
    const float *bounced = TENSORS_EXPECT(s->host, bake, PRT_EMITTED, TENSOR_F32, texels, 3);
    if (!bounced) return false;
    c->emitted = host_alloc(s->host, (size_t)texels, sizeof(float[3][4]));
    if (!c->emitted) return false;
    memcpy(c->emitted, c->texels.emitted, (size_t)texels * sizeof(float[3][4]));
    for (uint32_t i = 0; i < s->receivers.count; i++) {
        const vec3s normal = prt_receiver_normal(&s->receivers, i);
        for (size_t k = 0; k < 3; k++) {
            float *at = c->emitted + 4 * (3 * (size_t)i + k), e = bounced[3 * (size_t)i + k];
            at[0] += e;
            for (int a = 0; a < 3; a++) at[1 + a] += e * normal.raw[a];
        }
    }
    c->texels.emitted = c->emitted;
    return true;
}

static bool find_vectors(struct prt *s, const struct tensors *bake, struct content *out)
{
    const uint64_t texels = light_map_rows(s->receivers.count);
    const uint64_t coefficients = prt_coefficients(&s->options);
    out->direct = TENSORS_EXPECT(s->host, bake, PRT_DIRECT, TENSOR_F16, coefficients, texels);
    if (!out->direct || !prt_has_bounces(&s->options)) return out->direct != NULL;
    out->bounce = TENSORS_EXPECT(s->host, bake, PRT_BOUNCE, TENSOR_F16, coefficients, texels, 3);
    return out->bounce != NULL;
}

static bool check_clusters(const struct prt *s, const uint16_t *cluster)
{
    for (uint32_t i = 0; i < s->receivers.count; i++)
        if (cluster[i] >= prt_clusters(&s->options))
            return host_fail(s->host, FAIL_FORMAT, "bake of prt: texel %u is in cluster %u of %u",
                             i, cluster[i], prt_clusters(&s->options));
    return true;
}

// Finds the tensors of compressed vectors, or matrices.
static bool find_points(struct prt *s, const struct tensors *bake, bool matrices,
                        struct compressed *out)
{
    const uint64_t texels = light_map_rows(s->receivers.count);
    const uint64_t vectors = prt_vectors(&s->options);
    const char *cluster = matrices ? PRT_GLOSSY_CLUSTER : PRT_CLUSTER;
    out->cluster = TENSORS_EXPECT(s->host, bake, cluster, TENSOR_U16, texels);
    if (!out->cluster || !check_clusters(s, out->cluster)) return false;
    if (!TENSORS_EXPECT(s->host, bake, matrices ? PRT_GLOSSY_ERROR : PRT_ERROR, TENSOR_F32, 2))
        return false;
    if (vectors == 0) return true;
    out->weight = TENSORS_EXPECT(s->host, bake, matrices ? PRT_GLOSSY_WEIGHT : PRT_WEIGHT,
                                 TENSOR_F16, texels, vectors);
    return out->weight != NULL;
}

static bool find_codebook(struct prt *s, const struct tensors *bake, struct content *out)
{
    const uint64_t rows = prt_codebook_rows(&s->options), numbers = prt_dimension(&s->options);
    out->vectors.rows = TENSORS_EXPECT(s->host, bake, PRT_CODEBOOK, TENSOR_F16, rows, numbers);
    return out->vectors.rows && find_points(s, bake, false, &out->vectors);
}

static bool find_matrices(struct prt *s, const struct tensors *bake, struct content *out)
{
    const uint64_t texels = light_map_rows(s->receivers.count);
    const uint64_t rows = prt_codebook_rows(&s->options), numbers = prt_dimension(&s->options);
    if (!prt_is_glossy(&s->options)) return true;
    out->texels.roughness = TENSORS_EXPECT(s->host, bake, PRT_ROUGHNESS, TENSOR_F32, texels);
    out->texels.shading = TENSORS_EXPECT(s->host, bake, PRT_NORMAL, TENSOR_F32, texels, 3);
    if (!out->texels.roughness || !out->texels.shading) return false;
    if (rows == 0) {
        out->matrix =
            TENSORS_EXPECT(s->host, bake, PRT_MATRIX, TENSOR_F16, texels, PRT_OUTGOING, numbers);
        return out->matrix != NULL;
    }
    out->matrices.rows =
        TENSORS_EXPECT(s->host, bake, PRT_GLOSSY_CODEBOOK, TENSOR_F16, rows, PRT_OUTGOING, numbers);
    return out->matrices.rows && find_points(s, bake, true, &out->matrices);
}

// At vertices reflectance and the light of the sky are of the bake alone, as for the frames of a
// light map.
static bool find_receivers(struct prt *s, const struct tensors *bake, struct light_map_texels *out)
{
    const uint64_t n = light_map_rows(s->receivers.count);
#define EXPECT(...) TENSORS_EXPECT(s->host, bake, __VA_ARGS__)
    const bool found = s->receivers.at_vertices
                           ? EXPECT(LIGHT_MAP_SKY, TENSOR_F32, n, 4) &&
                                 (out->point = EXPECT(LIGHT_MAP_POINT, TENSOR_F32, n, 4))
                           : light_map_find_texels(out, s->host, &s->charts, bake);
    return found && (out->reflectance = EXPECT(LIGHT_MAP_ALBEDO, TENSOR_F32, n, 4)) &&
           (out->emitted = EXPECT(LIGHT_MAP_EMITTED, TENSOR_F32, n, 3, 4));
#undef EXPECT
}

static bool find_tensors(struct prt *s, const struct tensors *bake, struct content *out)
{
    *out = (struct content){ 0 };
    const bool ok = s->options.compression == PRT_NONE ? find_vectors(s, bake, out)
                                                       : find_codebook(s, bake, out);
    return ok && find_receivers(s, bake, &out->texels) && find_matrices(s, bake, out) &&
           (!prt_has_bounces(&s->options) || add_emitted_bounces(s, bake, out));
}

// Number k of a transfer vector, or of a row of the codebook.
static uint16_t value_of(const struct prt *s, const struct content *c, size_t row, size_t k)
{
    const size_t texels = s->receivers.count;
    if (c->vectors.rows) return c->vectors.rows[row * prt_dimension(&s->options) + k];
    if (!c->bounce) return c->direct[k * texels + row];
    const size_t at = k / 4 * texels + row;
    return k % 4 == 0 ? c->direct[at] : c->bounce[3 * at + k % 4 - 1];
}

static size_t row_count(const struct prt *s)
{
    const size_t rows = prt_codebook_rows(&s->options);
    return rows > 0 ? rows : s->receivers.count;
}

static bool upload_transfer(struct prt *s, const struct content *c)
{
    const size_t rows = row_count(s), count = prt_row_entries(&s->options) * rows;
    uint16_t *table =
        host_alloc(s->host, light_map_table_capacity(count), sizeof(uint16_t[PRT_VECTOR_HALVES]));
    for (size_t k = 0; table && k < prt_dimension(&s->options); k++)
        for (size_t row = 0; row < rows; row++)
            *prt_table_half(table, PRT_VECTOR_HALVES, rows, row, k) = value_of(s, c, row, k);
    return light_map_table_upload(s->host, s->gpu, "transfer", GPU_RGBA32U, table, count,
                                  &s->tables.vectors.transfer);
}

static bool upload_matrices(struct prt *s, const struct content *c)
{
    const size_t matrices = row_count(s), rows = PRT_OUTGOING * matrices;
    const size_t numbers = prt_dimension(&s->options), count = prt_row_entries(&s->options) * rows;
    const uint16_t *from = c->matrices.rows ? c->matrices.rows : c->matrix;
    if (!from) return true;
    uint16_t *table =
        host_alloc(s->host, light_map_table_capacity(count), sizeof(uint16_t[PRT_VECTOR_HALVES]));
    for (size_t i = 0; table && i < matrices; i++)
        for (size_t out = 0; out < PRT_OUTGOING; out++)
            for (size_t k = 0; k < numbers; k++)
                *prt_table_half(table, PRT_VECTOR_HALVES, rows, out * matrices + i, k) =
                    from[(i * PRT_OUTGOING + out) * numbers + k];
    return light_map_table_upload(s->host, s->gpu, "matrices", GPU_RGBA32U, table, count,
                                  &s->tables.matrices.transfer);
}

static bool upload_clusters(struct prt *s, const struct compressed *c, struct prt_tables *out)
{
    const size_t texels = s->receivers.count, vectors = prt_vectors(&s->options);
    const size_t count = prt_weight_entries(&s->options) * texels;
    if (!c->rows) return true;
    uint32_t *clusters = host_alloc(s->host, light_map_table_capacity(texels), sizeof *clusters);
    uint16_t *weights = host_alloc(s->host, light_map_table_capacity(count), 4 * sizeof *weights);
    for (size_t i = 0; clusters && i < texels; i++) clusters[i] = c->cluster[i];
    for (size_t i = 0; weights && i < texels; i++)
        for (size_t k = 0; k < vectors; k++)
            *prt_table_half(weights, PRT_ROW_HALVES, texels, i, k) = c->weight[i * vectors + k];
    const bool ok = light_map_table_upload(s->host, s->gpu, "clusters", GPU_R32U, clusters, texels,
                                           &out->clusters);
    return light_map_table_upload(s->host, s->gpu, "weights", GPU_RG32U, weights, count,
                                  &out->weights) &&
           ok;
}

static bool upload_lookup(struct prt *s, const struct content *c, const struct tensors *bake)
{
    const uint32_t instances = (uint32_t)s->followed.places.count;
    if (s->receivers.at_vertices)
        return prt_vertex_map_upload(&s->vertex_map, instances, c->nearest_valid, c->texels.emitted,
                                     &s->tables.texels);
    return light_map_upload_texels(&c->texels, s->host, s->gpu, &s->tables.texels) &&
           light_map_upload(&s->light_map, instances, c->nearest_valid, c->texels.sky, bake);
}

static bool upload_all(struct prt *s, struct content *c, const struct tensors *bake)
{
    if (s->receivers.count == 0) return true;
    c->nearest_valid = prt_receivers_nearest_valid(&s->receivers, c->texels.point);
    return c->nearest_valid && upload_transfer(s, c) && upload_matrices(s, c) &&
           upload_clusters(s, &c->vectors, &s->tables.vectors) &&
           upload_clusters(s, &c->matrices, &s->tables.matrices) && upload_lookup(s, c, bake);
}

bool prt_upload(struct prt *s, const struct tensors *bake)
{
    struct content c;
    const bool ok = find_tensors(s, bake, &c) && upload_all(s, &c, bake) &&
                    prt_probes_upload(&s->probes, s->host, s->gpu,
                                      prt_receivers_bounds(&s->receivers), &s->options, bake);
    host_free(s->host, c.nearest_valid);
    host_free(s->host, c.emitted);
    return ok;
}
