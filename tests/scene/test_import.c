// Import of small glTF files: one for each feature, and invalid ones that are refused.
#include "scene/gltf_maker.h"

#include "scene/pose.h"

#include <math.h>

#define BUFFER(bytes)        "'buffers':[{'uri':'made.bin','byteLength':" #bytes "}]"
#define VIEW(offset, length) "{'buffer':0,'byteOffset':" #offset ",'byteLength':" #length "}"
#define FLOATS(view, type, count)                                                                  \
    "{'bufferView':" #view ",'componentType':5126,'type':'" type "','count':" #count "}"
#define SCENE "'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}]"
// One triangle of three positions: view 0, accessor 0, 36 bytes.
#define TRIANGLE_DATA                                                                              \
    BUFFER(36) ",'bufferViews':[" VIEW(0, 36) "],'accessors':[" FLOATS(0, "VEC3", 3) "]"
#define TRIANGLE_MESH "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}]"

static const float triangle[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };

static struct scene *load_triangle(const char *json)
{
    struct scene *scene = load_gltf(json, triangle, sizeof triangle);
    if (!scene) fail_msg("%s", test_last_message());
    return scene;
}

TEST(a_mesh_without_normals_gets_flat_normals)
{
    // Two triangles share an edge and are at a right angle to each other.
    struct {
        float p[4][3];
        uint16_t i[6];
    } data = { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }, { 0, 1, 2, 0, 3, 1 } };
    struct scene *scene = load_gltf(
        "{" ASSET "," SCENE ",'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1}]}]"
        "," BUFFER(60) ",'bufferViews':[" VIEW(0, 48) "," VIEW(48, 12) "],'accessors':[" FLOATS(
            0, "VEC3", 4) ",{'bufferView':1,'componentType':"
                          "5123,'type':'SCALAR','count':6}]}",
        &data, sizeof data);
    CHECK(scene && scene->mesh_count == 1);
    const struct mesh *mesh = &scene->meshes[0];
    CHECK(mesh->vertex_count == 6 && mesh->index_count == 6);
    for (int k = 0; k < 3; k++) CHECK_NEAR(mesh->normals[mesh->indices[k]].z, 1.0, 1e-6);
    for (int k = 3; k < 6; k++) CHECK_NEAR(mesh->normals[mesh->indices[k]].y, 1.0, 1e-6);
    scene_destroy(scene);
}

TEST(a_mesh_keeps_only_the_vertices_that_it_uses)
{
    struct {
        float p[6][3], n[6][3];
        uint8_t i[4];
    } data = { .i = { 5, 1, 3 } };
    for (int v = 0; v < 6; v++) {
        data.p[v][0] = v == 0 ? NAN : (float)v; // not finite, but unused
        data.p[v][1] = v == 1;
        data.n[v][2] = 2.0f; // not of length one
    }
    struct scene *scene = load_gltf(
        "{" ASSET "," SCENE ",'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1},"
        "'indices':2}]}]," BUFFER(148) ",'bufferViews':[" VIEW(0, 72) "," VIEW(72, 72) "," VIEW(
            144, 3) "],'accessors':[" FLOATS(0, "VEC3",
                                             6) "," FLOATS(1, "VEC3",
                                                           6) ",{'bufferView':2,'componentType':"
                                                              "5121,'type':'SCALAR','count':3}]}",
        &data, sizeof data);
    CHECK(scene);
    const struct mesh *mesh = &scene->meshes[0];
    CHECK(mesh->vertex_count == 3);
    CHECK_NEAR(mesh->positions[mesh->indices[0]].x, 5.0, 0.0);
    CHECK_NEAR(mesh->positions[mesh->indices[1]].x, 1.0, 0.0);
    CHECK_NEAR(mesh->bounds.min.x, 1.0, 0.0);
    CHECK_NEAR(mesh->normals[0].z, 1.0, 1e-6);
    scene_destroy(scene);
}

TEST(strips_and_fans_keep_their_winding)
{
    static const float quad[12] = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0 };
    static const float fan[12] = { 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0 };
    for (int mode = 5; mode <= 6; mode++) {
        char json[1024];
        snprintf(json, sizeof json,
                 "{" ASSET "," SCENE ",'meshes':[{'primitives':[{'attributes':{'POSITION':0},"
                 "'mode':%d}]}]," BUFFER(48) ",'bufferViews':[" VIEW(
                     0, 48) "],'accessors':[" FLOATS(0, "VEC3", 4) "]}",
                 mode);
        struct scene *scene = load_gltf(json, mode == 5 ? quad : fan, sizeof quad);
        CHECK(scene && scene_triangle_count(scene) == 2);
        for (uint32_t v = 0; v < 6; v++) CHECK_NEAR(scene->meshes[0].normals[v].z, 1.0, 1e-6);
        scene_destroy(scene);
    }
}

