// Maps of several pages: lookups through their files are those through the files of one map.
#include "lightmap/lightmap_fixture.h"

#include "lightmap/write.h"

#include "core/files/file.h"
#include "core/rng.h"
#include "core/sampling.h"
#include "image/exr.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { SAMPLES = 4, MOST_sideS = 16 };
static const int TEXELS = 8192;

struct files {
    char folder[512];
    struct scene *scene; // of the copy
    json_t *document;
    struct image pages[LIGHTMAP_SIDES][MOST_sideS];
    uint32_t page_count;
    bool has_back;
};

// ---- files

static json_t *read_document(const char *path)
{
    struct file_bytes bytes;
    uint32_t length;
    CHECK(file_read(test_host(), path, 0, &bytes));
    memcpy(&length, bytes.data + 12, sizeof length);
    json_t *document = json_loadb((const char *)bytes.data + 20, length, 0, NULL);
    assert_non_null(document);
    file_bytes_finish(test_host(), &bytes);
    return document;
}

static void read_page(struct files *f, enum lightmap_side side, uint32_t page)
{
    static const char *const names[] = { "irradiance", "irradiance_back" };
    char path[640], number[16] = "";
    if (f->page_count > 1) snprintf(number, sizeof number, ".%u", page);
    snprintf(path, sizeof path, "%s/%s%s.exr", f->folder, names[side], number);
    CHECK(exr_read(test_host(), path, NULL, &f->pages[side][page]));
    char *stated = exr_attribute_value(test_host(), path, "afterglow.page");
    if (f->page_count > 1)
        CHECK_STRING(stated, number + 1);
    else
        CHECK(!stated);
    host_free(test_host(), stated);
}

static struct files write_files(const struct lightmap *map, const struct scene *scene,
                                const char *name)
{
    struct files f = { .page_count = charts_page_count(&map->charts), .has_back = map->has_back };
    char path[600];
    snprintf(f.folder, sizeof f.folder, "%s", test_path(name));
    CHECK(mkdir(f.folder, 0700) == 0);
    const struct lightmap_facts facts = { .samples = SAMPLES, .punctual = true, .gi = "test" };
    CHECK(lightmap_write(map, scene, &facts, LIGHTMAP_FORMATS, f.folder));
    snprintf(path, sizeof path, "%s/scene.glb", f.folder);
    f.scene = scene_load(test_host(), path);
    assert_non_null(f.scene);
    f.document = read_document(path);
    assert_true(f.page_count <= MOST_sideS);
    for (uint32_t i = 0; i < f.page_count; i++) {
        read_page(&f, LIGHTMAP_FRONT, i);
        if (f.has_back) read_page(&f, LIGHTMAP_BACK, i);
    }
    return f;
}

static void close_files(struct files *f)
{
    for (int side = 0; side < LIGHTMAP_SIDES; side++)
        for (uint32_t i = 0; i < f->page_count; i++) image_finish(&f->pages[side][i], test_host());
    json_decref(f->document);
    scene_destroy(f->scene);
}

// ---- the copy's members

static const json_t *item(const json_t *json, const char *array, size_t index)
{
    const json_t *at = json_array_get(json_object_get(json, array), index);
    assert_non_null(at);
    return at;
}

// Instances of the copy of a built-in scene have a mesh of one primitive each, in their order.
static const json_t *primitive_of(const struct files *f, int instance)
{
    const json_t *node = item(f->document, "nodes", (size_t)f->scene->instances[instance].node);
    const json_t *mesh = json_object_get(node, "mesh");
    return item(item(f->document, "meshes", (size_t)json_integer_value(mesh)), "primitives", 0);
}

static uint32_t page_of(const struct files *f, int instance)
{
    const json_t *extras = json_object_get(primitive_of(f, instance), "extras");
    const json_t *page = json_object_get(json_object_get(extras, "afterglow_lightmap"), "page");
    CHECK((page != NULL) == (f->page_count > 1));
    return (uint32_t)json_integer_value(page);
}

// The texture of the instance's material is the image of its page.
static void check_material(const struct files *f, int instance)
{
    const json_t *material =
        item(f->document, "materials",
             (size_t)json_integer_value(json_object_get(primitive_of(f, instance), "material")));
    const json_t *map = json_object_get(json_object_get(material, "extensions"), "MOZ_lightmap");
    const json_t *texture =
        item(f->document, "textures", (size_t)json_integer_value(json_object_get(map, "index")));
    const json_t *image =
        item(f->document, "images", (size_t)json_integer_value(json_object_get(texture, "source")));
    char name[32];
    snprintf(name, sizeof name, "irradiance.%u", page_of(f, instance));
    CHECK_STRING(json_string_value(json_object_get(image, "name")), name);
}

