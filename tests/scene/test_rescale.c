// A scene of another unit is the same scene with all lengths multiplied. The factors are powers of
// two, so that products are exact.
#include "scene/gltf_maker.h"
#include "scene/limits.h"
#include "scene/rescale.h"

#include <float.h>

static const float POSITIONS[3][3] = { { 1, 2, 3 }, { 4, 2, 3 }, { 1, 6, 3 } };

struct made {
    float positions[3][3], morph[3][3], times[2], moved[2][3], inverse_bind[4][4], weights[3][4];
    uint16_t joints[3][4];
};

// Nodes with parts, with a matrix, with a skin; a root that moves and a child that stays at it.
static const char GLTF[] =
    "{" ASSET ",'buffers':[{'uri':'made.bin','byteLength':240}],"
    "'bufferViews':[{'buffer':0,'byteLength':240}],'accessors':["
    "{'bufferView':0,'byteOffset':0,'componentType':5126,'count':3,'type':'VEC3',"
    "'min':[1,2,3],'max':[4,6,3]},"
    "{'bufferView':0,'byteOffset':36,'componentType':5126,'count':3,'type':'VEC3'},"
    "{'bufferView':0,'byteOffset':72,'componentType':5126,'count':2,'type':'SCALAR',"
    "'min':[0],'max':[1]},"
    "{'bufferView':0,'byteOffset':80,'componentType':5126,'count':2,'type':'VEC3'},"
    "{'bufferView':0,'byteOffset':104,'componentType':5126,'count':1,'type':'MAT4'},"
    "{'bufferView':0,'byteOffset':168,'componentType':5126,'count':3,'type':'VEC4'},"
    "{'bufferView':0,'byteOffset':216,'componentType':5123,'count':3,'type':'VEC4'}],"
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'targets':[{'POSITION':1}]},"
    "{'attributes':{'POSITION':0},'targets':[{'POSITION':1}]}],'weights':[0.5]},"
    "{'primitives':[{'attributes':{'POSITION':0,'WEIGHTS_0':5,'JOINTS_0':6}}]}],"
    "'skins':[{'joints':[2],'inverseBindMatrices':4}],"
    "'cameras':[{'type':'perspective','perspective':{'yfov':1,'znear':0.5}}],"
    "'extensionsUsed':['KHR_lights_punctual'],'extensions':{'KHR_lights_punctual':{'lights':["
    "{'type':'point','intensity':7,'range':3},{'type':'point'}]}},"
    "'nodes':[{'mesh':0,'translation':[1,2,3],'rotation':[0,1,0,0],'scale':[2,2,2],'children':[1]},"
    "{'matrix':[1,0,0,0,0,1,0,0,0,0,1,0,5,6,7,1],'camera':0},"
    "{'translation':[0,3,0]},{'mesh':1,'skin':0},"
    "{'translation':[8,0,0],'extensions':{'KHR_lights_punctual':{'light':0}}},"
    "{'matrix':[0,0,2,0,0,1,0,0,-1,0,0,0,3,2,1,1],"
    "'extensions':{'KHR_lights_punctual':{'light':1}}}],"
    "'animations':[{'samplers':[{'input':2,'output':3}],"
    "'channels':[{'sampler':0,'target':{'node':0,'path':'translation'}},"
    "{'sampler':0,'target':{'node':0,'path':'scale'}},"
    "{'sampler':0,'target':{'node':2,'path':'translation'}}]}],"
    "'scenes':[{'nodes':[0,2,3,4,5]}],'scene':0}";

static struct scene *load_made(float scale)
{
    struct made made = { .morph = { { 0, 0, 1 }, { 0, 2, 0 }, { 1, 0, 0 } },
                         .times = { 0, 1 },
                         .moved = { { 1, 2, 3 }, { 3, 2, 1 } },
                         .inverse_bind = { { 1 }, { 0, 1 }, { 0, 0, 1 }, { 0, -3, 2, 1 } },
                         .weights = { { 1 }, { 1 }, { 1 } } };
    memcpy(made.positions, POSITIONS, sizeof made.positions);
    scene_destroy(load_gltf(GLTF, &made, sizeof made));
    return scene_load_scaled(test_host(), test_path("made.gltf"), scale);
}

static void check_scaled(vec3s scaled, vec3s original, float factor)
{
    for (int k = 0; k < 3; k++) CHECK_NEAR(scaled.raw[k], original.raw[k] * factor, 0);
}