TEST(normalised_integers_become_fractions)
{
    struct {
        int16_t p[3][4]; // stride 8
        uint8_t c[3][4];
    } data = { { { 0, 0, 0 }, { 32767, 0, 0 }, { 0, -32768, 0 } }, { { 255, 51 }, { 0 }, { 0 } } };
    struct scene *scene =
        load_gltf("{" ASSET "," SCENE ",'extensionsRequired':['KHR_mesh_quantization'],"
                  "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'COLOR_0':1}}]}]"
                  "," BUFFER(36) ",'bufferViews':[{'buffer':0,'byteLength':24,'byteStride':8}"
                                 "," VIEW(24, 12) "],"
                                                  "'accessors':[{'bufferView':0,'componentType'"
                                                  ":5122,'normalized':true,'type':'VEC3',"
                                                  "'count':3},{'bufferView':1,'componentType':"
                                                  "5121,'normalized':true,'type':'VEC4',"
                                                  "'count':3}]}",
                  &data, sizeof data);
    CHECK(scene);
    const struct mesh *mesh = &scene->meshes[0];
    CHECK_NEAR(mesh->bounds.max.x, 1.0, 0.0);
    CHECK_NEAR(mesh->bounds.min.y, -1.0, 0.0);
    CHECK_NEAR(mesh->colors[0].y, 0.2, 1e-6);
    scene_destroy(scene);
}

TEST(sparse_values_replace_base_values)
{
    struct {
        float p[3][3], values[1][3];
        uint16_t slot, pad;
    } data = { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, { { 0, 7, 0 } }, 2, 0 };
    struct scene *scene = load_gltf(
        "{" ASSET "," SCENE "," TRIANGLE_MESH
        "," BUFFER(52) ",'bufferViews':[" VIEW(0, 36) "," VIEW(36, 12) "," VIEW(
            48, 2) "],'accessors':[{'bufferView':0,'componentType':5126,"
                   "'type':'VEC3','count':3,'sparse':{'count':1,'indices':{'bufferView':2,"
                   "'componentType':5123},'values':{'bufferView':1}}}]}",
        &data, sizeof data);
    CHECK(scene);
    CHECK_NEAR(scene->meshes[0].bounds.max.y, 7.0, 0.0);
    CHECK_NEAR(scene->meshes[0].bounds.max.x, 1.0, 0.0);
    scene_destroy(scene);
}

TEST(parents_precede_children_in_the_scene)
{
    struct scene *scene = load_triangle(
        "{" ASSET ",'scenes':[{'nodes':[2]}],'nodes':[{'mesh':0,'translation':[0,0,3]},"
        "{'children':[0],'scale':[-2,2,2]},"
        "{'children':[1],'matrix':[0,0,-1,0, 0,1,0,0, 1,0,0,0, 10,0,0,1]}]," TRIANGLE_MESH
        "," TRIANGLE_DATA "}");
    for (int i = 0; i < scene->node_count; i++) CHECK(scene->nodes[i].parent < i);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    mat4s world = pose_world_from_instance(&pose, 0);
    vec3s origin =
        mat4_point(world, vec3_of(0, 0, 0)); // z 3, scaled to 6, rotated to x, translated by 10
    CHECK_NEAR(origin.x, 16.0, 1e-5);
    CHECK_NEAR(origin.z, 0.0, 1e-5);
    CHECK(glms_mat4_det(world) < 0.0f);
    pose_finish(&pose);
    scene_destroy(scene);
}

TEST(only_the_default_scene_is_instanced)
{
    struct scene *scene = load_triangle(
        "{" ASSET ",'scene':1,'scenes':[{'nodes':[0]},{'nodes':[1]}],"
        "'nodes':[{'mesh':0},{'children':[2]},{'mesh':0,'name':'shown'}]," TRIANGLE_MESH
        "," TRIANGLE_DATA "}");
    CHECK(scene->instance_count == 1);
    CHECK_STRING(scene->nodes[scene->instances[0].node].name, "shown");
    CHECK(strstr(test_last_message(), "scenes other than"));
    scene_destroy(scene);
}