static void check_maps(const struct files *f, int side)
{
    const json_t *extras =
        json_object_get(json_object_get(f->document, "extras"), "afterglow_lightmap");
    const json_t *maps = json_object_get(extras, "maps"), *map;
    size_t i;
    assert_int_equal(json_array_size(maps), 3 * f->page_count * (f->has_back ? 2 : 1));
    json_array_foreach(maps, i, map)
    {
        char path[640];
        const json_int_t page = json_integer_value(json_object_get(map, "page"));
        assert_int_equal(page, i / 3 % f->page_count);
        const struct image *image = &f->pages[LIGHTMAP_FRONT][page];
        assert_int_equal(json_integer_value(json_object_get(map, "width")), image->width);
        assert_int_equal(json_integer_value(json_object_get(map, "height")), image->height);
        CHECK(image->width == side && image->height <= side && image->height % 8 == 0);
        snprintf(path, sizeof path, "%s/%s", f->folder,
                 json_string_value(json_object_get(map, "uri")));
        struct stat info;
        CHECK(stat(path, &info) == 0 && info.st_size > 0);
    }
}

// ---- light

static vec3s light_at(const struct files *f, enum lightmap_side side, int instance,
                      uint32_t triangle, vec2s at)
{
    const struct mesh *mesh = scene_mesh_of(f->scene, instance);
    const float weight[3] = { 1.0f - at.x - at.y, at.x, at.y };
    vec2s uv = { { 0, 0 } };
    assert_non_null(mesh->uv[1]);
    for (uint32_t k = 0; k < 3; k++)
        uv = glms_vec2_muladds(mesh->uv[1][mesh->indices[3 * triangle + k]], weight[k], uv);
    CHECK(uv.x > 0.0f && uv.x < 1.0f && uv.y > 0.0f && uv.y < 1.0f);
    return fixture_lookup(&f->pages[side][page_of(f, instance)], uv);
}

// At random points of all triangles; the difference is that of coordinates as floats.
static void check_light(const struct charts *charts, const struct files *one,
                        const struct files *paged)
{
    enum { POINTS = 8 };
    double sum = 0.0, largest = 0.0;
    for (uint32_t i = 0; i < POINTS * charts->triangle_count; i++) {
        const struct chart_triangle *of = &charts->triangles[i / POINTS];
        const vec2s at = sample_triangle(sobol_2d(i, 3));
        for (int side = 0; side < (one->has_back ? 2 : 1); side++) {
            const vec3s a = light_at(one, side, of->instance, of->triangle, at);
            const vec3s b = light_at(paged, side, of->instance, of->triangle, at);
            largest = fmax(largest, (double)glms_vec3_distance(a, b));
            sum += (double)glms_vec3_norm(a);
        }
    }
    const double mean = sum / (POINTS * charts->triangle_count);
    print_message("mean light %.1f, largest difference %.2g\n", mean, largest);
    CHECK(mean > 0.0);
    CHECK(largest < 2e-3 * mean);
}

static void check_pages(const char *name, int side, uint32_t least)
{
    struct scene *scene = scene_load(test_host(), name);
    struct scene_pose pose;
    struct charts charts;
    struct lightmap map;
    CHECK(scene && pose_init(&pose, scene, -1, 0));
    struct bake *bake =
        fixture_bake(&(struct fixture_bake){ .pose = &pose, .texels = TEXELS, .samples = SAMPLES });
    CHECK(fixture_charts(&pose, &TEXELS, test_host(), NULL, &charts));
    CHECK(lightmap_init(&map, &charts, scene));
    CHECK(lightmap_set_paths(&map, bake_tensors(bake), true, false));
    struct files one = write_files(&map, scene, name + 1);
    CHECK(lightmap_set_pages(&map, scene, (uint32_t)side));
    struct files paged = write_files(&map, scene, name);
    CHECK(paged.page_count >= least && one.page_count == 1);
    check_maps(&paged, side);
    for (int i = 0; i < scene->instance_count; i++) check_material(&paged, i);
    check_light(&map.charts, &one, &paged);
    close_files(&one);
    close_files(&paged);
    lightmap_finish(&map);
    bake_destroy(bake);
    pose_finish(&pose);
    scene_destroy(scene);
}

TEST(light_through_pages_is_that_of_one_map)
{
    check_pages("@cornell", 64, 3);
}

// Charts of few texels, and materials that many instances share.
TEST(instances_on_different_pages_have_materials_of_their_own)
{
    check_pages("@atrium", 104, 2);
}
