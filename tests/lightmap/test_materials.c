// The light map in materials of a copy: which share it, which are divided, and how bytes stand for
// light.
#include "framework/test.h"

#include "image/png_decode.h"
#include "lightmap/materials.h"
#include "lightmap/texture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ON(n, page) "'extras':{'afterglow_lightmap':{'texCoord':" #n ",'page':" #page "}}"
#define SET(n)      "'extras':{'afterglow_lightmap':{'texCoord':" #n "}}"

static void begin(struct gltf_doc *doc, const char *text)
{
    char json[2048];
    snprintf(json, sizeof json, "%s", text);
    for (char *c = json; *c; c++)
        if (*c == '\'') *c = '"';
    CHECK(gltf_doc_init(doc, test_host()));
    json_decref(doc->root);
    doc->root = json_loads(json, 0, NULL);
    assert_non_null(doc->root);
}

static void give(struct gltf_doc *doc)
{
    static const uint8_t png[] = { 1, 2, 3 };
    const struct lightmap_image page = { png, sizeof png, 250.0f, "irradiance" };
    CHECK(lightmap_materials(doc, &page, 1));
    CHECK(!doc->failed);
}

static json_t *member(const json_t *json, const char *array, size_t index)
{
    json_t *at = json_array_get(json_object_get(json, array), index);
    assert_non_null(at);
    return at;
}

static json_t *primitive_at(const struct gltf_doc *doc, size_t index)
{
    return member(member(doc->root, "meshes", 0), "primitives", index);
}

// The set of the map that a holder's material has; 0: it has none.
static int set_of(const struct gltf_doc *doc, const json_t *holder)
{
    const json_t *material = member(
        doc->root, "materials", (size_t)json_integer_value(json_object_get(holder, "material")));
    const json_t *map = json_object_get(json_object_get(material, "extensions"), "MOZ_lightmap");
    if (!map) return 0;
    CHECK(json_number_value(json_object_get(map, "intensity")) == 250.0);
    CHECK(json_integer_value(json_object_get(map, "index")) == 1); // after the one of the file
    return (int)json_integer_value(json_object_get(map, "texCoord"));
}

static const char *name_of(const struct gltf_doc *doc, const json_t *holder)
{
    const size_t index = (size_t)json_integer_value(json_object_get(holder, "material"));
    return json_string_value(json_object_get(member(doc->root, "materials", index), "name"));
}

TEST(material_is_divided_where_uses_differ_in_coordinates_or_have_none)
{
    struct gltf_doc doc;
    static const int sets[] = { 1, 1, 2, 0, 2, 0 };
    begin(&doc, "{'materials':[{'name':'wall'},{'name':'ball'}],'textures':[{}],"
                "'meshes':[{'primitives':[{'material':0," SET(1) "},{'material':0," SET(
                    1) "},"
                       "{'material':0," SET(2) "},{'material':0},{'material':0," SET(
                           2) "},"
                              "{'material':1}]}]}");
    give(&doc);
    for (size_t i = 0; i < 6; i++) {
        assert_int_equal(set_of(&doc, primitive_at(&doc, i)), sets[i]);
        CHECK_STRING(name_of(&doc, primitive_at(&doc, i)), i < 5 ? "wall" : "ball");
    }
    assert_int_equal(json_array_size(gltf_doc_array(&doc, "materials")), 4);
    assert_int_equal(json_array_size(gltf_doc_array(&doc, "textures")), 2);
    assert_int_equal(json_array_size(gltf_doc_array(&doc, "images")), 1);
    assert_int_equal(doc.size, 4); // the bytes of the image, once
    gltf_doc_finish(&doc);
}

static json_int_t texture_of(const struct gltf_doc *doc, const json_t *holder)
{
    const json_t *material = member(
        doc->root, "materials", (size_t)json_integer_value(json_object_get(holder, "material")));
    const json_t *map = json_object_get(json_object_get(material, "extensions"), "MOZ_lightmap");
    assert_non_null(map);
    return json_integer_value(json_object_get(map, "index"));
}