TEST(materials_have_the_values_of_the_file_and_glTF_defaults)
{
    struct scene *scene = load_gltf(
        "{" ASSET ",'materials':[{},{'name':'m','pbrMetallicRoughness':{'baseColorFactor':"
        "[0.1,0.2,0.3,0.4],'metallicFactor':0.5,'roughnessFactor':0.25,'baseColorTexture':"
        "{'index':0,'texCoord':1,'extensions':{'KHR_texture_transform':{'offset':[1,2],"
        "'scale':[3,4],'rotation':0.5}}}},'emissiveFactor':[1,0.5,0],'alphaMode':'MASK',"
        "'alphaCutoff':0.7,'doubleSided':true,'normalTexture':{'index':0,'scale':2},"
        "'extensions':{'KHR_materials_emissive_strength':"
        "{'emissiveStrength':200}}},{'emissiveFactor':[1,1,1],'extensions':{"
        "'KHR_materials_unlit':{}}}],'textures':[{'source':0,'sampler':0}],"
        "'samplers':[{'wrapS':33071,'wrapT':33648,'magFilter':9728}],"
        "'images':[{'uri':'" PNG_2X2 "'}]}",
        NULL, 0);
    if (!scene) fail_msg("%s", test_last_message());
    CHECK_STRING(test_last_message(), "");
    const struct material *d = &scene->materials[0], *m = &scene->materials[1];
    CHECK(d->metallic == 1.0f && d->roughness == 1.0f && d->base_color.w == 1.0f);
    CHECK(d->alpha_mode == ALPHA_OPAQUE && !d->double_sided && d->base_color_map.image == -1);
    CHECK(luminance(d->emissive) == 0.0f && d->alpha_cutoff == 0.5f && !d->unlit);
    CHECK_NEAR(m->base_color.z, 0.3, 1e-6);
    CHECK_NEAR(m->emissive.y, 100.0, 1e-4);
    CHECK(m->metallic == 0.5f && m->roughness == 0.25f && m->normal_scale == 2.0f);
    CHECK(m->alpha_mode == ALPHA_MASK && m->double_sided && !m->unlit);
    // Unlit materials do not emit.
    CHECK(scene->materials[2].unlit && luminance(scene->materials[2].emissive) == 0.0f);
    CHECK_NEAR(m->alpha_cutoff, 0.7, 1e-6);
    const struct texture_use *use = &m->base_color_map;
    CHECK(use->image == 0 && use->uv_set == 1 && use->nearest);
    CHECK(use->wrap_u == WRAP_CLAMP && use->wrap_v == WRAP_MIRROR);
    CHECK(use->uv_offset[1] == 2.0f && use->uv_scale[0] == 3.0f && use->uv_rotation_rad == 0.5f);
    CHECK(m->normal_map.uv_scale[0] == 1.0f);
    scene_destroy(scene);
}

TEST(specular_and_ior_of_gltf_are_read)
{
    struct scene *scene = load_gltf(
        "{" ASSET
        ",'extensionsUsed':['KHR_materials_ior','KHR_materials_specular'],'materials':[{},"
        "{'extensions':{'KHR_materials_ior':{'ior':1.8},'KHR_materials_specular':{"
        "'specularFactor':0.25,'specularColorFactor':[0.5,1,4],'specularTexture':{'index':0},"
        "'specularColorTexture':{'index':0,'extensions':{'KHR_texture_transform':{'scale':[3,4]}}}"
        "}}},{'extensions':{'KHR_materials_ior':{'ior':0}}}],"
        "'textures':[{'source':0}],'images':[{'uri':'" PNG_2X2 "'}]}",
        NULL, 0);
    if (!scene) fail_msg("%s", test_last_message());
    CHECK_STRING(test_last_message(), "");
    const struct material *d = &scene->materials[0], *m = &scene->materials[1];
    CHECK(material_has_default_specular(d) && !material_has_default_specular(m));
    CHECK_NEAR(material_specular_f0(d).x, 0.04, 1e-7);
    CHECK_NEAR(material_specular_f0(m).y, 0.8 * 0.8 / 2.8 / 2.8, 1e-7);
    CHECK_NEAR(material_specular_f0(&scene->materials[2]).z, 1, 0);
    CHECK(m->specular == 0.25f && m->specular_color.x == 0.5f && m->specular_color.z == 4.0f);
    CHECK(m->specular_map.image == 0 && m->specular_color_map.uv_scale[1] == 4.0f);
    scene_destroy(scene);
}

