// Damaged files: truncated or overwritten files are refused or give a valid scene.
#include "scene/gltf_maker.h"

#include "scene/pose.h"

#include <math.h>

struct everything { // the buffer of the file below
    float positions[3][3], morph[3][3], uv[3][2], weights[3][4];
    float bind[16], times[2], rotations[2][4];
    uint16_t joints[3][4], indices[3], pad;
    uint8_t png[76];
};

#define VIEW(field)                                                                                \
    (int)offsetof(struct everything, field), (int)sizeof(((struct everything *)NULL)->field)

static struct everything contents(void)
{
    struct everything e = {
        .positions = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } },
        .morph = { { 0, 0, 1 } },
        .uv = { { 0, 1 }, { 1, 1 }, { 0, 0 } },
        .weights = { { 1 }, { 1 }, { 0.5f, 0.5f } },
        .times = { 0, 1 },
        .rotations = { { 0, 0, 0, 1 }, { 0, 0, 1, 0 } },
        .joints = { { 0 }, { 0 }, { 0, 1 } },
        .indices = { 0, 1, 2 },
    };
    for (int i = 0; i < 16; i += 5) e.bind[i] = 1;
    static const uint8_t png[] = { // 2 x 2 texels, the last one transparent
                                   0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00,
                                   0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00,
                                   0x00, 0x02, 0x08, 0x06, 0x00, 0x00, 0x00, 0x72, 0xb6, 0x0d, 0x24,
                                   0x00, 0x00, 0x00, 0x13, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63,
                                   0xf8, 0xcf, 0xc0, 0xf0, 0x1f, 0x0c, 0x81, 0x34, 0x08, 0x30, 0x00,
                                   0x00, 0x48, 0xc9, 0x08, 0xf8, 0xc5, 0x34, 0xfd, 0x05, 0x00, 0x00,
                                   0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82
    };
    memcpy(e.png, png, sizeof png);
    return e;
}

// A file with one object of each supported kind.
static uint8_t *make_everything(size_t *size)
{
    static const char format[] =
        "{" ASSET ",'extensionsUsed':['KHR_lights_punctual','KHR_texture_transform'],"
        "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'spot','intensity':5,'range':9,"
        "'spot':{'innerConeAngle':0.1,'outerConeAngle':0.5}}]}},"
        "'scene':0,'scenes':[{'nodes':[0]}],"
        "'nodes':[{'children':[1,2,3]},{'mesh':0,'skin':0,'weights':[0.5]},"
        "{'extensions':{'KHR_lights_punctual':{'light':0}},'rotation':[0,0,0,1]},"
        "{'camera':0,'matrix':[1,0,0,0,0,1,0,0,0,0,1,0,0,0,5,1]}],"
        "'cameras':[{'type':'perspective','perspective':{'yfov':1,'znear':0.1}}],"
        "'materials':[{'normalTexture':{'index':0,'extensions':{'KHR_texture_transform':"
        "{'rotation':1,'scale':[2,2]}}},'alphaMode':'MASK'}],"
        "'textures':[{'source':0,'sampler':0}],'samplers':[{'wrapS':33071,'magFilter':9728}],"
        "'images':[{'bufferView':8,'mimeType':'image/png'}],"
        "'meshes':[{'primitives':[{'material':0,'indices':8,'targets':[{'POSITION':1}],"
        "'attributes':{'POSITION':0,'TEXCOORD_0':2,'WEIGHTS_0':3,'JOINTS_0':7}}]}],"
        "'skins':[{'joints':[0,2],'inverseBindMatrices':9}],"
        "'animations':[{'channels':[{'sampler':0,'target':{'node':2,'path':'rotation'}}],"
        "'samplers':[{'input':5,'output':6}]}],"
        "'buffers':[{'byteLength':%d}],'bufferViews':["
        "{'buffer':0,'byteOffset':%d,'byteLength':%d},{'buffer':0,'byteOffset':%d,'byteLength':%d},"
        "{'buffer':0,'byteOffset':%d,'byteLength':%d},{'buffer':0,'byteOffset':%d,'byteLength':%d},"
        "{'buffer':0,'byteOffset':%d,'byteLength':%d},{'buffer':0,'byteOffset':%d,'byteLength':%d},"
        "{'buffer':0,'byteOffset':%d,'byteLength':%d},{'buffer':0,'byteOffset':%d,'byteLength':%d},"
        "{'buffer':0,'byteOffset':%d,'byteLength':%d},{'buffer':0,'byteOffset':%d,'byteLength':%d}]"
        ","
        "'accessors':["
        "{'bufferView':0,'componentType':5126,'type':'VEC3','count':3},"
        "{'bufferView':1,'componentType':5126,'type':'VEC3','count':3,'sparse':{'count':1,"
        "'indices':{'bufferView':7,'byteOffset':2,'componentType':5123},"
        "'values':{'bufferView':0,'byteOffset':12}}},"
        "{'bufferView':2,'componentType':5126,'type':'VEC2','count':3},"
        "{'bufferView':3,'componentType':5126,'type':'VEC4','count':3},"
        "{'bufferView':4,'componentType':5126,'type':'MAT4','count':1},"
        "{'bufferView':5,'componentType':5126,'type':'SCALAR','count':2},"
        "{'bufferView':6,'componentType':5126,'type':'VEC4','count':2},"
        "{'bufferView':9,'componentType':5123,'type':'VEC4','count':3},"
        "{'bufferView':7,'componentType':5123,'type':'SCALAR','count':3},"
        "{'componentType':5126,'type':'MAT4','count':2,'sparse':{'count':1,"
        "'indices':{'bufferView':7,'componentType':5123},'values':{'bufferView':4}}}]}";
    static char json[8192];
    int length = snprintf(json, sizeof json, format, (int)sizeof(struct everything),
                          VIEW(positions), VIEW(morph), VIEW(uv), VIEW(weights), VIEW(bind),
                          VIEW(times), VIEW(rotations), VIEW(indices), VIEW(png), VIEW(joints));
    CHECK(length > 0 && (size_t)length < sizeof json);
    struct everything e = contents();
    return make_glb(json, &e, sizeof e, size);
}

