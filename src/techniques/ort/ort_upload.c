// From a bake, which is untrusted, to tables on the GPU.
#include "techniques/ort/bins.h"
#include "techniques/ort/levels.h"
#include "techniques/ort/ort_state.h"

#include "core/half.h"

#include <math.h>
#include <string.h>

struct content {
    struct ort_maps maps;
    const float *energy;  // ORT_ENERGY
    const uint8_t *links; // ORT_LINKS
    uint8_t *level;       // as ort_maps.level
    struct light_map_texels texels;
    uint32_t *nearest_valid; // [texels]
    float *scale;            // [maps] of bytes
    uint8_t *bytes;          // as ort_maps.bytes
};

// Light that scatters is all diffuse light of a surface: it is received by shading normals, as
// light that pixels reflect.
static bool find_normals(struct ort *s, const struct tensors *bake, struct light_map_texels *texels)
{
    const float *normals = TENSORS_EXPECT(s->host, bake, ORT_NORMALS, TENSOR_F32,
                                          light_map_rows(s->map.texel_count), 3);
    if (s->options.transfer != ORT_RADIOSITY) texels->shading = normals;
    return normals != NULL;
}

static bool find_reflectance(struct ort *s, const struct tensors *bake,
                             struct light_map_texels *texels)
{
    const uint64_t n = light_map_rows(s->map.texel_count);
    texels->reflectance = TENSORS_EXPECT(s->host, bake, LIGHT_MAP_ALBEDO, TENSOR_F32, n, 4);
    return texels->reflectance != NULL;
}

static bool find_tensors(struct ort *s, const struct tensors *bake, struct content *out)
{
    *out = (struct content){ 0 };
    return (out->energy = TENSORS_EXPECT(s->host, bake, ORT_ENERGY, TENSOR_F32, 2, 3)) &&
           (out->links = TENSORS_EXPECT(s->host, bake, ORT_LINKS, TENSOR_U8,
                                        light_map_rows(s->map.texel_count))) &&
           ort_maps_find(&out->maps, &s->map, &s->options, bake) &&
           light_map_find_texels(&out->texels, s->host, &s->map.charts, bake) &&
           find_reflectance(s, bake, &out->texels) && find_normals(s, bake, &out->texels);
}

// Steps of 8 bits: the largest weight of a map is 255.
static void find_scales(const struct ort *s, struct content *c)
{
    for (uint32_t i = 0; i < s->map.texel_count; i++) {
        const uint16_t *w = ort_weight(&c->maps, i, 0);
        float *scale = c->scale + s->map.group_of[i] * (size_t)c->maps.offsets;
        for (uint32_t k = 0; k < c->maps.offsets; k++)
            for (int a = 0; a < 3; a++)
                scale[k] = fmaxf(scale[k], float_from_half(w[3 * k + (uint32_t)a]) / 255.0f);
    }
}

// Rounds the weights of a texel to bytes. What one loses the next one gets: most weights are below
// half a step of their map, and rows keep their sums.
static void quantise_row(const struct ort *s, const struct content *c, uint32_t texel, uint8_t *out)
{
    const uint16_t *w = ort_weight(&c->maps, texel, 0);
    const float *scale = c->scale + s->map.group_of[texel] * (size_t)c->maps.offsets;
    for (uint32_t a = 0; a < 3; a++) {
        float rest = 0.0f;
        for (uint32_t k = 0; k < c->maps.offsets; k++) {
            const float weight = float_from_half(w[3 * k + a]);
            if (!(weight > 0.0f && scale[k] > 0.0f)) continue;
            const float step = fminf(fmaxf(rintf((weight + rest) / scale[k]), 0.0f), 255.0f);
            rest += weight - step * scale[k];
            out[3 * k + a] = (uint8_t)step;
        }
    }
}

static bool quantise(struct ort *s, struct content *c)
{
    const size_t row = 3 * (size_t)c->maps.offsets;
    c->bytes = host_alloc(s->host, s->map.texel_count, row);
    if (!c->bytes) return false;
    find_scales(s, c);
    for (uint32_t i = 0; i < s->map.texel_count; i++) quantise_row(s, c, i, c->bytes + i * row);
    c->maps.bytes = c->bytes;
    return true;
}

