// The file of a record: a safetensors file.
#include "lightmap/update/record.h"

#include "bake/safetensors.h"
#include "core/c_locale.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char KIND[] = "afterglow.kind", IS_RECORD[] = "lightmap",
                  OPTIONS[] = "afterglow.options", VERSION[] = "afterglow.bake_version",
                  SEED[] = "afterglow.seed", DENSITY[] = "afterglow.texels_per_m",
                  ENVIRONMENT[] = "afterglow.environment", SEARCH[] = "afterglow.surface_texels",
                  ACROSS[] = "afterglow.charts_across";

enum { INSTANCE_WORDS = 9, BOX_FLOATS = 6, LIGHT_FLOATS = 13, CHART_WORDS = 9, TENSORS = 6 };

static const struct {
    const char *name;
    enum tensor_type type;
    uint64_t columns;
} kinds[TENSORS] = {
    { "instances/hash", TENSOR_U32, INSTANCE_WORDS }, // shape, surface; number of triangles
    { "instances/bounds", TENSOR_F32, BOX_FLOATS },   // m, min and max
    { "lights", TENSOR_F32, LIGHT_FLOATS },
    { "charts", TENSOR_U32, CHART_WORDS }, // hash; size, texels, first of backs
    { "texels/place", TENSOR_U16, 2 },
    { LIGHTMAP_REST, TENSOR_F32, LIGHTMAP_COLUMNS },
};
enum { HASHES, BOUNDS, LIGHTS, CHARTS, PLACES, REST };

// ---- packing

static void pack_instance(const struct record_instance *i, uint32_t words[INSTANCE_WORDS],
                          float box[BOX_FLOATS])
{
    memcpy(words, &i->shape, sizeof i->shape);
    memcpy(words + 4, &i->surface, sizeof i->surface);
    words[8] = i->triangles;
    memcpy(box, i->bounds.min.raw, 3 * sizeof *box);
    memcpy(box + 3, i->bounds.max.raw, 3 * sizeof *box);
}

static void unpack_instance(struct record_instance *i, const uint32_t words[INSTANCE_WORDS],
                            const float box[BOX_FLOATS])
{
    memcpy(&i->shape, words, sizeof i->shape);
    memcpy(&i->surface, words + 4, sizeof i->surface);
    i->triangles = words[8];
    memcpy(i->bounds.min.raw, box, 3 * sizeof *box);
    memcpy(i->bounds.max.raw, box + 3, 3 * sizeof *box);
}

static void pack_light(const struct world_light *l, float out[LIGHT_FLOATS])
{
    const float values[LIGHT_FLOATS] = { (float)l->type, l->position.x,  l->position.y,
                                         l->position.z,  l->direction.x, l->direction.y,
                                         l->direction.z, l->intensity.x, l->intensity.y,
                                         l->intensity.z, l->cos_inner,   l->cos_outer,
                                         l->range_m };
    memcpy(out, values, sizeof values);
}

static bool unpack_light(struct world_light *l, const float v[LIGHT_FLOATS])
{
    if (v[0] != (float)LIGHT_SUN && v[0] != (float)LIGHT_POINT && v[0] != (float)LIGHT_SPOT)
        return false;
    *l = (struct world_light){ .type = (enum light_type)v[0],
                               .position = vec3_of(v[1], v[2], v[3]),
                               .direction = vec3_of(v[4], v[5], v[6]),
                               .intensity = vec3_of(v[7], v[8], v[9]),
                               .cos_inner = v[10],
                               .cos_outer = v[11],
                               .range_m = v[12] };
    return true;
}

static void pack_chart(const struct record_chart *c, uint32_t out[CHART_WORDS])
{
    memcpy(out, &c->key, sizeof c->key);
    out[4] = c->width;
    out[5] = c->height;
    out[6] = c->first_texel;
    out[7] = c->texel_count;
    out[8] = c->first_back;
}

static void unpack_chart(struct record_chart *c, const uint32_t in[CHART_WORDS])
{
    memcpy(&c->key, in, sizeof c->key);
    c->width = in[4];
    c->height = in[5];
    c->first_texel = in[6];
    c->texel_count = in[7];
    c->first_back = in[8];
}

// ---- writing

struct packed {
    void *data[TENSORS];
    uint64_t rows[TENSORS];
};