// Page 1 has no use.
TEST(material_is_divided_where_uses_are_on_different_pages)
{
    static const struct lightmap_image pages[] = { { (const uint8_t *)"a", 1, 10.0f, "map.0" },
                                                   { (const uint8_t *)"b", 1, 20.0f, "map.1" },
                                                   { (const uint8_t *)"c", 1, 30.0f, "map.2" } };
    static const struct {
        json_int_t material, texture;
    } expected[] = { { 0, 0 }, { 1, 1 }, { 0, 0 }, { 2, 1 }, { 3, 0 } };
    struct gltf_doc doc;
    begin(&doc,
          "{'materials':[{'name':'wall'}],'meshes':[{'primitives':[{'material':0," ON(
              1, 2) "},{'material':0," ON(1, 0) "},{'material':0," ON(1,
                                                                      2) "},"
                                                                         "{'material':0," ON(
                                                                             2,
                                                                             0) "},{'material':"
                                                                                "0," ON(2,
                                                                                        2) "}]}]}");
    CHECK(lightmap_materials(&doc, pages, 3) && !doc.failed);
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        const json_t *primitive = primitive_at(&doc, i);
        assert_int_equal(json_integer_value(json_object_get(primitive, "material")),
                         expected[i].material);
        assert_int_equal(texture_of(&doc, primitive), expected[i].texture);
    }
    const json_t *images = json_object_get(doc.root, "images");
    assert_int_equal(json_array_size(images), 2);
    CHECK_STRING(json_string_value(json_object_get(json_array_get(images, 0), "name")), "map.2");
    CHECK_STRING(json_string_value(json_object_get(json_array_get(images, 1), "name")), "map.0");
    assert_int_equal(json_array_size(json_object_get(doc.root, "samplers")), 1);
    const json_t *map = json_object_get(
        json_object_get(member(doc.root, "materials", 2), "extensions"), "MOZ_lightmap");
    CHECK(json_number_value(json_object_get(map, "intensity")) == 10.0);
    assert_int_equal(json_integer_value(json_object_get(map, "texCoord")), 2);
    gltf_doc_finish(&doc);
}

TEST(materials_of_pages_without_a_texture_are_divided_too)
{
    static const struct lightmap_image pages[2] = { { .range = 1.0f, .name = "map.0" },
                                                    { .range = 1.0f, .name = "map.1" } };
    struct gltf_doc doc;
    begin(&doc, "{'materials':[{'name':'wall'}],'meshes':[{'primitives':[{'material':0," ON(
                    1, 0) "},{'material':0," ON(1, 1) "},{'material':0," ON(1, 0) "}]}]}");
    CHECK(lightmap_materials(&doc, pages, 2) && !doc.failed);
    for (size_t i = 0; i < 3; i++) {
        assert_int_equal(json_integer_value(json_object_get(primitive_at(&doc, i), "material")),
                         i % 2);
        CHECK_STRING(name_of(&doc, primitive_at(&doc, i)), "wall");
    }
    CHECK(!json_object_get(member(doc.root, "materials", 1), "extensions"));
    CHECK(!json_object_get(doc.root, "textures") && !json_object_get(doc.root, "extensionsUsed"));
    gltf_doc_finish(&doc);
}

TEST(primitive_without_a_material_gets_the_default_one_with_the_map)
{
    struct gltf_doc doc;
    begin(&doc, "{'textures':[{}],'meshes':[{'primitives':[{" SET(1) "},{},{" SET(1) "}]}]}");
    give(&doc);
    assert_int_equal(set_of(&doc, primitive_at(&doc, 0)), 1);
    CHECK(!json_object_get(primitive_at(&doc, 1), "material"));
    assert_int_equal(set_of(&doc, primitive_at(&doc, 2)), 1);
    assert_int_equal(json_array_size(gltf_doc_array(&doc, "materials")), 1);
    gltf_doc_finish(&doc);
}