TEST(hostile_specular_values_are_clamped_or_refused)
{
    static const char *const refused[] = { "'KHR_materials_ior':{'ior':0.5}",
                                           "'KHR_materials_ior':{'ior':'glass'}",
                                           "'KHR_materials_specular':{'specularFactor':'x'}" };
    for (int i = 0; i < 3; i++) {
        char json[256];
        snprintf(json, sizeof json, "{" ASSET ",'materials':[{'extensions':{%s}}]}", refused[i]);
        CHECK(!load_gltf(json, NULL, 0));
    }
    struct scene *scene =
        load_gltf("{" ASSET ",'materials':[{'extensions':{'KHR_materials_specular':{"
                  "'specularFactor':7,'specularColorFactor':[-1,1e30,2]}}}]}",
                  NULL, 0);
    if (scene) {
        const struct material *m = &scene->materials[0];
        CHECK(m->specular <= 1.0f && m->specular_color.x == 0.0f);
        CHECK(isfinite(m->specular_color.y));
        scene_destroy(scene);
    }
}

TEST(images_are_decoded_top_row_first_and_shared)
{
    struct scene *scene = load_gltf(
        "{" ASSET ",'materials':[{'emissiveTexture':{'index':0}},{'emissiveTexture':{'index':1}}],"
        "'textures':[{'source':1},{'source':1}],'images':[{'uri':'unused.png'},{'uri':'" PNG_2X2
        "'}]}",
        NULL, 0);
    CHECK(scene && scene->image_count == 1 && !test_last_message()[0]);
    static const uint8_t expected[16] = { 255, 0, 0,   255, 0,   255, 0,   255,
                                          0,   0, 255, 255, 255, 255, 255, 0 };
    CHECK(scene->images[0].width == 2 && scene->images[0].height == 2);
    CHECK(memcmp(scene->images[0].rgba, expected, sizeof expected) == 0);
    CHECK(scene->images[0].has_alpha);
    CHECK(scene->materials[1].emissive_map.image == 0);
    scene_destroy(scene);
}

TEST(an_unreadable_image_is_noted_and_ignored)
{
    write_bytes("broken image.png", "\x89PNG\r\n\x1a\nnothing", 15);
    struct scene *scene = load_gltf(
        "{" ASSET ",'materials':[{'emissiveTexture':{'index':0}},{'emissiveTexture':{'index':1}}],"
        "'textures':[{'source':0},{'source':1}],'images':[{'uri':'nowhere.png'},"
        "{'uri':'./broken%20image.png'}]}",
        NULL, 0);
    CHECK(scene && scene->image_count == 0);
    CHECK(scene->materials[0].emissive_map.image == -1);
    CHECK(strstr(test_last_message(), "nowhere.png") && strstr(test_last_message(), "broken"));
    scene_destroy(scene);
}

TEST(lights_keep_their_units_range_and_cone)
{
    struct scene *scene = load_gltf(
        "{" ASSET ",'extensionsRequired':['KHR_lights_punctual'],'extensions':{"
        "'KHR_lights_punctual':{'lights':[{'type':'spot','color':[1,0.5,0],'intensity':40,"
        "'range':7,'spot':{'innerConeAngle':0.3,'outerConeAngle':0.6}},"
        "{'type':'spot','spot':{'innerConeAngle':0.5,'outerConeAngle':0.5}},"
        "{'type':'directional','intensity':100000},{'type':'point'}]}},"
        "'nodes':[{'extensions':{'KHR_lights_punctual':{'light':0}}},"
        "{'extensions':{'KHR_lights_punctual':{'light':1}}},"
        "{'extensions':{'KHR_lights_punctual':{'light':2}},'rotation':[-0.70710678,0,0,0.70710678]}"
        ","
        "{'extensions':{'KHR_lights_punctual':{'light':3}}}]}",
        NULL, 0);
    CHECK(scene && scene->light_count == 4);
    const struct light *l = scene->lights;
    CHECK(l[0].type == LIGHT_SPOT && l[0].range_m == 7.0f && l[3].range_m == 0.0f);
    CHECK_NEAR(l[0].intensity.y, 20.0, 1e-5);
    CHECK_NEAR(l[0].inner_rad, 0.3, 1e-6);
    CHECK_NEAR(l[0].outer_rad, 0.6, 1e-6);
    CHECK(l[1].inner_rad < l[1].outer_rad);
    CHECK(l[2].type == LIGHT_SUN && l[2].intensity.x == 100000.0f && l[3].type == LIGHT_POINT);
    CHECK(l[3].intensity.x == 1.0f);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    CHECK_NEAR(pose_light(&pose, 2).direction.y, -1.0, 1e-6); // the node's -z, rotated down
    pose_finish(&pose);
    scene_destroy(scene);
}

