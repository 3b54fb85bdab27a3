#include "techniques/prt/prt_fixture.h"

#include "core/half.h"
#include "core/rng.h"
#include "techniques/bake_bytes.h"
#include "techniques/kept_bake.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// ---- scenes

void prt_fixture_init(struct prt_fixture *f)
{
    *f = (struct prt_fixture){ 0 };
    fixture_init(&f->s, NULL);
}

int prt_fixture_diffuse(struct prt_fixture *f, float albedo)
{
    struct material m = material_default();
    m.base_color = vec4_of(vec3_of(albedo, albedo, albedo), 1);
    m.metallic = 0;
    m.specular = 0;
    return fixture_material(&f->s, &m);
}

static vec3s on_sphere(int ring, int step, int rings)
{
    const float theta = GLM_PIf * (float)ring / (float)rings;
    const float phi = GLM_PIf * (float)step / (float)rings;
    return vec3_of(sinf(theta) * cosf(phi), cosf(theta), sinf(theta) * sinf(phi));
}

void prt_fixture_sphere(struct prt_fixture *f, vec3s center, float radius, int rings, int open,
                        bool inwards, int material)
{
    const int steps = 2 * rings;
    const size_t vertices = (size_t)(rings + 1) * (size_t)(steps + 1);
    struct mesh mesh = { .name = "sphere",
                         .vertex_count = (uint32_t)vertices,
                         .material = material };
    mesh.positions = calloc(vertices, sizeof *mesh.positions);
    mesh.normals = calloc(vertices, sizeof *mesh.normals);
    mesh.indices = calloc((size_t)(rings * steps) * 6, sizeof *mesh.indices);
    assert_true(mesh.positions && mesh.normals && mesh.indices);
    for (int r = 0; r <= rings; r++)
        for (int p = 0; p <= steps; p++) {
            const int v = r * (steps + 1) + p;
            const vec3s n = on_sphere(r, p, rings);
            mesh.positions[v] = glms_vec3_muladds(n, radius, center);
            mesh.normals[v] = inwards ? glms_vec3_negate(n) : n;
        }
    for (int r = open; r < rings; r++)
        for (int p = 0; p < steps; p++) {
            const uint32_t a = (uint32_t)(r * (steps + 1) + p), b = a + 1,
                           c = a + (uint32_t)steps + 1, d = c + 1;
            const uint32_t out[6] = { a, b, d, a, d, c };
            for (int k = 0; k < 6; k++) mesh.indices[mesh.index_count++] = out[inwards ? 5 - k : k];
        }
    const int index = scene_add_mesh(f->s.scene, &mesh);
    assert_true(index >= 0);
    fixture_instance(&f->s, index, NULL);
    free(mesh.positions);
    free(mesh.normals);
    free(mesh.indices);
}

void prt_fixture_grid(struct prt_fixture *f, float half, int steps, int material)
{
    const size_t across = (size_t)steps + 1, vertices = across * across;
    struct mesh mesh = { .name = "grid", .vertex_count = (uint32_t)vertices, .material = material };
    mesh.positions = calloc(vertices, sizeof *mesh.positions);
    mesh.normals = calloc(vertices, sizeof *mesh.normals);
    mesh.indices = calloc((size_t)(steps * steps) * 6, sizeof *mesh.indices);
    assert_true(mesh.positions && mesh.normals && mesh.indices);
    for (size_t v = 0; v < vertices; v++) {
        const float x = (float)(v % across), z = (float)(v / across);
        mesh.positions[v] =
            vec3_of(half * (2 * x / (float)steps - 1), 0, half * (2 * z / (float)steps - 1));
        mesh.normals[v] = vec3_of(0, 1, 0);
    }
    for (int q = 0; q < steps * steps; q++) {
        const uint32_t a = (uint32_t)(q / steps * (steps + 1) + q % steps), b = a + 1,
                       c = a + (uint32_t)across, d = c + 1;
        const uint32_t up[6] = { a, c, b, b, c, d };
        for (int k = 0; k < 6; k++) mesh.indices[mesh.index_count++] = up[k];
    }
    const int index = scene_add_mesh(f->s.scene, &mesh);
    assert_true(index >= 0);
    fixture_instance(&f->s, index, NULL);
    free(mesh.positions);
    free(mesh.normals);
    free(mesh.indices);
}

