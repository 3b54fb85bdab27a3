// Copies of scenes as glTF: what is in a file stays, what is not in one is written, and light-map
// coordinates are added.
#include "framework/test.h"

#include "lightmap/attach.h"
#include "scene/charts/charts.h"
#include "scene/charts/unwrap.h"
#include "scene/scene_edit.h"
#include "../scene/gltf_maker.h"

#include <math.h>

static struct scene *written(struct gltf_doc *doc)
{
    CHECK(gltf_doc_write(doc, test_path("copy.glb")));
    test_forget_messages();
    struct scene *scene = scene_load(test_host(), test_path("copy.glb"));
    assert_non_null(scene);
    return scene;
}

// With an atlas that covers all. Returns the number of single-texel charts.
static int attach_at(struct gltf_doc *doc, const struct scene *scene,
                     const struct charts_options *how)
{
    struct scene_pose pose;
    struct charts charts;
    CHECK(pose_init(&pose, scene, -1, 0));
    int singles = 0;
    CHECK(charts_init(&charts, test_host(), &pose, how));
    CHECK(lightmap_attach(doc, &charts, scene));
    for (uint32_t c = 0; c < charts.count; c++) singles += charts.charts[c].single_texel;
    charts_finish(&charts);
    pose_finish(&pose);
    return singles;
}

static void attach(struct gltf_doc *doc, const struct scene *scene)
{
    attach_at(doc, scene, &(struct charts_options){ .texels_per_m = 16, .max_texels = 1 << 20 });
}

// Corners of all triangles, in their order: the same up to the numbers of vertices.
static void check_corners(const struct mesh *a, const struct mesh *b)
{
    assert_int_equal(a->index_count, b->index_count);
    for (uint32_t i = 0; i < a->index_count; i++) {
        const uint32_t x = a->indices[i], y = b->indices[i];
        CHECK(memcmp(&a->positions[x], &b->positions[y], sizeof(vec3s)) == 0);
        CHECK_NEAR(glms_vec3_dot(a->normals[x], b->normals[y]), 1, 1e-6);
        if (a->uv[0]) CHECK(memcmp(&a->uv[0][x], &b->uv[0][y], sizeof(vec2s)) == 0);
        if (a->colors) CHECK(memcmp(&a->colors[x], &b->colors[y], sizeof(vec4s)) == 0);
    }
}

static void check_materials(const struct scene *a, const struct scene *b)
{
    CHECK(b->material_count >= a->material_count);
    for (int i = 0; i < a->material_count; i++) {
        const struct material *x = &a->materials[i], *y = &b->materials[i];
        CHECK(memcmp(&x->base_color, &y->base_color, sizeof x->base_color) == 0);
        CHECK(memcmp(&x->emissive, &y->emissive, sizeof x->emissive) == 0);
        CHECK(x->roughness == y->roughness && x->metallic == y->metallic && x->ior == y->ior);
        CHECK(x->double_sided == y->double_sided && x->alpha_mode == y->alpha_mode);
        CHECK((x->base_color_map.image < 0) == (y->base_color_map.image < 0));
    }
}

static void check_images(const struct scene *a, const struct scene *b)
{
    assert_int_equal(a->image_count, b->image_count);
    for (int i = 0; i < a->image_count; i++) {
        const size_t texels = (size_t)a->images[i].width * (size_t)a->images[i].height;
        assert_int_equal(a->images[i].width, b->images[i].width);
        CHECK(memcmp(a->images[i].rgba, b->images[i].rgba, 4 * texels) == 0);
    }
}

static void check_lights(const struct scene *a, const struct scene *b)
{
    struct scene_pose x, y;
    CHECK(pose_init(&x, a, -1, 0) && pose_init(&y, b, -1, 0));
    assert_int_equal(a->light_count, b->light_count);
    for (int i = 0; i < a->light_count; i++) {
        const struct world_light p = pose_light(&x, i), q = pose_light(&y, i);
        CHECK(p.type == q.type && memcmp(&p.intensity, &q.intensity, sizeof p.intensity) == 0);
        CHECK_NEAR(glms_vec3_distance(p.position, q.position), 0, 1e-5);
        CHECK_NEAR(glms_vec3_dot(p.direction, q.direction), 1, 1e-5);
    }
    CHECK(memcmp(&a->environment, &b->environment, sizeof a->environment) == 0);
    pose_finish(&x);
    pose_finish(&y);
}

