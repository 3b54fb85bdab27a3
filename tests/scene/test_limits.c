// Small files that describe large scenes: refused, or read in time and memory that their size
// justifies.
#include "scene/gltf_maker.h"

#include "scene/view/defaults.h"
#include "scene/limits.h"
#include "scene/pose.h"

#include <math.h>

static const float TRIANGLE[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };

// A mesh of one triangle; `more` follows in the same JSON object.
static struct scene *load_triangle(const char *more)
{
    static char json[1 << 20];
    snprintf(json, sizeof json,
             "{" ASSET ",'buffers':[{'byteLength':36,'uri':'made.bin'}],"
             "'bufferViews':[{'buffer':0,'byteLength':36}],"
             "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}],"
             "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],%s}",
             more);
    return load_gltf(json, TRIANGLE, sizeof TRIANGLE);
}

// The text `count` times, separated by commas, between `before` and `after`.
static const char *repeated(const char *before, const char *text, int count, const char *after)
{
    static char out[1 << 20];
    char *end = stpcpy(out, before);
    for (int i = 0; i < count; i++) {
        CHECK((size_t)(end - out) + strlen(text) + strlen(after) + 2 < sizeof out);
        if (i > 0) *end++ = ',';
        end = stpcpy(end, text);
    }
    strcpy(end, after);
    return out;
}

TEST(instances_times_triangles_are_charged_before_anything_is_built)
{
    enum { TRIANGLES = 10000 };
    static uint8_t data[36 + 3 * TRIANGLES];
    memcpy(data, TRIANGLE, sizeof TRIANGLE);
    for (int i = 0; i < 3 * TRIANGLES; i++) data[36 + i] = (uint8_t)(i % 3);
    static char json[1 << 20];
    snprintf(json, sizeof json,
             "{" ASSET ",'buffers':[{'byteLength':%d,'uri':'made.bin'}],"
             "'bufferViews':[{'buffer':0,'byteLength':36},"
             "{'buffer':0,'byteOffset':36,'byteLength':%d}],"
             "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
             "{'bufferView':1,'componentType':5121,'count':%d,'type':'SCALAR'}],"
             "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1}]}],%s}",
             (int)sizeof data, 3 * TRIANGLES, 3 * TRIANGLES,
             repeated("'nodes':[", "{'mesh':0}", 20000, "]"));
    CHECK(!load_gltf(json, data, sizeof data));
    CHECK(test_host()->failure == FAIL_MEMORY && strstr(test_last_message(), "instances"));
}

// 2000 names of one file: read and decoded once.
TEST(an_image_file_is_decoded_once_however_often_it_is_named)
{
    static const char base64[] = PNG_2X2;
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    uint8_t png[128];
    size_t size = 0;
    uint32_t bits = 0, count = 0;
    for (const char *c = strchr(base64, ',') + 1; *c != '='; c++) {
        bits = bits << 6 | (uint32_t)(strchr(digits, *c) - digits);
        if (++count % 4 != 1) png[size++] = (uint8_t)(bits >> (6 - 2 * ((count - 1) % 4)));
    }
    write_bytes("one.png", png, size);
    static char json[1 << 20];
    char *end = json + sprintf(json, "{" ASSET ",'images':[");
    for (int i = 0; i < 2000; i++)
        end += sprintf(end, "%s{'uri':'%sone.png'}", i ? "," : "", i % 2 ? "./" : "");
    end += sprintf(end, "],'textures':[");
    for (int i = 0; i < 2000; i++) end += sprintf(end, "%s{'source':%d}", i ? "," : "", i);
    end += sprintf(end, "],'materials':[");
    for (int i = 0; i < 2000; i++)
        end += sprintf(end, "%s{'emissiveTexture':{'index':%d}}", i ? "," : "", i);
    sprintf(end, "]}");
    struct scene *scene = load_gltf(json, NULL, 0);
    if (!scene) fail_msg("%s", test_last_message());
    CHECK(scene->image_count == 1 && scene->images[0].width == 2);
    for (int i = 0; i < 2000; i++) CHECK(scene->materials[i].emissive_map.image == 0);
    scene_destroy(scene);
}

TEST(equal_instances_cost_no_more_than_one)
{
    struct scene *scene = load_triangle(repeated("'nodes':[", "{'mesh':0}", 50000, "]"));
    CHECK(scene && scene->instance_count == 50000);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0));
    struct world_camera camera = default_camera(&pose); // 40,000 rays
    CHECK(isfinite(camera.eye.x) && isfinite(camera.forward.x));
    pose_finish(&pose);
    scene_destroy(scene);
}

TEST(geometry_beyond_the_largest_coordinate_is_refused)
{
    static const char *const refused[] = {
        "'nodes':[{'mesh':0,'scale':[1e15,1e15,1e15]}]",
        "'nodes':[{'mesh':0,'translation':[0,2e8,0]}]",
        "'nodes':[{'mesh':0,'scale':[1e30,1e30,1e30],'children':[1]},"
        "{'mesh':0,'scale':[1e30,1e30,1e30]}]",
        "'nodes':[{'mesh':0,'matrix':[3e38,3e38,0,0,-3e38,3e38,0,0,0,0,1,0,-3e38,0,0,1]}]",
    };
    for (int i = 0; i < 4; i++) {
        CHECK(!load_triangle(refused[i]));
        CHECK(test_host()->failure == FAIL_UNSUPPORTED);
        CHECK(strstr(test_last_message(), "1e+08 m"));
    }
    struct scene *scene = load_triangle("'nodes':[{'mesh':0,'scale':[9e7,9e7,9e7]}]");
    CHECK(scene);
    scene_destroy(scene);
}

TEST(lights_and_cameras_beyond_the_limits_are_refused)
{
    static const char *const refused[] = {
        "'nodes':[{'camera':0,'translation':[1e10,0,0]}],"
        "'cameras':[{'type':'perspective','perspective':{'yfov':1,'znear':0.1}}]",
        "'nodes':[{'extensions':{'KHR_lights_punctual':{'light':0}}}],"
        "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point','intensity':1e17}]}}",
        "'nodes':[{'translation':[1e10,0,0],'extensions':{'KHR_lights_punctual':{'light':0}}}],"
        "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point'}]}}",
        "'materials':[{'emissiveFactor':[1,1,1],"
        "'extensions':{'KHR_materials_emissive_strength':{'emissiveStrength':1e16}}}]",
    };
    for (int i = 0; i < 4; i++) {
        CHECK(!load_triangle(refused[i]));
        CHECK(strstr(test_last_message(), i % 2 == 0 ? "1e+09 m" : "1e+15"));
    }
    // The position of a sun has no effect.
    struct scene *scene = load_triangle(
        "'nodes':[{'translation':[1e10,0,0],'extensions':{'KHR_lights_punctual':{'light':0}}}],"
        "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'directional'}]}}");
    CHECK(scene && scene->light_count == 1);
    scene_destroy(scene);
}