TEST(perspective_cameras_are_read_and_orthographic_ones_noted)
{
    struct scene *scene = load_gltf(
        "{" ASSET ",'cameras':[{'type':'orthographic','orthographic':{'xmag':1,'ymag':1,'znear':0,"
        "'zfar':1}},{'type':'perspective','perspective':{'yfov':0.8,'znear':0.05}}],"
        "'nodes':[{'camera':0},{'camera':1}]}",
        NULL, 0);
    CHECK(scene && scene->camera_count == 1);
    CHECK_NEAR(scene->cameras[0].vertical_fov_rad, 0.8, 1e-6);
    CHECK_NEAR(scene->cameras[0].near_m, 0.05, 1e-6);
    CHECK(strstr(test_last_message(), "orthographic"));
    scene_destroy(scene);
}

TEST(control_characters_in_names_are_escaped)
{
    struct scene *scene =
        load_gltf("{" ASSET ",'cameras':[{'name':'a\\u001b[31m\\u007f','type':'perspective',"
                  "'perspective':{'yfov':0.8,'znear':0.05}}],'nodes':[{'camera':0}]}",
                  NULL, 0);
    CHECK(scene && scene->camera_count == 1);
    CHECK_STRING(scene->cameras[0].name, "a\\u001b[31m\\u007f");
    scene_destroy(scene);
}

TEST(animations_keep_their_interpolation_and_drop_duplicate_keys)
{
    static const float data[] = { 0, 1, 1, 2,                         // times
                                  0, 0, 0, 1, 0, 0, 9, 9, 9, 3, 0, 0, // translations
                                  0, 0, 0, 2 }; // a rotation that is not normalised
    struct scene *scene = load_gltf(
        "{" ASSET ",'nodes':[{}],'animations':[{'name':'a','channels':["
        "{'sampler':0,'target':{'node':0,'path':'translation'}},"
        "{'sampler':1,'target':{'node':0,'path':'rotation'}},"
        "{'sampler':0,'target':{'node':0,'path':'scale'}}],"
        "'samplers':[{'input':0,'output':1},{'input':2,'output':3,'interpolation':'STEP'}]}]"
        "," BUFFER(80) ",'bufferViews':[" VIEW(0, 16) "," VIEW(16, 48) "," VIEW(
            64, 16) "],"
                    "'accessors':[" FLOATS(0, "SCALAR", 4) "," FLOATS(1, "VEC3", 4) "," FLOATS(
                        0, "SCALAR", 1) "," FLOATS(2, "VEC4", 1) "]}",
        data, sizeof data);
    if (!scene) fail_msg("%s", test_last_message());
    const struct animation *a = &scene->animations[0];
    CHECK(a->channel_count == 3 && a->duration_s == 2.0f);
    CHECK(a->channels[0].key_count == 3 && a->channels[0].interpolation == INTERPOLATE_LINEAR);
    CHECK(a->channels[0].values[6] == 3.0f); // the third key is at two seconds
    CHECK(a->channels[1].interpolation == INTERPOLATE_STEP && a->channels[1].values[3] == 1.0f);
    CHECK(a->channels[2].path == PATH_SCALE);
    scene_destroy(scene);
}

TEST(cubic_keys_keep_their_tangents)
{
    static const float data[] = { 0, 1, 0, 0, 0, 5, 0, 0, 1, 0, 0, -1, 0, 0, 7, 0, 0, 0, 0, 0 };
    struct scene *scene = load_gltf(
        "{" ASSET ",'nodes':[{}],'animations':[{'channels':["
        "{'sampler':0,'target':{'node':0,'path':'translation'}}],"
        "'samplers':[{'input':0,'output':1,'interpolation':'CUBICSPLINE'}]}]," BUFFER(
            80) ",'bufferViews':[" VIEW(0, 8) "," VIEW(8, 72) "],"
                                                              "'accessors':[" FLOATS(
                                                                  0, "SCALAR",
                                                                  2) "," FLOATS(1, "VEC3", 6) "]}",
        data, sizeof data);
    if (!scene) fail_msg("%s", test_last_message());
    const struct animation_channel *c = &scene->animations[0].channels[0];
    CHECK(c->interpolation == INTERPOLATE_CUBIC && c->key_count == 2 && c->width == 3);
    CHECK(memcmp(c->values, data + 2, 18 * sizeof(float)) == 0);
    scene_destroy(scene);
}

