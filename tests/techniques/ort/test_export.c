// Exported transfer maps: pieces in bins have each weight once, gather the same light, and have the
// same bytes again.
#include "techniques/ort/bake_fixture.h"

#include "core/files/file.h"
#include "core/half.h"
#include "core/rng.h"
#include "image/exr.h"
#include "techniques/ort/export.h"

#include <jansson.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define SMALL "texels=512,offsets=60,rays=64,local=3"

// ---- files

static const char *folder_of(const char *name)
{
    static char folders[4][300];
    static int next;
    char *folder = folders[next++ % 4];
    snprintf(folder, sizeof folders[0], "%s", test_path(name));
    assert_int_equal(mkdir(folder, 0777), 0);
    return folder;
}

static bool export_to(const struct ort_fixture *f, const struct tensors *bake, const char *folder)
{
    struct gi_spec spec;
    char text[256];
    snprintf(text, sizeof text, "ort:%s", f->options);
    CHECK(gi_spec_parse(&spec, test_host(), text));
    const struct technique_bake how = { .pose = &f->s.pose, .options = spec.options[0] };
    const bool ok = spec.technique[0]->bake_export(test_host(), bake, &how, folder);
    gi_spec_finish(&spec);
    return ok;
}

static struct file_bytes bytes_of(const char *folder, const char *name)
{
    char path[400];
    struct file_bytes bytes;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    CHECK(file_read(test_host(), path, 0, &bytes));
    return bytes;
}

// An export as another program reads it.
struct read_export {
    json_t *index;
    struct image bins[64];
    int bin_count;
};

static struct read_export read_export(const char *folder)
{
    struct read_export e = { 0 };
    struct file_bytes text = bytes_of(folder, "index.json");
    e.index = json_loadb((const char *)text.data, text.size, 0, NULL);
    assert_non_null(e.index);
    file_bytes_finish(test_host(), &text);
    size_t i;
    json_t *name;
    json_array_foreach(json_object_get(e.index, "files"), i, name)
    {
        char path[400];
        snprintf(path, sizeof path, "%s/%s", folder, json_string_value(name));
        assert_true(i < sizeof e.bins / sizeof *e.bins);
        CHECK(exr_read(test_host(), path, NULL, &e.bins[i]));
        CHECK(e.bins[i].width == ORT_BIN_SIDE && e.bins[i].height == ORT_BIN_SIDE);
        e.bin_count++;
    }
    return e;
}

static void read_finish(struct read_export *e)
{
    json_decref(e->index);
    for (int i = 0; i < e->bin_count; i++) image_finish(&e->bins[i], test_host());
}

static double number_of(const json_t *object, const char *name)
{
    const json_t *number = json_object_get(object, name);
    CHECK(json_is_number(number));
    return json_number_value(number);
}

static uint32_t element(const json_t *list, size_t i)
{
    return (uint32_t)json_integer_value(json_array_get(list, i));
}

static struct ort_piece piece_of(const json_t *list)
{
    CHECK(json_array_size(list) == 8);
    return (struct ort_piece){ .map = element(list, 0),
                               .bin = element(list, 1),
                               .bin_x = element(list, 2),
                               .bin_y = element(list, 3),
                               .x = element(list, 4),
                               .y = element(list, 5),
                               .width = element(list, 6),
                               .height = element(list, 7) };
}

// Calls visit with each texel of each piece.
static void visit_pieces(const struct read_export *e,
                         void (*visit)(void *user, uint32_t map, struct ort_place at,
                                       const float *pixel),
                         void *user)
{
    size_t i;
    json_t *list;
    json_array_foreach(json_object_get(e->index, "pieces"), i, list)
    {
        const struct ort_piece p = piece_of(list);
        CHECK(p.bin < (uint32_t)e->bin_count);
        for (uint32_t y = 0; y < p.height; y++)
            for (uint32_t x = 0; x < p.width; x++)
                visit(user, p.map, (struct ort_place){ p.x + x, p.y + y },
                      image_at(&e->bins[p.bin], (int)(p.bin_x + x), (int)(p.bin_y + y)));
    }
}

// ---- scenes

// The boxes, and a double-sided square in the room.
static void open_boxes(struct ort_fixture *f)
{
    ort_fixture_boxes(f);
    struct material m = material_default();
    m.double_sided = true;
    fixture_quad(&f->s, vec3_of(1, 1, -1), vec3_of(1, 1, 1), vec3_of(1, 2, 1), vec3_of(1, 2, -1),
                 fixture_material(&f->s, &m));
    ort_fixture_open(f, SMALL);
    CHECK(charts_sides(&f->map.charts) == 2);
}