static bool pack(const struct lightmap_record *r, struct packed *out)
{
    *out = (struct packed){ .rows = { r->instance_count, r->instance_count, r->light_count,
                                      r->chart_count, r->texel_count, r->row_count } };
    bool ok = true;
    for (int k = 0; k < PLACES && ok; k++) {
        out->data[k] = host_alloc(r->host, out->rows[k], (size_t)kinds[k].columns * 4);
        ok = out->data[k];
    }
    out->data[PLACES] = r->places;
    out->data[REST] = r->rest;
    for (uint32_t i = 0; ok && i < r->instance_count; i++)
        pack_instance(&r->instances[i], (uint32_t *)out->data[HASHES] + (size_t)INSTANCE_WORDS * i,
                      (float *)out->data[BOUNDS] + (size_t)BOX_FLOATS * i);
    for (uint32_t i = 0; ok && i < r->light_count; i++)
        pack_light(&r->lights[i], (float *)out->data[LIGHTS] + (size_t)LIGHT_FLOATS * i);
    for (uint32_t i = 0; ok && i < r->chart_count; i++)
        pack_chart(&r->charts[i], (uint32_t *)out->data[CHARTS] + (size_t)CHART_WORDS * i);
    return ok;
}

static void free_packed(struct host *host, struct packed *p)
{
    for (int k = 0; k < PLACES; k++) host_free(host, p->data[k]);
}

static struct tensor tensor_of(const struct packed *p, int kind)
{
    struct tensor out = { .name = kinds[kind].name,
                          .type = kinds[kind].type,
                          .rank = 2,
                          .shape = { p->rows[kind], kinds[kind].columns },
                          .data = p->data[kind] };
    tensor_extent(out.type, out.rank, out.shape, &out.bytes);
    return out;
}

bool lightmap_record_write(const struct lightmap_record *r, const char *path)
{
    struct packed packed;
    struct tensor tensors[TENSORS];
    char version[16], seed[24], density[32], environment[24], content[HASH128_TEXT];
    char search[16];
    struct tensor_metadata metadata[] = {
        { KIND, IS_RECORD },          { OPTIONS, r->options },
        { VERSION, version },         { SEED, seed },
        { DENSITY, density },         { ENVIRONMENT, environment },
        { SEARCH, search },           { ACROSS, r->search.across ? "1" : "0" },
        { TENSORS_CONTENT, content },
    };
    struct tensors set = { tensors, TENSORS, metadata, sizeof metadata / sizeof *metadata };
    snprintf(version, sizeof version, "%d", r->version);
    snprintf(search, sizeof search, "%" PRIu32, r->search.surface_texels);
    snprintf(seed, sizeof seed, "%" PRIu64, r->seed);
    snprintf(environment, sizeof environment, "%016" PRIx64, r->environment);
    c_locale_print(density, sizeof density, "%.9g", (double)r->texels_per_m);
    bool ok = pack(r, &packed);
    for (int k = 0; ok && k < TENSORS; k++) tensors[k] = tensor_of(&packed, k);
    if (ok) hash128_print(tensors_content(&set), content);
    ok = ok && safetensors_write(r->host, path, &set);
    free_packed(r->host, &packed);
    return ok;
}

// ---- reading

static bool fail(struct host *host, const char *path, const char *why)
{
    return host_fail(host, FAIL_FORMAT, "cannot use %s: %s", path, why);
}

static bool read_number(const struct tensors *set, const char *key, int base, uint64_t *out)
{
    const char *text = tensors_metadata(set, key);
    char *end = NULL;
    errno = 0;
    if (text) *out = strtoull(text, &end, base);
    return text && text[0] && *end == 0 && errno == 0;
}

// A file may be without: a search from the start leads to the same charts.
static void read_search(struct lightmap_record *r, const struct tensors *set)
{
    uint64_t texels = 0, across = 0;
    if (read_number(set, SEARCH, 10, &texels) && read_number(set, ACROSS, 10, &across) &&
        texels <= INT32_MAX)
        r->search = (struct charts_search){ (uint32_t)texels, across == 1 };
}

static bool read_metadata(struct lightmap_record *r, const char *path, const struct tensors *set)
{
    const char *kind = tensors_metadata(set, KIND), *options = tensors_metadata(set, OPTIONS);
    const char *density = tensors_metadata(set, DENSITY);
    uint64_t version = 0;
    if (!kind || strcmp(kind, IS_RECORD) != 0 || !options || !density ||
        !read_number(set, VERSION, 10, &version) || version > INT32_MAX ||
        !read_number(set, SEED, 10, &r->seed) ||
        !read_number(set, ENVIRONMENT, 16, &r->environment))
        return fail(r->host, path, "it is not of a light map by paths");
    r->version = (int)version;
    read_search(r, set);
    r->texels_per_m = (float)c_locale_parse(density, NULL);
    r->options = host_strdup(r->host, options);
    if (!(r->texels_per_m >= 0.0f && isfinite(r->texels_per_m)))
        return fail(r->host, path, "its density is wrong");
    return r->options;
}