static void check_same(const struct scene *a, const struct scene *b)
{
    struct scene_pose x, y;
    assert_int_equal(a->instance_count, b->instance_count);
    CHECK(pose_init(&x, a, -1, 0) && pose_init(&y, b, -1, 0));
    for (int i = 0; i < a->instance_count; i++) {
        const mat4s p = pose_world_from_instance(&x, i), q = pose_world_from_instance(&y, i);
        for (int k = 0; k < 16; k++) CHECK_NEAR(p.raw[k / 4][k % 4], q.raw[k / 4][k % 4], 1e-6);
        check_corners(scene_mesh_of(a, i), scene_mesh_of(b, i));
    }
    pose_finish(&x);
    pose_finish(&y);
    check_materials(a, b);
    check_images(a, b);
    check_lights(a, b);
    assert_int_equal(a->camera_count, b->camera_count);
}

static void check_builtin(const char *name)
{
    struct gltf_doc doc;
    struct scene *scene = scene_load(test_host(), name);
    assert_non_null(scene);
    CHECK(gltf_doc_of_scene(&doc, test_host(), scene));
    attach(&doc, scene);
    struct scene *copy = written(&doc);
    check_same(scene, copy);
    scene_destroy(copy);
    scene_destroy(scene);
    gltf_doc_finish(&doc);
}

TEST(scenes_made_by_code_are_the_same_when_read_back)
{
    check_builtin("@cornell:light=point");
    check_builtin("@atrium");
    check_builtin("@spheres");
}

// ---- a file

struct vertex {
    float position[3], uv[2];
    uint8_t mark[4];
};

// A folded sheet: two squares at a right angle that share an edge's vertices. Two nodes show it.
static const struct vertex sheet[6] = {
    { { 0, 0, 0 }, { 0, 0 }, { 10 } }, { { 1, 0, 0 }, { 1, 0 }, { 11 } },
    { { 0, 1, 0 }, { 0, 1 }, { 12 } }, { { 1, 1, 0 }, { 1, 1 }, { 13 } },
    { { 0, 1, 1 }, { 0, 2 }, { 14 } }, { { 1, 1, 1 }, { 1, 2 }, { 15 } },
};
static const uint16_t corners[12] = { 0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4 };

#define SHEET(material)                                                                            \
    "{" ASSET ",'extensionsUsed':['EXAMPLE_unknown'],'extras':{'keep':[1,2.5,'x']},"               \
    "'scenes':[{'nodes':[0,1]}],'nodes':[{'mesh':0,'name':'a','extras':{'id':7}},"                 \
    "{'mesh':0,'translation':[3,0,0]}],'meshes':[{'primitives':[{'attributes':"                    \
    "{'POSITION':0,'TEXCOORD_0':1,'_MARK':2},'indices':3,'material':0}]}],"                        \
    "'materials':[" material "],'accessors':["                                                     \
    "{'bufferView':0,'componentType':5126,'type':'VEC3','count':6,'min':[0,0,0],'max':[1,1,1]},"   \
    "{'bufferView':0,'byteOffset':12,'componentType':5126,'type':'VEC2','count':6},"               \
    "{'bufferView':0,'byteOffset':20,'componentType':5121,'type':'SCALAR','count':6},"             \
    "{'bufferView':1,'componentType':5123,'type':'SCALAR','count':12}],'bufferViews':["            \
    "{'buffer':0,'byteLength':144,'byteStride':24},{'buffer':0,'byteOffset':144,'byteLength':24}]" \
    ",'images':[{'uri':'" PNG_2X2 "'}],'textures':[{'source':0}],"                                 \
    "'buffers':[{'uri':'made.bin','byteLength':168}]}"

static struct scene *load_sheet(const char *json)
{
    uint8_t bytes[168];
    memcpy(bytes, sheet, 144);
    memcpy(bytes + 144, corners, 24);
    struct scene *scene = load_gltf(json, bytes, sizeof bytes);
    assert_non_null(scene);
    return scene;
}

static size_t index_of(const json_t *object, const char *key)
{
    return (size_t)json_integer_value(json_object_get(object, key));
}

static json_t *primitive_of(struct gltf_doc *doc, size_t node)
{
    const size_t mesh = index_of(json_array_get(gltf_doc_array(doc, "nodes"), node), "mesh");
    return json_array_get(
        json_object_get(json_array_get(gltf_doc_array(doc, "meshes"), mesh), "primitives"), 0);
}