TEST(morph_weights_of_a_node_override_those_of_its_mesh)
{
    static const float data[] = {
        0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 4, 0, 0, 4, 0, 0, 4, 0, 1, 0, 1
    };
    struct scene *scene = load_gltf(
        "{" ASSET ",'nodes':[{'mesh':0},{'mesh':0,'weights':[0.25]}],"
        "'meshes':[{'weights':[0.5],'primitives':[{'attributes':{'POSITION':0},"
        "'targets':[{'POSITION':1}]}]}],'animations':[{'channels':[{'sampler':0,"
        "'target':{'node':0,'path':'weights'}}],'samplers':[{'input':2,'output':3}]}]"
        "," BUFFER(88) ",'bufferViews':[" VIEW(0, 36) "," VIEW(36, 36) "," VIEW(72, 8) "," VIEW(
            80, 8) "],'accessors':[" FLOATS(0, "VEC3",
                                            3) "," FLOATS(1, "VEC3",
                                                          3) "," FLOATS(2, "SCALAR",
                                                                        2) "," FLOATS(3, "SCALAR",
                                                                                      2) "]}",
        data, sizeof data);
    if (!scene) fail_msg("%s", test_last_message());
    CHECK(scene->instances[0].morph_weights[0] == 0.5f);
    CHECK(scene->instances[1].morph_weights[0] == 0.25f);
    CHECK(scene->animations[0].channels[0].width == 1);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, 0, 0.75f));
    CHECK_NEAR(pose.deformed[0].positions[0].z, 3.0, 1e-5);
    CHECK_NEAR(pose.deformed[1].positions[0].z, 1.0, 1e-5);
    pose_finish(&pose);
    scene_destroy(scene);
}

#define SKIN                                                                                       \
    "{" ASSET ",'nodes':[{'mesh':0,'skin':0},{'translation':[5,0,0]}],'skins':[{'joints':[1]}],"   \
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'WEIGHTS_0':1,'JOINTS_0':2}}]}]"         \
    "," BUFFER(96) ",'bufferViews':[" VIEW(0, 36) "," VIEW(36, 48) "," VIEW(                       \
        84, 12) "],'accessors':[" FLOATS(0, "VEC3",                                                \
                                         3) "," FLOATS(1, "VEC4",                                  \
                                                       3) ",{'bufferView':2,'componentType':5121," \
                                                          "'type':'VEC4','count':3}]}"

TEST(skins_deform_vertices_and_weights_sum_to_one)
{
    struct {
        float p[3][3], w[3][4];
        uint8_t j[3][4];
    } data = { .w = { { 2 }, { 0.25f, 0.25f }, { 0 } }, .j = { { 0, 9, 9, 9 } } };
    memcpy(data.p, triangle, sizeof triangle);
    struct scene *scene = load_gltf(SKIN, &data, sizeof data);
    if (!scene) fail_msg("%s", test_last_message());
    for (uint32_t v = 0; v < 3; v++) {
        vec4s w = scene->meshes[0].weights[v];
        CHECK_NEAR(w.x + w.y + w.z + w.w, 1.0, 1e-6);
        for (int k = 0; k < 4; k++) CHECK(scene->meshes[0].joints[v][k] == 0);
    }
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    CHECK_NEAR(pose.bounds.min.x, 5.0, 1e-5);
    pose_finish(&pose);
    scene_destroy(scene);
    data.j[1][1] = 1; // nonzero weight, but the skin has one joint
    CHECK(!load_gltf(SKIN, &data, sizeof data));
    CHECK(strstr(test_last_message(), "joint 1 of 1"));
}

TEST(loading_twice_gives_the_same_bytes)
{
    static const char json[] = "{" ASSET "," SCENE "," TRIANGLE_MESH "," TRIANGLE_DATA "}";
    struct scene *a = load_triangle(json), *b = load_triangle(json);
    CHECK(a->content_hash == b->content_hash && a->content_hash != 0);
    CHECK(a->meshes[0].vertex_count == b->meshes[0].vertex_count);
    CHECK(memcmp(a->meshes[0].normals, b->meshes[0].normals, 3 * sizeof(vec3s)) == 0);
    scene_destroy(a);
    scene_destroy(b);
}

struct refusal {
    const char *json, *message;
};