struct exported {
    struct ort_fixture f;
    struct ort_baked baked;
    struct read_export read;
};

static void exported_open(struct exported *e, const char *folder)
{
    open_boxes(&e->f);
    e->baked = ort_fixture_bake(&e->f, "", 0);
    CHECK(export_to(&e->f, e->baked.tensors, folder));
    e->read = read_export(folder);
}

static void exported_close(struct exported *e)
{
    read_finish(&e->read);
    ort_baked_finish(&e->baked);
    ort_fixture_close(&e->f);
}

// ---- weights

// The maps of a bake, and how often an export has each weight.
struct seen {
    const struct ort_map *map;
    const uint16_t *weight; // [texel][offset][3]
    const int32_t *offset;  // [group][offset][2]
    uint32_t offsets;
    uint8_t *times; // [texel][offset]
};

static bool has_source(const struct seen *s, uint32_t k, struct ort_place at)
{
    const int32_t *offset = s->offset + 2 * (size_t)k;
    return ort_texel_at(s->map, at, offset[0], offset[1]) != CHART_NONE;
}

static void see(void *user, uint32_t k, struct ort_place at, const float *pixel)
{
    struct seen *s = user;
    const uint32_t texel = ort_texel_at(s->map, at, 0, 0);
    const bool has = texel != CHART_NONE && s->map->group_of[texel] == k / s->offsets;
    if (!has || !has_source(s, k, at)) {
        CHECK(pixel[0] == 0.0f && pixel[1] == 0.0f && pixel[2] == 0.0f);
        return;
    }
    const size_t row = (size_t)texel * s->offsets + k % s->offsets;
    s->times[row]++;
    for (size_t c = 0; c < 3; c++) CHECK(pixel[c] == float_from_half(s->weight[3 * row + c]));
}

// Is some weight of a row used?
static bool is_lit(const struct seen *s, size_t row)
{
    const uint32_t texel = (uint32_t)(row / s->offsets);
    const uint16_t *w = s->weight + 3 * row;
    const uint32_t k = s->map->group_of[texel] * s->offsets + (uint32_t)(row % s->offsets);
    return ((w[0] | w[1] | w[2]) & 0x7fff) != 0 && has_source(s, k, ort_place_of(s->map, texel));
}

static void check_weights(const struct ort_fixture *f, const struct tensors *bake,
                          const struct read_export *read)
{
    const struct tensor *maps = tensors_find(bake, ORT_MAPS);
    const size_t rows = f->map.texel_count * maps->shape[1];
    struct seen s = { &f->map, maps->data, tensors_find(bake, ORT_OFFSETS)->data,
                      (uint32_t)maps->shape[1], calloc(rows, 1) };
    size_t lit = 0;
    assert_non_null(s.times);
    visit_pieces(read, see, &s);
    for (size_t row = 0; row < rows; row++) {
        if (s.times[row] > 1 || s.times[row] < is_lit(&s, row)) fail_msg("row %zu", row);
        lit += is_lit(&s, row);
    }
    const double texels = (double)read->bin_count * ORT_BIN_SIDE * ORT_BIN_SIDE;
    const json_t *occupancy = json_object_get(read->index, "occupancy");
    CHECK(lit > 1000);
    CHECK_RELATIVE(number_of(occupancy, "weights"), (double)lit / texels, 1e-8);
    CHECK(number_of(occupancy, "weights") <= number_of(occupancy, "pieces"));
    free(s.times);
}

TEST(each_weight_of_the_maps_is_in_one_piece_and_exact)
{
    struct exported e;
    exported_open(&e, folder_of("weights"));
    check_weights(&e.f, e.baked.tensors, &e.read);
    exported_close(&e);
}

// Offsets at random, and every second weight, of any finite value.
static void make_maps(const struct ort_fixture *f, int32_t *offset, uint16_t *weight,
                      uint32_t offsets)
{
    const uint32_t side[2] = { f->map.width, f->map.height };
    for (uint32_t i = 0; i < 2 * offsets; i++)
        offset[i] = (int32_t)(rng_mix(i) % side[i % 2]) - (int32_t)(side[i % 2] / 2);
    for (size_t i = 0; i < 3 * (size_t)f->map.texel_count * offsets; i++)
        weight[i] = i / 3 % 2 ? (uint16_t)(rng_mix(i) & 0xbbff) : 0;
}