void prt_fixture_disk(struct prt_fixture *f, vec3s center, float radius, int material)
{
    enum { CORNERS = 64 };
    vec3s positions[CORNERS], normals[CORNERS];
    uint32_t indices[3 * (CORNERS - 2)];
    // The area of the polygon is n/2 · r² sin(2π/n).
    const float angle = 2 * GLM_PIf / CORNERS;
    const float reach = radius * sqrtf(GLM_PIf / (CORNERS / 2 * sinf(angle)));
    for (int i = 0; i < CORNERS; i++) {
        const vec3s at = vec3_of(cosf((float)i * angle), 0, sinf((float)i * angle));
        positions[i] = glms_vec3_muladds(at, reach, center);
        normals[i] = vec3_of(0, -1, 0);
    }
    for (uint32_t i = 0; i < CORNERS - 2; i++) {
        indices[3 * i] = 0;
        indices[3 * i + 1] = i + 1;
        indices[3 * i + 2] = i + 2;
    }
    const int mesh = scene_add_mesh(f->s.scene, &(struct mesh){ .name = "disk",
                                                                .vertex_count = CORNERS,
                                                                .index_count = 3 * (CORNERS - 2),
                                                                .positions = positions,
                                                                .normals = normals,
                                                                .indices = indices,
                                                                .material = material });
    assert_true(mesh >= 0);
    fixture_instance(&f->s, mesh, NULL);
}

void prt_fixture_open(struct prt_fixture *f, const char *options)
{
    struct gi_spec spec;
    char text[256];
    f->options = options;
    snprintf(text, sizeof text, "prt:%s", options);
    CHECK(gi_spec_parse(&spec, test_host(), text));
    CHECK(pose_init(&f->s.pose, f->s.scene, -1, 0.0f));
    CHECK(scene_statics_init(&f->statics, test_host(), &f->s.pose));
    CHECK(prt_charts(&f->statics.pose, spec.options[0], test_host(), NULL, &f->charts));
    gi_spec_finish(&spec);
}

void prt_fixture_close(struct prt_fixture *f)
{
    charts_finish(&f->charts);
    scene_statics_finish(&f->statics);
    fixture_finish(&f->s);
}

// ---- bakes

struct bake *prt_fixture_plan(const struct prt_fixture *f, const char *more, uint64_t seed)
{
    char text[256];
    snprintf(text, sizeof text, "prt:%s%s%s", f->options, more[0] ? "," : "", more);
    struct bake *bake = bake_of_gi(text, &f->s.pose, seed);
    assert_non_null(bake);
    return bake;
}

struct prt_baked prt_fixture_bake(const struct prt_fixture *f, const char *more, uint64_t seed)
{
    struct prt_baked baked = { .bake = prt_fixture_plan(f, more, seed) };
    CHECK(kept_bake_run(baked.bake));
    baked.tensors = bake_tensors(baked.bake);
    return baked;
}

void prt_baked_finish(struct prt_baked *baked)
{
    bake_destroy(baked->bake);
}

// ---- light

bool prt_is_open(const struct prt_baked *baked, uint32_t texel)
{
    const float *point = tensors_find(baked->tensors, LIGHT_MAP_POINT)->data;
    return point[4 * (size_t)texel + 3] > 0;
}

// Names of the tensors of compressed vectors, or matrices.
struct names {
    const char *rows, *cluster, *weight;
};
static const struct names VECTORS = { PRT_CODEBOOK, PRT_CLUSTER, PRT_WEIGHT };
static const struct names MATRICES = { PRT_GLOSSY_CODEBOOK, PRT_GLOSSY_CLUSTER, PRT_GLOSSY_WEIGHT };

// Number `at` of the vector or matrix of a texel: that of its cluster's mean and vectors.
static float decoded(const struct prt_baked *baked, struct names names, uint32_t texel, size_t at)
{
    const struct tensor *rows = tensors_find(baked->tensors, names.rows);
    const struct tensor *weight = tensors_find(baked->tensors, names.weight);
    const uint16_t *cluster = tensors_find(baked->tensors, names.cluster)->data;
    const size_t vectors = weight ? weight->shape[1] : 0;
    const size_t dim = rows->shape[1] * (rows->rank > 2 ? rows->shape[2] : 1);
    const uint16_t *row = (const uint16_t *)rows->data + cluster[texel] * (1 + vectors) * dim + at;
    double sum = (double)float_from_half(row[0]);
    for (size_t k = 0; k < vectors; k++)
        sum += (double)float_from_half(((const uint16_t *)weight->data)[texel * vectors + k]) *
               (double)float_from_half(row[(1 + k) * dim]);
    return (float)sum;
}

// Coefficients, and whether there are bounces.
static size_t count_coefficients(const struct prt_baked *baked, bool *bounces)
{
    const struct tensor *direct = tensors_find(baked->tensors, PRT_DIRECT);
    *bounces = tensors_find(baked->tensors, PRT_EMITTED) != NULL;
    if (direct) return direct->shape[0];
    return tensors_find(baked->tensors, PRT_CODEBOOK)->shape[1] / (*bounces ? 4 : 1);
}