TEST(variants_have_the_map_and_unlit_materials_have_not)
{
    struct gltf_doc doc;
    begin(&doc, "{'materials':[{},{},{'extensions':{'KHR_materials_unlit':{}}}],'textures':[{}],"
                "'meshes':[{'primitives':[{'material':0," SET(
                    1) ",'extensions':{"
                       "'KHR_materials_variants':{'mappings':[{'material':1,'variants':[0]},"
                       "{'material':2,'variants':[1]}]}}},{'material':1}]}]}");
    give(&doc);
    const json_t *variants = json_object_get(json_object_get(primitive_at(&doc, 0), "extensions"),
                                             "KHR_materials_variants");
    assert_int_equal(set_of(&doc, primitive_at(&doc, 0)), 1);
    assert_int_equal(set_of(&doc, member(variants, "mappings", 0)), 1);
    assert_int_equal(set_of(&doc, member(variants, "mappings", 1)), 0);
    assert_int_equal(set_of(&doc, primitive_at(&doc, 1)), 0);
    gltf_doc_finish(&doc);
}

TEST(map_of_an_earlier_copy_is_forgotten)
{
    struct gltf_doc doc;
    begin(&doc, "{'extensionsUsed':['MOZ_lightmap'],'materials':[{'extensions':{'MOZ_lightmap':"
                "{'index':0,'texCoord':1}}}],'textures':[{}],'meshes':[{'primitives':["
                "{'material':0," SET(1) "},{'material':0,'extras':{'a':1,'afterglow_lightmap':"
                                        "{'texCoord':1}}}]}]}");
    lightmap_forget(&doc);
    CHECK(!json_object_get(doc.root, "extensionsUsed"));
    CHECK(!json_object_get(member(doc.root, "materials", 0), "extensions"));
    CHECK(!json_object_get(primitive_at(&doc, 0), "extras"));
    assert_int_equal(json_object_size(json_object_get(primitive_at(&doc, 1), "extras")), 1);
    give(&doc);
    assert_int_equal(json_array_size(gltf_doc_array(&doc, "textures")), 1); // none has the map
    gltf_doc_finish(&doc);
}

// ---- bytes

enum { SIDE = 64 };

static uint8_t *decoded(const struct image *map, float *range)
{
    uint8_t *png, *rgba = malloc(4 * SIDE * SIDE);
    char why[DECODE_WHY_SIZE];
    size_t size;
    CHECK(lightmap_texture(test_host(), map, &png, &size, range));
    CHECK(rgba && !png_decode(png, size, SIDE, SIDE, rgba, why));
    host_free(test_host(), png);
    return rgba;
}

TEST(bytes_are_off_by_less_than_a_step_and_right_in_the_mean)
{
    struct image map = { 0 };
    float range, sum = 0.0f;
    CHECK(image_init(&map, test_host(), SIDE, SIDE, 3));
    for (int i = 0; i < SIDE * SIDE; i++)
        for (int c = 0; c < 3; c++)
            map.pixels[3 * i + c] = i == 100 ? 255.0f : i < SIDE * SIDE / 2 ? 0.3f : 77.0f;
    for (int i = SIDE * SIDE / 2; i < SIDE * SIDE; i++) map.pixels[3 * i + 1] = 255.0f;
    uint8_t *rgba = decoded(&map, &range);
    CHECK(range == 255.0f);
    for (int i = 0; i < SIDE * SIDE; i++)
        for (int c = 0; c < 3; c++)
            CHECK(fabsf((float)rgba[4 * i + c] - map.pixels[3 * i + c]) < 1.0f);
    for (int i = 0; i < SIDE * SIDE / 4; i++) sum += rgba[4 * i];
    // A third of a step, which rounding would make none.
    CHECK_NEAR((sum - 255.0f) / (SIDE * SIDE / 4), 0.3, 0.01);
    free(rgba);
    image_finish(&map, test_host());
}

TEST(one_texel_in_a_thousand_does_not_set_the_range)
{
    struct image map = { 0 };
    float range;
    CHECK(image_init(&map, test_host(), SIDE, SIDE, 3));
    for (int i = 0; i < SIDE * SIDE; i++) map.pixels[3 * i] = i % 1024 == 7 ? 1e6f : 20.0f;
    uint8_t *rgba = decoded(&map, &range);
    CHECK(range == 20.0f && rgba[4 * 7] == 255 && rgba[4 * 8] == 255 && rgba[4 * 8 + 1] == 0);
    free(rgba);
    memset(map.pixels, 0, 3 * SIDE * SIDE * sizeof *map.pixels);
    rgba = decoded(&map, &range);
    CHECK(range == 1.0f && rgba[0] == 0);
    free(rgba);
    image_finish(&map, test_host());
}