// Byte i of a padded attribute of one byte.
static int mark_at(struct gltf_doc *doc, const json_t *primitive, size_t i)
{
    const json_t *accessor =
        json_array_get(gltf_doc_array(doc, "accessors"),
                       index_of(json_object_get(primitive, "attributes"), "_MARK"));
    const json_t *view =
        json_array_get(gltf_doc_array(doc, "bufferViews"), index_of(accessor, "bufferView"));
    return doc->binary[index_of(view, "byteOffset") + i * index_of(view, "byteStride")];
}

// Also of charts that fit in a texel and share it.
static void check_unwraps(const char *name)
{
    struct gltf_doc doc;
    struct scene *scene = scene_load(test_host(), name);
    assert_non_null(scene);
    CHECK(gltf_doc_of_scene(&doc, test_host(), scene));
    const int singles = attach_at(&doc, scene,
                                  &(struct charts_options){ .texels_per_m = 1e6f,
                                                            .max_texels = 1 << 22,
                                                            .surface_texels = 65536,
                                                            .join = CHARTS_JOINED_ACROSS });
    struct scene *copy = written(&doc);
    print_message("%s: %d single-texel charts\n", name, singles);
    CHECK(singles > 10);
    for (int m = 0; m < copy->mesh_count; m++) {
        enum unwrap_fault fault;
        CHECK(unwrap_check(test_host(), &copy->meshes[m], 1, 0.0, &fault));
        if (fault > UNWRAP_ABSENT)
            fail_msg("%s: TEXCOORD_1 of %s %s", name, copy->meshes[m].name,
                     unwrap_fault_text(fault));
    }
    scene_destroy(copy);
    scene_destroy(scene);
    gltf_doc_finish(&doc);
}

TEST(coordinates_are_a_valid_unwrap_when_read_back)
{
    check_unwraps("@atrium");
    check_unwraps("@planter");
}

TEST(file_keeps_its_content_and_divided_vertices_all_their_attributes)
{
    struct scene *scene = load_sheet(SHEET("{'doubleSided':true}"));
    struct gltf_doc doc;
    bool same;
    CHECK(gltf_doc_of_file(&doc, test_host(), scene, &same) && same);
    assert_int_equal(doc.place_count, 2);
    attach(&doc, scene);
    json_t *extras = json_object_get(doc.root, "extras"), *first = primitive_of(&doc, 0);
    CHECK(json_number_value(json_array_get(json_object_get(extras, "keep"), 1)) == 2.5);
    CHECK(primitive_of(&doc, 1) != first); // each node has a mesh of its own
    // The shared edge is at the border of two charts: vertices 2 and 3 have copies.
    const json_t *accessor = json_array_get(
        gltf_doc_array(&doc, "accessors"), index_of(json_object_get(first, "attributes"), "_MARK"));
    assert_int_equal(index_of(accessor, "count"), 8);
    for (size_t i = 0; i < 6; i++) assert_int_equal(mark_at(&doc, first, i), 10 + i);
    assert_int_equal(mark_at(&doc, first, 6) + mark_at(&doc, first, 7), 12 + 13);
    CHECK(json_object_get(json_object_get(first, "attributes"), "TEXCOORD_1"));
    struct scene *copy = written(&doc);
    check_same(scene, copy);
    CHECK(strcmp(copy->nodes[0].name, "a") == 0 && strstr(copy->nodes[0].extras, "7"));
    for (int i = 0; i < 2; i++) assert_non_null(scene_mesh_of(copy, i)->uv[1]);
    scene_destroy(copy);
    scene_destroy(scene);
    gltf_doc_finish(&doc);
}

TEST(coordinates_do_not_replace_a_set_that_a_texture_uses)
{
    struct scene *scene = load_sheet(
        SHEET("{'occlusionTexture':{'index':0,'texCoord':1},'emissiveTexture':{'index':0}}"));
    struct gltf_doc doc;
    bool same;
    CHECK(gltf_doc_of_file(&doc, test_host(), scene, &same) && same);
    attach(&doc, scene);
    const json_t *primitive = primitive_of(&doc, 0);
    const json_t *of = json_object_get(json_object_get(primitive, "extras"), "afterglow_lightmap");
    assert_int_equal(index_of(of, "texCoord"), 2);
    for (int set = 0; set < 3; set++) {
        char name[16];
        snprintf(name, sizeof name, "TEXCOORD_%d", set);
        CHECK(json_object_get(json_object_get(primitive, "attributes"), name));
    }
    scene_destroy(written(&doc));
    scene_destroy(scene);
    gltf_doc_finish(&doc);
}