// The data of a tensor, and its number of rows; NULL: it is missing or wrong.
static const void *rows_of(struct host *host, const struct tensors *set, int kind, uint32_t *rows)
{
    const struct tensor *found = tensors_find(set, kinds[kind].name);
    const uint64_t count = found && found->rank == 2 ? found->shape[0] : 0;
    if (count > INT32_MAX) return NULL;
    *rows = (uint32_t)count;
    return tensors_expect(host, set, kinds[kind].name, kinds[kind].type, 2,
                          (const uint64_t[]){ count, kinds[kind].columns });
}

static bool is_chart_in_range(const struct lightmap_record *r, const struct record_chart *c)
{
    return c->texel_count <= r->texel_count && c->first_texel <= r->texel_count - c->texel_count &&
           c->width <= CHART_MAX_SIDE && c->height <= CHART_MAX_SIDE &&
           (c->first_back == CHART_NONE ||
            (c->texel_count <= r->row_count && c->first_back <= r->row_count - c->texel_count));
}

static bool take(struct lightmap_record *r, const char *path, const void *const data[TENSORS])
{
    struct host *host = r->host;
    r->instances = host_alloc(host, r->instance_count, sizeof *r->instances);
    r->lights = host_alloc(host, r->light_count, sizeof *r->lights);
    r->charts = host_alloc(host, r->chart_count, sizeof *r->charts);
    r->places = host_alloc(host, r->texel_count, sizeof *r->places);
    r->rest = host_alloc(host, r->row_count, LIGHTMAP_COLUMNS * sizeof *r->rest);
    if (!r->instances || !r->lights || !r->charts || !r->places || !r->rest) return false;
    for (uint32_t i = 0; i < r->instance_count; i++)
        unpack_instance(&r->instances[i],
                        (const uint32_t *)data[HASHES] + (size_t)INSTANCE_WORDS * i,
                        (const float *)data[BOUNDS] + (size_t)BOX_FLOATS * i);
    for (uint32_t i = 0; i < r->light_count; i++)
        if (!unpack_light(&r->lights[i], (const float *)data[LIGHTS] + (size_t)LIGHT_FLOATS * i))
            return fail(host, path, "a light has no type");
    for (uint32_t i = 0; i < r->chart_count; i++) {
        unpack_chart(&r->charts[i], (const uint32_t *)data[CHARTS] + (size_t)CHART_WORDS * i);
        if (!is_chart_in_range(r, &r->charts[i]))
            return fail(host, path, "a chart has texels that there are not");
    }
    if (r->texel_count > 0) memcpy(r->places, data[PLACES], r->texel_count * sizeof *r->places);
    if (r->row_count > 0)
        memcpy(r->rest, data[REST], (size_t)r->row_count * LIGHTMAP_COLUMNS * sizeof *r->rest);
    return true;
}

static bool read_tensors(struct lightmap_record *r, const char *path, const struct tensors *set)
{
    const void *data[TENSORS];
    uint32_t boxes = 0;
    uint32_t *const counts[TENSORS] = { &r->instance_count, &boxes,          &r->light_count,
                                        &r->chart_count,    &r->texel_count, &r->row_count };
    for (int k = 0; k < TENSORS; k++)
        if (!(data[k] = rows_of(r->host, set, k, counts[k]))) return false;
    if (boxes != r->instance_count || r->row_count < r->texel_count)
        return fail(r->host, path, "its tensors differ in their number of rows");
    return take(r, path, data);
}

bool lightmap_record_read(struct lightmap_record *out, struct host *host, const char *path)
{
    struct safetensors file;
    *out = (struct lightmap_record){ .host = host };
    if (!safetensors_read(host, path, &file)) return false;
    const bool ok = tensors_check_content(host, path, &file.set) &&
                    read_metadata(out, path, &file.set) && read_tensors(out, path, &file.set);
    if (ok) out->content = tensors_content(&file.set);
    safetensors_finish(host, &file);
    if (!ok) lightmap_record_finish(out);
    return ok;
}