TEST(weights_of_several_bins_are_in_one_piece_and_exact)
{
    enum { OFFSETS = 400 };
    struct ort_fixture f;
    const char *folder = folder_of("made");
    ort_fixture_boxes(&f);
    ort_fixture_open(&f, "texels=8192,offsets=400,local=1");
    const uint64_t texels = f.map.texel_count;
    static const float ENERGY[6] = { 1, 1, 1, 1, 1, 1 };
    static int32_t offset[2 * OFFSETS];
    uint16_t *weight = malloc(3 * sizeof *weight * OFFSETS * texels);
    assert_non_null(weight);
    make_maps(&f, offset, weight, OFFSETS);
    const struct tensor at[] = {
        { ORT_OFFSETS, TENSOR_I32, 3, { 1, OFFSETS, 2 }, offset, sizeof offset },
        { ORT_ENERGY, TENSOR_F32, 2, { 2, 3 }, ENERGY, sizeof ENERGY },
        { ORT_MAPS, TENSOR_F16, 3, { texels, OFFSETS, 3 }, weight, 6 * OFFSETS * texels },
    };
    const struct tensors bake = { .at = at, .count = 3 };
    CHECK(export_to(&f, &bake, folder));
    struct read_export read = read_export(folder);
    CHECK(read.bin_count >= 2);
    check_weights(&f, &bake, &read);
    read_finish(&read);
    free(weight);
    ort_fixture_close(&f);
}

// ---- light

struct gather {
    const struct exported *e;
    const json_t *offsets;
    const float *light;
    double *sum;
};

static void gather(void *user, uint32_t map, struct ort_place at, const float *pixel)
{
    const struct gather *g = user;
    const size_t offsets = json_array_size(json_array_get(g->offsets, 0));
    const json_t *offset = json_array_get(json_array_get(g->offsets, map / offsets), map % offsets);
    const int32_t dx = (int32_t)json_integer_value(json_array_get(offset, 0));
    const int32_t dy = (int32_t)json_integer_value(json_array_get(offset, 1));
    const uint32_t to = ort_texel_at(&g->e->f.map, at, 0, 0);
    const uint32_t from = ort_texel_at(&g->e->f.map, at, dx, dy);
    for (size_t c = 0; to != CHART_NONE && from != CHART_NONE && c < 3; c++)
        g->sum[3 * (size_t)to + c] += (double)pixel[c] * (double)g->light[3 * (size_t)from + c];
}

static void check_light(const struct exported *e, enum ort_light kind, uint32_t seed)
{
    const size_t count = 3 * (size_t)e->f.map.texel_count;
    float *light = ort_texel_floats(&e->f), *expected = ort_texel_floats(&e->f);
    double *sum = calloc(count, sizeof *sum), total = 0.0;
    assert_non_null(sum);
    ort_random_light(&e->f, kind, seed, light);
    ort_indirect(&e->f, &e->baked, light, expected);
    struct gather g = { e, json_object_get(e->read.index, "offsets"), light, sum };
    visit_pieces(&e->read, gather, &g);
    const double scale = number_of(e->read.index, "scale");
    for (size_t i = 0; i < count; i++) {
        CHECK_RELATIVE(sum[i] / scale, expected[i], 1e-6);
        total += sum[i];
    }
    CHECK(total > 0.0);
    free(light);
    free(expected);
    free(sum);
}

TEST(pieces_gather_the_light_of_the_maps)
{
    struct exported e;
    exported_open(&e, folder_of("light"));
    check_light(&e, ORT_SMOOTH, 1);
    check_light(&e, ORT_SPOTS, 2);
    exported_close(&e);
}

// ---- the index

static void check_offsets(const struct exported *e)
{
    const struct tensor *tensor = tensors_find(e->baked.tensors, ORT_OFFSETS);
    const int32_t *expected = tensor->data;
    const json_t *groups = json_object_get(e->read.index, "offsets");
    CHECK(json_array_size(groups) == tensor->shape[0] && tensor->shape[0] == 3);
    for (size_t g = 0; g < tensor->shape[0]; g++) {
        const json_t *group = json_array_get(groups, g);
        CHECK(json_array_size(group) == tensor->shape[1]);
        for (size_t i = 0; i < 2 * tensor->shape[1]; i++)
            CHECK(json_integer_value(json_array_get(json_array_get(group, i / 2), i % 2)) ==
                  expected[2 * g * tensor->shape[1] + i]);
    }
}

