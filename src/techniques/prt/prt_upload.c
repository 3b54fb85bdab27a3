// From a bake, which is untrusted, to tables on the GPU.
#include "techniques/prt/prt_state.h"

#include <string.h>

struct content {
    struct light_map_texels texels;
    const uint16_t *direct; // PRT_DIRECT
    const uint16_t *bounce; // PRT_BOUNCE; NULL: without bounces
    float *emitted;         // [texels][3][4] with bounces, as LIGHT_MAP_EMITTED
    uint32_t *shown;        // [texels] whose light each one shows
};

// Bounced light comes from all around: its vector irradiance is along the normal.
static bool add_emitted_bounces(struct prt *s, const struct tensors *bake, struct content *c)
{
    const uint64_t texels = light_map_rows(s->charts.side_texel_count);
    const float *bounced = TENSORS_EXPECT(s->host, bake, PRT_EMITTED, TENSOR_F32, texels, 3);
    if (!bounced) return false;
    c->emitted = host_alloc(s->host, (size_t)texels, sizeof(float[3][4]));
    if (!c->emitted) return false;
    memcpy(c->emitted, c->texels.emitted, (size_t)texels * sizeof(float[3][4]));
    for (uint32_t i = 0; i < s->charts.side_texel_count; i++) {
        const vec3s normal = chart_texel_normal(&s->charts, i);
        for (size_t k = 0; k < 3; k++) {
            float *at = c->emitted + 4 * (3 * (size_t)i + k), e = bounced[3 * (size_t)i + k];
            at[0] += e;
            for (int a = 0; a < 3; a++) at[1 + a] += e * normal.raw[a];
        }
    }
    c->texels.emitted = c->emitted;
    return true;
}

static bool find_tensors(struct prt *s, const struct tensors *bake, struct content *out)
{
    const uint64_t texels = light_map_rows(s->charts.side_texel_count);
    const uint64_t coefficients = prt_coefficients(&s->options);
    *out = (struct content){ 0 };
    out->direct = TENSORS_EXPECT(s->host, bake, PRT_DIRECT, TENSOR_F16, coefficients, texels);
    if (!out->direct) return false;
    if (s->options.transfer == PRT_INTERREFLECTED &&
        !(out->bounce =
              TENSORS_EXPECT(s->host, bake, PRT_BOUNCE, TENSOR_F16, coefficients, texels, 3)))
        return false;
    return light_map_find_texels(&out->texels, s->host, &s->charts, bake) &&
           (!out->bounce || add_emitted_bounces(s, bake, out));
}

static void fill_row(const struct prt *s, const struct content *c, size_t row, uint16_t *table)
{
    const size_t rows = s->charts.side_texel_count, count = prt_coefficients(&s->options);
    for (size_t k = 0; k < count; k++) {
        const size_t at = k * rows + row;
        if (!c->bounce) {
            table[PRT_ROW_HALVES * (k / PRT_ROW_HALVES * rows + row) + k % PRT_ROW_HALVES] =
                c->direct[at];
            continue;
        }
        table[PRT_ROW_HALVES * at] = c->direct[at];
        for (size_t a = 0; a < 3; a++) table[PRT_ROW_HALVES * at + 1 + a] = c->bounce[3 * at + a];
    }
}

static bool upload_transfer(struct prt *s, const struct content *c)
{
    const size_t count = (size_t)prt_row_entries(&s->options) * s->charts.side_texel_count;
    uint16_t *table =
        host_alloc(s->host, light_map_table_room(count), PRT_ROW_HALVES * sizeof *table);
    for (size_t i = 0; table && i < s->charts.side_texel_count; i++) fill_row(s, c, i, table);
    return light_map_table_upload(s->host, s->gpu, "transfer", GPU_RG32U, table, count,
                                  &s->tables.transfer);
}

static bool upload_all(struct prt *s, struct content *c, const struct tensors *bake)
{
    if (s->charts.side_texel_count == 0) return true;
    c->shown = light_map_shown(&c->texels, s->host);
    return c->shown && upload_transfer(s, c) &&
           light_map_upload_texels(&c->texels, s->host, s->gpu, &s->tables.texels) &&
           light_map_upload(&s->light_map, (uint32_t)s->followed.places.count, c->shown, bake);
}

bool prt_upload(struct prt *s, const struct tensors *bake)
{
    struct content c;
    const bool ok = find_tensors(s, bake, &c) && upload_all(s, &c, bake);
    host_free(s->host, c.shown);
    host_free(s->host, c.emitted);
    return ok;
}