// World positions of all vertices, at a moment.
static void check_vertices(const struct scene_pose *scaled, const struct scene_pose *original,
                           float factor)
{
    for (int i = 0; i < original->scene->instance_count; i++) {
        const struct mesh *a = scene_mesh_of(scaled->scene, i),
                          *b = scene_mesh_of(original->scene, i);
        const vec3s *of_a = scaled->deformed[i].positions, *of_b = original->deformed[i].positions;
        const mat4s m = pose_world_from_instance(scaled, i),
                    n = pose_world_from_instance(original, i);
        for (uint32_t v = 0; v < b->vertex_count; v++)
            check_scaled(mat4_point(m, of_a ? of_a[v] : a->positions[v]),
                         mat4_point(n, of_b ? of_b[v] : b->positions[v]), factor);
    }
}

static void check_moment(const struct scene *scaled, const struct scene *original, float factor,
                         float time_s)
{
    struct scene_pose a, b;
    CHECK(pose_init(&a, scaled, 0, time_s) && pose_init(&b, original, 0, time_s));
    check_scaled(a.bounds.min, b.bounds.min, factor);
    check_scaled(a.bounds.max, b.bounds.max, factor);
    check_vertices(&a, &b, factor);
    for (int i = 0; i < 2; i++) {
        const struct world_light x = pose_light(&a, i), y = pose_light(&b, i);
        check_scaled(x.position, y.position, factor);
        check_scaled(x.intensity, y.intensity, 1);
        CHECK_NEAR(x.range_m, y.range_m * factor, 0);
    }
    const struct world_camera x = pose_camera(&a, 0), y = pose_camera(&b, 0);
    check_scaled(x.eye, y.eye, factor);
    check_scaled(x.forward, y.forward, 1);
    CHECK_NEAR(x.near_m, y.near_m * factor, 0);
    pose_finish(&a);
    pose_finish(&b);
}

TEST(all_lengths_are_scaled_at_every_moment)
{
    static const float factors[] = { 0.25f, 1, 1024 };
    struct scene *original = load_made(1);
    CHECK(original && original->instance_count == 3 && original->scale == 1.0f);
    for (int i = 0; i < 3; i++) {
        struct scene *scaled = load_made(factors[i]);
        CHECK(scaled && scaled->scale == factors[i]);
        CHECK((scaled->content_hash == original->content_hash) == (factors[i] == 1.0f));
        check_moment(scaled, original, factors[i], 0);
        check_moment(scaled, original, factors[i], 0.5f);
        scene_destroy(scaled);
    }
    scene_destroy(original);
}

TEST(built_in_scenes_are_scaled_too)
{
    struct scene *original = scene_load(test_host(), "@cornell:light=point"),
                 *scaled = scene_load_scaled(test_host(), "@cornell:light=point", 0.5f);
    struct scene_pose a, b;
    CHECK(original && scaled);
    CHECK(pose_init(&a, scaled, -1, 0) && pose_init(&b, original, -1, 0));
    check_vertices(&a, &b, 0.5f);
    check_scaled(pose_light(&a, 0).position, pose_light(&b, 0).position, 0.5f);
    check_scaled(pose_camera(&a, 0).eye, pose_camera(&b, 0).eye, 0.5f);
    pose_finish(&a);
    pose_finish(&b);
    scene_destroy(scaled);
    scene_destroy(original);
}

TEST(limits_are_those_of_the_scaled_scene)
{
    static const char far[] = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                              "property float y\nproperty float z\nelement face 1\n"
                              "property list uchar int vertex_indices\nend_header\n"
                              "0 0 0\n1e9 0 0\n0 1e9 0\n3 0 1 2\n";
    write_bytes("far.ply", far, sizeof far - 1);
    CHECK(!scene_load(test_host(), test_path("far.ply")));
    struct scene *scene = scene_load_scaled(test_host(), test_path("far.ply"), 1e-3f);
    CHECK(scene);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0));
    CHECK_RELATIVE(pose.bounds.max.x, 1e6, 1e-6);
    pose_finish(&pose);
    scene_destroy(scene);
    test_forget_messages();
    CHECK(!scene_load_scaled(test_host(), "@cornell", SCENE_SCALE_MAX * 1e3f));
    CHECK(strstr(test_last_message(), "largest coordinate"));
}

TEST(a_range_above_0_stays_above_0)
{
    struct scene *scene = load_made(1);
    CHECK(scene);
    scene->lights[0].range_m = FLT_MIN;
    scene_rescale(scene, SCENE_SCALE_MIN);
    CHECK(scene->lights[0].range_m > 0.0f && scene->lights[1].range_m == 0.0f);
    scene_destroy(scene);
}