// Loads the bytes; poses the scene if there is one, so that every array is read.
static bool try_bytes(const char *name, const uint8_t *bytes, size_t size)
{
    write_bytes(name, bytes, size);
    test_forget_messages();
    struct scene *scene = scene_load(test_host(), test_path(name));
    if (!scene) {
        CHECK(test_last_message()[0] != 0);
        return false;
    }
    struct scene_pose pose;
    for (int a = -1; a < scene->animation_count; a++) {
        CHECK(pose_init(&pose, scene, a, 0.5f));
        pose_finish(&pose);
    }
    for (int m = 0; m < scene->mesh_count; m++) {
        const struct mesh *mesh = &scene->meshes[m];
        for (uint32_t i = 0; i < mesh->index_count; i++) {
            CHECK(mesh->indices[i] < mesh->vertex_count);
            CHECK(isfinite(mesh->positions[mesh->indices[i]].x));
        }
    }
    scene_destroy(scene);
    return true;
}

TEST(the_undamaged_file_has_every_feature)
{
    size_t size;
    uint8_t *glb = make_everything(&size);
    write_bytes("whole.glb", glb, size);
    struct scene *scene = scene_load(test_host(), test_path("whole.glb"));
    CHECK(scene);
    CHECK(scene_triangle_count(scene) == 1 && scene->image_count == 1 && scene->light_count == 1);
    CHECK(scene->camera_count == 1 && scene->skin_count == 1 && scene->animation_count == 1);
    CHECK(scene->meshes[0].morph_count == 1 && scene->meshes[0].tangents);
    CHECK(scene->images[0].rgba[3 * 4 + 3] == 0 && scene->images[0].has_alpha);
    scene_destroy(scene);
    free(glb);
}

TEST(a_glb_truncated_at_any_length_is_refused)
{
    size_t size;
    uint8_t *glb = make_everything(&size);
    for (size_t cut = 0; cut < size; cut++) CHECK(!try_bytes("cut.glb", glb, cut));
    free(glb);
}

// The lengths in the headers are corrected, so that the JSON and the buffer are truncated.
TEST(a_glb_with_shortened_chunks_is_read_or_refused)
{
    size_t size;
    uint8_t *glb = make_everything(&size);
    uint32_t json_size, total, chunk;
    memcpy(&json_size, glb + 12, 4);
    for (size_t cut = 20; cut < size; cut += cut < 20 + json_size ? 7 : 1) {
        uint8_t *copy = malloc(cut);
        CHECK(copy);
        memcpy(copy, glb, cut);
        total = (uint32_t)cut;
        memcpy(copy + 8, &total, 4);
        if (cut < 20 + json_size) {
            chunk = (uint32_t)cut - 20;
            memcpy(copy + 12, &chunk, 4);
        } else if (cut >= 28 + json_size) {
            chunk = (uint32_t)cut - 28 - json_size;
            memcpy(copy + 20 + json_size, &chunk, 4);
        }
        try_bytes("short.glb", copy, cut);
        free(copy);
    }
    free(glb);
}

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u; // Numerical Recipes' generator
    return *state >> 8;
}

// Digits and letters replaced in the JSON, arbitrary bytes in the buffer; a fixed seed.
TEST(a_glb_with_changed_bytes_is_read_or_refused)
{
    size_t size;
    uint8_t *glb = make_everything(&size);
    uint32_t json_size, seed = 1;
    memcpy(&json_size, glb + 12, 4);
    uint8_t *copy = malloc(size);
    CHECK(copy);
    int loaded = 0, rounds = 4000;
    static const char digits[] = "0123456789-.[]{}e";
    for (int i = 0; i < rounds; i++) {
        memcpy(copy, glb, size);
        for (uint32_t k = 0; k <= next_random(&seed) % 3; k++) {
            bool in_json = next_random(&seed) % 3 != 0;
            size_t at = in_json ? 20 + next_random(&seed) % json_size : next_random(&seed) % size;
            // Prefers digits: a broken brace only tests the JSON parser.
            while (in_json && next_random(&seed) % 8 != 0 && (copy[at] < '0' || copy[at] > '9')) {
                at = 20 + next_random(&seed) % json_size;
            }
            copy[at] = in_json ? (uint8_t)digits[next_random(&seed) % (sizeof digits - 1)]
                               : (uint8_t)next_random(&seed);
        }
        loaded += try_bytes("changed.glb", copy, size);
    }
    CHECK(loaded > rounds / 50 && loaded < rounds); // some damage is harmless, some is refused
    free(copy);
    free(glb);
}