TEST(index_has_the_plane_offsets_and_energy)
{
    static const char *const ENERGY[] = { "offsets", "exact" };
    struct exported e;
    exported_open(&e, folder_of("index"));
    const json_t *index = e.read.index, *plane = json_object_get(index, "plane"),
                 *map = json_object_get(index, "light_map");
    CHECK_STRING(json_string_value(json_object_get(index, "format")), "afterglow-ort-bins");
    CHECK_STRING(json_string_value(json_object_get(index, "transfer")), "radiosity");
    CHECK(number_of(index, "version") == 1 && number_of(index, "bin_side") == ORT_BIN_SIDE);
    CHECK(number_of(plane, "width") == e.f.map.width);
    CHECK(number_of(plane, "height") == 2 * number_of(map, "height"));
    CHECK(number_of(map, "height") == e.f.map.charts.height && number_of(map, "sides") == 2);
    check_offsets(&e);
    const float *energy = tensors_find(e.baked.tensors, ORT_ENERGY)->data;
    for (size_t i = 0; i < 6; i++)
        CHECK_RELATIVE(
            json_number_value(json_array_get(
                json_object_get(json_object_get(index, "energy"), ENERGY[i / 3]), i % 3)),
            energy[i], 1e-8);
    exported_close(&e);
}

TEST(export_has_the_same_bytes_again)
{
    struct exported e;
    const char *first = folder_of("first"), *second = folder_of("second");
    exported_open(&e, first);
    CHECK(export_to(&e.f, e.baked.tensors, second));
    CHECK(export_to(&e.f, e.baked.tensors, second)); // replaces its files
    for (int i = -1; i < e.read.bin_count; i++) {
        const char *name = i < 0 ? "index.json"
                                 : json_string_value(json_array_get(
                                       json_object_get(e.read.index, "files"), (size_t)i));
        struct file_bytes a = bytes_of(first, name), b = bytes_of(second, name);
        CHECK(a.size == b.size && memcmp(a.data, b.data, a.size) == 0);
        file_bytes_finish(test_host(), &a);
        file_bytes_finish(test_host(), &b);
    }
    exported_close(&e);
}

TEST(export_of_an_empty_scene_has_no_bins)
{
    struct ort_fixture f = { 0 };
    fixture_init(&f.s, NULL);
    ort_fixture_open(&f, SMALL);
    struct ort_baked baked = ort_fixture_bake(&f, "", 0);
    const char *folder = folder_of("empty");
    CHECK(export_to(&f, baked.tensors, folder));
    struct read_export read = read_export(folder);
    CHECK(read.bin_count == 0 && json_array_size(json_object_get(read.index, "pieces")) == 0);
    read_finish(&read);
    ort_baked_finish(&baked);
    ort_fixture_close(&f);
}

// ---- failures

TEST(export_of_offsets_beyond_the_light_map_is_refused)
{
    struct exported e;
    exported_open(&e, folder_of("beyond"));
    const char *folder = folder_of("nothing");
    const struct tensor *offsets = tensors_find(e.baked.tensors, ORT_OFFSETS);
    struct tensor *at = malloc(e.baked.tensors->count * sizeof *at);
    int32_t *data = malloc(offsets->bytes);
    assert_true(at && data);
    memcpy(at, e.baked.tensors->at, e.baked.tensors->count * sizeof *at);
    memcpy(data, offsets->data, offsets->bytes);
    data[0] = (int32_t)e.f.map.width;
    at[offsets - e.baked.tensors->at].data = data;
    struct tensors damaged = *e.baked.tensors;
    damaged.at = at;
    CHECK(!export_to(&e.f, &damaged, folder));
    CHECK(strstr(test_last_message(), "beyond the light map"));
    CHECK(rmdir(folder) == 0); // it is empty
    free(at);
    free(data);
    exported_close(&e);
}

TEST(export_into_a_missing_folder_names_it)
{
    struct exported e;
    exported_open(&e, folder_of("there"));
    CHECK(!export_to(&e.f, e.baked.tensors, test_path("absent")));
    CHECK(strstr(test_last_message(), "absent/bin-000.exr: no such folder"));
    exported_close(&e);
}