static bool upload_maps(struct ort *s, struct content *c)
{
    struct ort_bins bins;
    c->scale = host_alloc(s->host, c->maps.count, sizeof *c->scale);
    if (!c->scale) return false;
    if (s->options.precision == ORT_BYTE && !quantise(s, c)) return false;
    const struct ort_bins_wish wish = { .maps = c->maps.count,
                                        .width = s->map.width,
                                        .height = s->map.height,
                                        .tile_rows = s->options.order == ORT_TILES ? s->rows : 0,
                                        .mask = ort_maps_mask,
                                        .user = &c->maps };
    if (!ort_bins_init(&bins, s->host, &wish)) return false;
    const bool ok =
        ort_upload_bins(s, &c->maps, &bins) && ort_upload_lists(s, &c->maps, &bins, c->scale);
    const double side = ORT_BIN_SIDE, texels = fmax(bins.bin_count * side * side, 1.0);
    host_log(s->host, LOG_INFO,
             "ort: %u maps of %u x %u texels in %u pieces and %u bins, occupied by %.0f %%; energy "
             "of the offsets %.3f",
             c->maps.count, s->map.width, s->map.height, bins.piece_count, bins.bin_count,
             100.0 * (double)bins.occupied / texels, (double)ort_energy_ratio(c->energy));
    ort_bins_finish(&bins);
    return ok;
}

static bool upload_places(struct ort *s)
{
    const uint32_t count = s->map.texel_count;
    uint32_t *places = host_alloc(s->host, light_map_table_capacity(count), sizeof *places);
    for (uint32_t i = 0; places && i < count; i++) {
        const struct ort_place at = ort_place_of(&s->map, i);
        places[i] = at.y << 16 | at.x;
    }
    return light_map_table_upload(s->host, s->gpu, "places", GPU_R32U, places, count,
                                  &s->tables.places);
}

static bool find_levels(struct ort *s, struct content *c)
{
    s->levels = 1;
    c->maps.level = c->level = host_alloc(s->host, c->maps.count, sizeof *c->level);
    if (!c->level) return false;
    if (s->options.prefilter && !ort_find_levels(&c->maps, c->level)) return false;
    for (uint32_t k = 0; k < c->maps.count; k++)
        if (c->level[k] >= s->levels) s->levels = c->level[k] + 1u;
    return true;
}

static bool upload_steps(struct ort *s, const struct content *c)
{
    const size_t places = (size_t)s->map.width * s->map.height;
    struct gpu_image_desc desc = { .name = "steps",
                                   .format = GPU_R32U,
                                   .width = s->map.height,
                                   .height = s->map.width,
                                   .usage = GPU_STORAGE };
    if (s->levels == 1) return true;
    uint32_t *steps = host_alloc(s->host, places, sizeof *steps);
    if (steps) ort_find_steps(&s->map, c->links, steps);
    const bool ok = steps && gpu_image_create(s->gpu, &desc, &s->tables.steps) &&
                    gpu_image_upload(s->gpu, s->tables.steps, 0, 0, steps, places * sizeof *steps);
    host_free(s->host, steps);
    return ok;
}

bool ort_upload(struct ort *s, const struct tensors *bake)
{
    struct content c;
    if (!find_tensors(s, bake, &c)) return false;
    if (s->map.texel_count == 0) return true;
    c.nearest_valid = light_map_nearest_valid(&c.texels, s->host);
    const bool ok = c.nearest_valid && find_levels(s, &c) && upload_steps(s, &c) &&
                    upload_maps(s, &c) && upload_places(s) &&
                    light_map_upload_texels(&c.texels, s->host, s->gpu, &s->tables.texels) &&
                    light_map_emission_upload(&s->emission, s->host, s->gpu, &s->materials.emission,
                                              s->map.texel_count, bake, false) &&
                    light_map_upload_sky(&c.texels, s->host, s->gpu, bake, &s->tables.sky) &&
                    light_map_upload(&s->light_map, (uint32_t)s->followed.places.count,
                                     c.nearest_valid, c.texels.sky, bake);
    host_free(s->host, c.nearest_valid);
    host_free(s->host, c.level);
    host_free(s->host, c.scale);
    host_free(s->host, c.bytes);
    return ok;
}