static const struct refusal refusals[] = {
    { "", "JSON" },
    { "[]", "not an object" },
    { "{}", "no asset version" },
    { "{'asset':{'version':'3.0'}}", "3.0" },
    { "{'asset':{'version':'2.1','minVersion':'2.1'}}", "2.1" },
    { "{" ASSET ",'extensionsRequired':['KHR_lights_punctual','EXT_new\\nline']}",
      "EXT_new\\u000aline" },
    { "{" ASSET ",'nodes':{}}", "nodes is not an array" },
    { "{" ASSET ",'nodes':[3]}", "node 0" },
    { "{" ASSET ",'nodes':[{'mesh':0}]}", "mesh 0 does not exist; there are 0" },
    { "{" ASSET ",'nodes':[{'children':[1]},{'children':[2]},{'children':[1]}]}", "parent" },
    { "{" ASSET ",'nodes':[{'children':[1]},{'children':[0]}]}", "cycle" },
    { "{" ASSET ",'nodes':[{'rotation':[0,0,0,0]}]}", "quaternion" },
    { "{" ASSET ",'nodes':[{'translation':[0,0,1e99]}]}", "translation[2]" },
    { "{" ASSET ",'nodes':[{'scale':[1,2]}]}", "array of 3" },
    { "{" ASSET ",'scene':4,'scenes':[{}]}", "scene 4 does not exist; there are 1" },
    { "{" ASSET ",'buffers':[{'byteLength':4}]}", "no data" },
    { "{" ASSET ",'buffers':[{'byteLength':4,'uri':'/etc/passwd'}]}", "relative" },
    { "{" ASSET ",'buffers':[{'byteLength':4,'uri':'../made.bin'}]}", "relative" },
    { "{" ASSET ",'buffers':[{'byteLength':4,'uri':'a/%2e%2e/made.bin'}]}", "relative" },
    { "{" ASSET ",'buffers':[{'byteLength':4,'uri':'file:made.bin'}]}", "relative" },
    { "{" ASSET ",'buffers':[{'byteLength':4,'uri':'a\\\\..\\\\made.bin'}]}", "relative" },
    { "{" ASSET ",'buffers':[{'byteLength':4,'uri':'%00'}]}", "relative" },
    { "{" ASSET ",'buffers':[{'byteLength':37,'uri':'made.bin'}]}",
      "byteLength is 37, but the data have 36 bytes" },
    { "{" ASSET ",'buffers':[{'byteLength':4,'uri':'data:;base64,AAA*'}]}", "base64" },
    { "{" ASSET ",'materials':[{'alphaMode':'GLASS'}]}", "alphaMode" },
    { "{" ASSET ",'materials':[{'pbrMetallicRoughness':{'metallicFactor':2}}]}", "metallicFactor" },
    { "{" ASSET "," SCENE "," TRIANGLE_MESH
      "," BUFFER(36) ",'bufferViews':[" VIEW(8, 32) "],"
                                                    "'accessors':[" FLOATS(0, "VEC3", 3) "]}",
      "are not in buffer" },
    { "{" ASSET "," SCENE "," TRIANGLE_MESH
      "," BUFFER(36) ",'bufferViews':[" VIEW(0, 36) "],"
                                                    "'accessors':[" FLOATS(0, "VEC3", 6) "]}",
      "do not fit" },
    { "{" ASSET "," SCENE "," TRIANGLE_MESH
      "," BUFFER(36) ",'bufferViews':[{'buffer':0,"
                     "'byteLength':36,'byteStride':8}],'accessors':[" FLOATS(0, "VEC3", 3) "]}",
      "byteStride" },
    { "{" ASSET "," SCENE "," TRIANGLE_MESH
      "," BUFFER(36) ",'bufferViews':[" VIEW(0, 36) "],"
                                                    "'accessors':[" FLOATS(0, "VEC2", 3) "]}",
      "2 components, 3 are" },
    { "{" ASSET "," SCENE "," TRIANGLE_MESH "," BUFFER(36) ",'bufferViews':[" VIEW(
          0, 36) "],"
                 "'accessors':[{'bufferView':0,'componentType':5124,'type':'VEC3','count':3}]}",
      "componentType" },
    { "{" ASSET "," SCENE "," TRIANGLE_MESH "," BUFFER(36) ",'bufferViews':[" VIEW(
          0,
          36) "],"
              "'accessors':[{'bufferView':0,'byteOffset':18446744073709551600,'componentType':5126,"
              "'type':'VEC3','count':3}]}",
      "JSON" }, // exceeds 64 bits
    { "{" ASSET "," SCENE "," TRIANGLE_MESH "," BUFFER(36) ",'bufferViews':[" VIEW(
          0,
          36) "],"
              "'accessors':[{'bufferView':0,'componentType':5126,'type':'VEC3','count':3,'sparse':"
              "{'count':1,'indices':{'bufferView':0,'byteOffset':12,'componentType':5125},"
              "'values':{'bufferView':0}}}]}",
      "sparse index" },
    // A small file that describes gigabytes: zeros with one sparse value.
    { "{" ASSET "," SCENE "," TRIANGLE_MESH "," BUFFER(36) ",'bufferViews':[" VIEW(
          0, 36) "],"
                 "'accessors':[{'componentType':5126,'type':'VEC3','count':4000000000,'sparse':"
                 "{'count':1,'indices':{'bufferView':0,'componentType':5125},"
                 "'values':{'bufferView':0}}}]}",
      "justify" },
    { "{" ASSET "," SCENE
      ",'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1}}]}]," BUFFER(
          36) ",'bufferViews':[" VIEW(0, 36) "],'accessors':[" FLOATS(0, "VEC3",
                                                                      3) "," FLOATS(0, "VEC3",
                                                                                    2) "]}",
      "NORMAL has 2 elements" },
    { "{" ASSET "," SCENE ",'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1}]}]"
      "," BUFFER(36) ",'bufferViews':[" VIEW(0, 36) "],'accessors':[" FLOATS(
          0, "VEC3", 3) ","
                        "{'bufferView':0,'byteOffset':12,'componentType':5125,'"
                        "type':'SCALAR','count':3}]}",
      "index 1065353216 exceeds its 3 vertices" },
    { "{" ASSET ",'nodes':[{}],'animations':[{'channels':[{'sampler':0,'target':{'node':0,"
      "'path':'scale'}}],'samplers':[{'input':0,'output':1}]}]," BUFFER(36) ",'bufferViews':[" VIEW(
          0, 36) "],'accessors':[" FLOATS(0, "SCALAR", 2) "," FLOATS(0, "VEC3", 3) "]}",
      "3 values, 2 are" },
    { "{" ASSET ",'nodes':[{}],'animations':[{'channels':[{'sampler':0,'target':{'node':0,"
      "'path':'scale'}}],'samplers':[{'input':0,'output':1}]}]," BUFFER(36) ",'bufferViews':[" VIEW(
          12, 24) "," VIEW(0, 36) "],'accessors':[" FLOATS(0, "SCALAR", 3) "," FLOATS(1, "VEC3",
                                                                                      3) "]}",
      "do not ascend" },
};