// One triangle of a vertex buffer that other primitives may share.
TEST(vertices_that_a_primitive_does_not_use_are_not_copied)
{
    char json[4096];
    snprintf(json, sizeof json, "%s", SHEET("{'doubleSided':true}"));
    char *count = strstr(json, "'count':12");
    memcpy(count, "'count':3 ", 10);
    struct scene *scene = load_sheet(json);
    struct gltf_doc doc;
    bool same;
    CHECK(gltf_doc_of_file(&doc, test_host(), scene, &same) && same);
    attach(&doc, scene);
    const json_t *primitive = primitive_of(&doc, 0);
    const json_t *accessor =
        json_array_get(gltf_doc_array(&doc, "accessors"),
                       index_of(json_object_get(primitive, "attributes"), "POSITION"));
    assert_int_equal(index_of(accessor, "count"), 3);
    CHECK(json_number_value(json_array_get(json_object_get(accessor, "max"), 1)) == 1.0);
    CHECK(json_number_value(json_array_get(json_object_get(accessor, "max"), 2)) == 0.0);
    CHECK(mark_at(&doc, primitive, 2) == 13); // vertices 0, 1 and 3
    struct scene *copy = written(&doc);
    check_same(scene, copy);
    scene_destroy(copy);
    scene_destroy(scene);
    gltf_doc_finish(&doc);
}

TEST(files_that_have_changed_since_are_not_copied)
{
    struct scene *scene = load_sheet(SHEET("{}"));
    struct gltf_doc doc;
    bool same = true;
    FILE *file = fopen(test_path("made.gltf"), "ab");
    CHECK(file && fputc(' ', file) == ' ' && fclose(file) == 0);
    CHECK(gltf_doc_of_file(&doc, test_host(), scene, &same) && !same);
    gltf_doc_finish(&doc);
    scene_destroy(scene);
}

// ---- triangles without an area

// Three squares around a corner, and between them a triangle on an edge, one whose corners are in
// two charts, and one of vertices that nothing else uses.
static struct scene *make_slivers(void)
{
    static vec3s positions[] = { { { 0, 0, 0 } },    { { 1, 0, 0 } }, { { 1, 1, 0 } },
                                 { { 0, 1, 0 } },    { { 0, 0, 1 } }, { { 0, 1, 1 } },
                                 { { 0.5f, 0, 0 } }, { { 9, 9, 9 } }, { { 1, 0, 1 } } };
    static uint32_t triangles[] = { 0, 1, 2, 0, 2, 3, 0, 3, 5, 0, 5, 4, 0, 4, 8,
                                    0, 8, 1, 0, 6, 1, 2, 5, 5, 7, 7, 7, 6, 7, 7 };
    struct scene *scene = scene_create(test_host(), "slivers");
    assert_non_null(scene);
    const struct material material = material_default();
    const struct node node = node_default();
    vec3s normals[9];
    for (int v = 0; v < 9; v++) normals[v] = vec3_of(0, 1, 0);
    const struct mesh mesh = { .name = "slivers",
                               .vertex_count = 9,
                               .index_count = 30,
                               .positions = positions,
                               .normals = normals,
                               .indices = triangles,
                               .material = scene_add_material(scene, &material) };
    const struct instance instance = { .node = scene_add_node(scene, &node),
                                       .mesh = scene_add_mesh(scene, &mesh),
                                       .skin = -1 };
    CHECK(scene_add_instance(scene, &instance) == 0);
    return scene;
}

// A chart whose rectangle contains the triangle's coordinates.
static bool is_in_a_chart(const struct charts *charts, const struct mesh *mesh, uint32_t triangle)
{
    const float size[2] = { (float)charts->width, (float)charts->height };
    for (uint32_t c = 0; c < charts->count; c++) {
        const struct chart *chart = &charts->charts[c];
        const float low[2] = { (float)chart->x, (float)chart->y };
        const float high[2] = { (float)(chart->x + chart->width),
                                (float)(chart->y + chart->height) };
        bool inside = true;
        for (uint32_t i = 0; i < 6; i++) {
            const uint32_t v = mesh->indices[3 * triangle + i / 2];
            const float at = mesh->uv[1][v].raw[i % 2] * size[i % 2];
            inside = inside && at >= low[i % 2] && at <= high[i % 2];
        }
        if (inside) return true;
    }
    return false;
}

