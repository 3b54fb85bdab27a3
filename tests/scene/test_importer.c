// Output of the importer program is untrusted, and the program may be missing. Shell scripts stand
// in for it.
#include "scene/gltf_maker.h"

#include "scene/import/import_stream.h"

#include <sys/stat.h>

static const char EMPTY_GLTF[] = "{" ASSET "}";

// A script that writes the greeting and the bytes of a file.
static struct scene *load_from(const void *stream, size_t size)
{
    static char path[512];
    char script[1024];
    write_bytes("stream", stream, size);
    snprintf(path, sizeof path, "%s", test_path("importer"));
    snprintf(script, sizeof script, "#!/bin/sh\ncat '%s'\n", test_path("stream"));
    write_bytes("importer", script, strlen(script));
    CHECK(chmod(path, 0700) == 0);
    write_bytes("made.obj", "v 0 0 0\n", 8);
    static struct host host;
    host = *test_host();
    host.importer = path;
    test_forget_messages();
    struct scene *scene = scene_load(&host, test_path("made.obj"));
    test_host()->failure = host.failure;
    if (scene) scene->host = test_host();
    if (scene) scene->arena.host = test_host();
    return scene;
}

static size_t make_stream(char *out, size_t room, const char *lines, const void *glb, size_t size)
{
    size_t length =
        (size_t)snprintf(out, room, "%s%sglb %zu\n", IMPORT_STREAM_GREETING, lines, size);
    CHECK(length + size <= room);
    memcpy(out + length, glb, size);
    return length + size;
}

TEST(without_the_importer_its_formats_are_refused_in_one_sentence)
{
    struct host host = *test_host();
    host.importer = NULL;
    write_bytes("made.obj", "v 0 0 0\n", 8);
    CHECK(!scene_load(&host, test_path("made.obj")));
    CHECK(host.failure == FAIL_UNSUPPORTED && strstr(test_last_message(), "afterglow-import"));
    host.importer = "/nowhere/afterglow-import";
    CHECK(!scene_load(&host, test_path("made.obj")));
    CHECK(host.failure == FAIL_UNSUPPORTED && strstr(test_last_message(), "cannot start"));
}

TEST(notes_of_the_importer_are_passed_on)
{
    char stream[2048];
    size_t size;
    uint8_t *glb = make_glb(EMPTY_GLTF, "", 0, &size);
    size = make_stream(stream, sizeof stream, "note bump\x1b[31m maps\n", glb, size);
    struct scene *scene = load_from(stream, size);
    if (!scene) fail_msg("%s", test_last_message());
    CHECK(strstr(test_last_message(), "bump") && !strchr(test_last_message(), '\x1b'));
    scene_destroy(scene);
    free(glb);
}

TEST(reasons_of_the_importer_are_passed_on)
{
    static const char reason[] = IMPORT_STREAM_GREETING "fail memory it is too large\n";
    CHECK(!load_from(reason, sizeof reason - 1));
    CHECK(test_host()->failure == FAIL_MEMORY && strstr(test_last_message(), "it is too large"));
}

TEST(another_version_of_the_importer_is_refused)
{
    CHECK(!load_from("afterglow-import 99\nglb 0\n", 26));
    CHECK(test_host()->failure == FAIL_UNSUPPORTED && strstr(test_last_message(), "this version"));
    CHECK(!load_from("", 0));
}

TEST(a_stream_truncated_at_any_length_is_refused)
{
    static const float triangle[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };
    char stream[2048];
    size_t size;
    uint8_t *glb =
        make_glb("{" ASSET ",'buffers':[{'byteLength':36}],"
                 "'bufferViews':[{'buffer':0,'byteLength':36}],"
                 "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}],"
                 "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],'nodes':[{'mesh':0}]}",
                 triangle, sizeof triangle, &size);
    size = make_stream(stream, sizeof stream, "log no filter\n", glb, size);
    free(glb);
    struct scene *scene = load_from(stream, size);
    CHECK(scene && scene_triangle_count(scene) == 1);
    scene_destroy(scene);
    for (size_t cut = 0; cut < size; cut += 7) {
        CHECK(!load_from(stream, cut));
        CHECK(test_host()->failure != FAIL_NONE);
    }
}

TEST(damaged_gltf_of_the_importer_is_refused)
{
    static const char *const wrong[] = {
        IMPORT_STREAM_GREETING "glb 18446744073709551615\nx",
        IMPORT_STREAM_GREETING "glb -1\n",
        IMPORT_STREAM_GREETING "glb 4\nglTF",
        IMPORT_STREAM_GREETING "glb 3\nabcd",
        IMPORT_STREAM_GREETING "glb\n",
        IMPORT_STREAM_GREETING "fail\n",
        IMPORT_STREAM_GREETING "fail nothing why\n",
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        CHECK(!load_from(wrong[i], strlen(wrong[i])));
        CHECK(test_host()->failure != FAIL_NONE);
    }
    static char endless[100000] = IMPORT_STREAM_GREETING "note ";
    memset(endless + strlen(endless), 'x', 90000);
    CHECK(!load_from(endless, strlen(endless)));
}

// Both files end Assimp: the first by a fault, the second by recursion without end.
TEST(files_that_end_the_importer_are_refused)
{
    static const char list[] =
        "xof 0303txt 0032\nMesh{4;0;0;0,.0;0;0,.0;1;0;1;0;0;2;1,2,0,c{}MeshMaterialList{2;2;0,0;}}";
    write_bytes("list.x", list, sizeof list - 1);
    CHECK(!scene_load(test_host(), test_path("list.x")));
    CHECK(strstr(test_last_message(), "importer failed"));
    static const char cycle[] = "; FBX 7.3.0 project file\nFBXHeaderExtension:  {\n"
                                " FBXVersion: 7300\n}\nGlobalSettings:  {\n Version: 1000\n}\n"
                                "Objects:  {\n Model: 200, \"Model::m\", \"Mesh\" {\n"
                                "  Version: 232\n }\n}\nConnections:  {\n C: \"OO\",200,0\n"
                                " C: \"OO\",200,200\n}\n";
    write_bytes("cycle.fbx", cycle, sizeof cycle - 1);
    CHECK(!scene_load(test_host(), test_path("cycle.fbx")));
    CHECK(strstr(test_last_message(), "importer failed"));
}