TEST(invalid_files_are_refused_with_the_location_of_the_error)
{
    for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++) {
        struct scene *scene = load_gltf(refusals[i].json, triangle, sizeof triangle);
        if (scene || !strstr(test_last_message(), refusals[i].message)) {
            fail_msg("%s: \"%s\"", refusals[i].json, test_last_message());
        }
    }
}

TEST(vertices_that_are_not_finite_are_refused)
{
    float bad[9];
    static const float values[] = { NAN, INFINITY, -INFINITY };
    for (int i = 0; i < 3; i++) {
        memcpy(bad, triangle, sizeof bad);
        bad[4] = values[i];
        CHECK(!load_gltf("{" ASSET "," SCENE "," TRIANGLE_MESH "," TRIANGLE_DATA "}", bad,
                         sizeof bad));
        CHECK(strstr(test_last_message(), "position of vertex 1 is not finite"));
    }
}

// Ten gigabytes from half a megabyte.
TEST(many_primitives_of_one_large_accessor_are_bounded)
{
    enum { VERTICES = 30000, PRIMITIVES = 4000 };
    size_t size = VERTICES * 12;
    float *positions = calloc(VERTICES, 12);
    char *json = malloc(PRIMITIVES * 64 + 1024);
    CHECK(positions && json);
    size_t length = (size_t)sprintf(
        json,
        "{" ASSET "," SCENE "," BUFFER(360000) ",'bufferViews':[" VIEW(
            0, 360000) "],'accessors':[" FLOATS(0, "VEC3", 30000) "],'meshes':[{'primitives':[");
    for (int i = 0; i < PRIMITIVES; i++) {
        length += (size_t)sprintf(json + length, "%s{'attributes':{'POSITION':0}}", i ? "," : "");
    }
    sprintf(json + length, "]}]}");
    CHECK(!load_gltf(json, positions, size));
    CHECK(strstr(test_last_message(), "justify"));
    CHECK(test_host()->failure == FAIL_MEMORY);
    free(json);
    free(positions);
}