TEST(coordinates_of_a_triangle_are_in_one_chart_even_without_an_area)
{
    struct scene *scene = make_slivers();
    struct scene_pose pose;
    struct charts charts;
    struct gltf_doc doc;
    CHECK(pose_init(&pose, scene, -1, 0));
    CHECK(charts_init(&charts, test_host(), &pose,
                      &(struct charts_options){ .texels_per_m = 16, .max_texels = 1 << 20 }));
    assert_int_equal(charts.count, 3);
    assert_int_equal(charts.without_area, 4);
    CHECK(gltf_doc_of_scene(&doc, test_host(), scene) && lightmap_attach(&doc, &charts, scene));
    struct scene *copy = written(&doc);
    const struct mesh *mesh = scene_mesh_of(copy, 0);
    check_corners(scene_mesh_of(scene, 0), mesh);
    for (uint32_t t = 0; t < mesh->index_count / 3; t++)
        if (!is_in_a_chart(&charts, mesh, t)) fail_msg("triangle %u is in no chart", t);
    charts_finish(&charts);
    pose_finish(&pose);
    scene_destroy(copy);
    scene_destroy(scene);
    gltf_doc_finish(&doc);
}

// ---- what the file has not

#define TWO_LAMPS                                                                                  \
    "{" ASSET ",'extensionsUsed':['KHR_lights_punctual'],'extensions':{'KHR_lights_punctual':"     \
    "{'lights':[{'type':'point','color':[0.1,0.2,0.3],'intensity':7}]}},"                          \
    "'nodes':[{'children':[1]},{'extensions':{'KHR_lights_punctual':{'light':0}}},"                \
    "{'extensions':{'KHR_lights_punctual':{'light':0}},'translation':[0,3,0]}]}"

static struct scene *load_lamps(void)
{
    struct scene *scene = load_gltf(TWO_LAMPS, NULL, 0);
    assert_non_null(scene);
    assert_int_equal(scene->light_count, 2);
    return scene;
}

static const json_t *lights_of(const struct gltf_doc *doc)
{
    const json_t *extensions = json_object_get(doc->root, "extensions");
    return json_object_get(json_object_get(extensions, "KHR_lights_punctual"), "lights");
}

TEST(added_lights_and_sky_join_the_scene_of_a_file_without_scenes)
{
    struct scene *scene = load_lamps();
    struct gltf_doc doc;
    bool same;
    const struct placed_light added = { .position = { { 1, 2, 3 } },
                                        .direction = { { 0.1f, -1, 0.3f } },
                                        .light = { .name = "added",
                                                   .type = LIGHT_SPOT,
                                                   .intensity = { { 1000.1f, 3.3f, 0 } },
                                                   .inner_rad = 0.3f,
                                                   .outer_rad = 0.5f } };
    CHECK(scene_add_placed_light(scene, &added) == 2);
    scene_set_sky(scene, vec3_of(0.1f, 0.2f, 0.3f));
    CHECK(gltf_doc_of_file(&doc, test_host(), scene, &same) && same);
    struct scene *copy = written(&doc);
    check_lights(scene, copy);
    CHECK(strcmp(copy->lights[2].name, "added") == 0);
    scene_destroy(copy);
    scene_destroy(scene);
    gltf_doc_finish(&doc);
}

TEST(light_of_two_nodes_is_divided_where_one_is_switched_off)
{
    struct scene *scene = load_lamps();
    struct gltf_doc doc;
    bool same;
    scene->lights[0].off = true;
    CHECK(gltf_doc_of_file(&doc, test_host(), scene, &same) && same);
    assert_int_equal(json_array_size(lights_of(&doc)), 2);
    assert_int_equal(doc.off_light_count, 2);
    CHECK(!doc.off_lights[0] && doc.off_lights[1]);
    CHECK(json_equal(json_array_get(lights_of(&doc), 0), json_array_get(lights_of(&doc), 1)));
    scene_destroy(scene);
    gltf_doc_finish(&doc);
}

TEST(light_that_was_moved_is_written_where_it_is_now)
{
    struct scene *scene = load_lamps();
    struct gltf_doc doc;
    bool same;
    struct placed_light moved = { .position = { { 5, 6, 7 } },
                                  .direction = { { 0, -1, 0 } },
                                  .light = scene->lights[1] };
    CHECK(scene_set_light(scene, 1, &moved));
    CHECK(gltf_doc_of_file(&doc, test_host(), scene, &same) && same);
    assert_int_equal(json_array_size(lights_of(&doc)), 3);
    CHECK(!doc.off_lights[0] && doc.off_lights[1]);
    scene_destroy(written(&doc));
    scene_destroy(scene);
    gltf_doc_finish(&doc);
}