vec4s prt_coefficient(const struct prt_baked *baked, uint32_t texel, size_t k)
{
    const struct tensor *direct = tensors_find(baked->tensors, PRT_DIRECT);
    const struct tensor *bounce = tensors_find(baked->tensors, PRT_BOUNCE);
    bool bounces;
    count_coefficients(baked, &bounces);
    if (!direct) {
        vec4s out = { { decoded(baked, VECTORS, texel, bounces ? 4 * k : k), 0, 0, 0 } };
        for (size_t c = 1; bounces && c < 4; c++)
            out.raw[c] = decoded(baked, VECTORS, texel, 4 * k + c);
        return out;
    }
    const size_t at = k * direct->shape[1] + texel;
    vec4s out = { { float_from_half(((const uint16_t *)direct->data)[at]), 0, 0, 0 } };
    for (size_t c = 0; bounce && c < 3; c++)
        out.raw[1 + c] = float_from_half(((const uint16_t *)bounce->data)[3 * at + c]);
    return out;
}

void prt_irradiance(const struct prt_baked *baked, uint32_t texel, const struct prt_light *light,
                    float out[3])
{
    double sum[3] = { 0 };
    bool bounces;
    const size_t count = count_coefficients(baked, &bounces);
    for (size_t k = 0; k < count; k++) {
        const vec4s t = prt_coefficient(baked, texel, k);
        for (int c = 0; c < 3; c++)
            sum[c] += (double)t.x * (double)light->direct[k].raw[c] +
                      (double)t.raw[1 + c] * (double)light->bounced[k].raw[c];
    }
    for (int c = 0; c < 3; c++) out[c] = (float)sum[c];
}

// Number k of row `out` of the matrix of a texel.
static float matrix_entry(const struct prt_baked *baked, uint32_t texel, size_t out, size_t k,
                          size_t numbers)
{
    const struct tensor *matrix = tensors_find(baked->tensors, PRT_MATRIX);
    if (!matrix) return decoded(baked, MATRICES, texel, out * numbers + k);
    const uint16_t *of = matrix->data;
    return float_from_half(of[((size_t)texel * PRT_OUTGOING + out) * numbers + k]);
}

static vec3s to_frame_of(const struct prt_baked *baked, uint32_t texel, vec3s direction)
{
    const float *at = (const float *)tensors_find(baked->tensors, PRT_NORMAL)->data + 3 * texel;
    const vec3s normal = vec3_of(at[0], at[1], at[2]);
    vec3s tangent, bitangent;
    basis_of(normal, &tangent, &bitangent);
    return vec3_of(glms_vec3_dot(direction, tangent), glms_vec3_dot(direction, bitangent),
                   glms_vec3_dot(direction, normal));
}

void prt_reflected(const struct prt_baked *baked, uint32_t texel, const struct prt_light *light,
                   vec3s to_viewer, float out[3])
{
    float y[PRT_OUTGOING];
    double sum[3] = { 0 };
    bool bounces;
    const size_t count = count_coefficients(baked, &bounces), planes = bounces ? 4 : 1;
    sh_eval(PRT_OUTGOING_BANDS, to_frame_of(baked, texel, to_viewer), y);
    for (size_t row = 0; row < PRT_OUTGOING; row++)
        for (size_t k = 0; k < planes * count; k++) {
            const double m = (double)(matrix_entry(baked, texel, row, k, planes * count) * y[row]);
            const vec4s *from =
                k % planes == 0 ? &light->direct[k / planes] : &light->bounced[k / planes];
            for (size_t c = 0; c < 3; c++)
                if (k % planes == 0 || k % planes == 1 + c) sum[c] += m * (double)from->raw[c];
        }
    for (int c = 0; c < 3; c++) out[c] = (float)sum[c];
}

void prt_uniform_light(struct prt_light *out)
{
    *out = (struct prt_light){ 0 };
    for (int c = 0; c < 3; c++) out->direct[0].raw[c] = out->bounced[0].raw[c] = sqrtf(4 * GLM_PIf);
}

void prt_random_light(uint32_t seed, struct prt_light *out)
{
    struct rng rng = rng_for(seed, 0, 0);
    *out = (struct prt_light){ 0 };
    for (int k = 0; k < PRT_MAX_COEFFICIENTS; k++)
        for (int c = 0; c < 3; c++)
            out->direct[k].raw[c] = out->bounced[k].raw[c] = 2 * rng_float(&rng) - 1;
}
