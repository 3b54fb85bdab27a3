// Symbolic links among the files of a scene: they lead out of its folder only where that is asked
// for.
#include "scene/gltf_maker.h"

#include "scene/import/import.h"

#include <sys/stat.h>
#include <unistd.h>

#define TRIANGLE(members)                                                                          \
    "{" ASSET ",'buffers':[{'byteLength':36,'uri':'data/made.bin'}],"                              \
    "'bufferViews':[{'buffer':0,'byteLength':36}],"                                                \
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}]," members         \
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'material':0}]}],"                      \
    "'nodes':[{'mesh':0}]}"
#define PLAIN "'materials':[{}],"
#define TEXTURED                                                                                   \
    "'materials':[{'pbrMetallicRoughness':{'baseColorTexture':{'index':0}}}],"                     \
    "'textures':[{'source':0}],'images':[{'uri':'made.png'}],"

static const float corners[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };
static const char cube_side[] = "mtllib made.mtl\nv 0 0 0\nv 2 0 0\nv 2 3 0\nusemtl red\nf 1 2 3\n";
static const char red[] = "newmtl red\nKd 0.8 0.1 0.2\n";

// The folder scene/ with an empty folder data/, and outside/ beside it.
static void make_folders(void)
{
    char command[1200];
    snprintf(command, sizeof command,
             "cd '%s' && rm -rf scene outside && mkdir -p scene/data outside", test_path(""));
    CHECK(system(command) == 0);
    write_bytes("outside/made.bin", corners, sizeof corners);
    write_bytes("outside/made.mtl", red, sizeof red - 1);
    write_bytes("outside/made.png", "no image", 8);
}

static void write_json(const char *text)
{
    char *json = json_of(text);
    write_bytes("scene/made.gltf", json, strlen(json));
    free(json);
}

static void link_to(const char *target, const char *path)
{
    remove(test_path(path));
    assert_int_equal(symlink(target, test_path(path)), 0);
}

static struct scene *load(const char *path, bool follow_links)
{
    struct host *host = test_host();
    host->follow_links = follow_links;
    host->failure = FAIL_NONE;
    test_forget_messages();
    struct scene *scene = scene_load(host, test_path(path));
    host->follow_links = false;
    return scene;
}

static void check_loads(const char *path, bool follow_links)
{
    struct scene *scene = load(path, follow_links);
    if (!scene) fail_msg("%s: %s", path, test_last_message());
    assert_int_equal(scene_triangle_count(scene), 1);
    scene_destroy(scene);
}

static void check_asks(const char *path, const char *file)
{
    char said[100];
    CHECK(!load(path, false));
    CHECK(test_host()->failure == FAIL_FILE);
    snprintf(said, sizeof said, "refers to %s, which a symbolic link leads out", file);
    CHECK(strstr(test_last_message(), said) && strstr(test_last_message(), "--follow-links"));
    check_loads(path, true);
}

TEST(a_buffer_of_gltf_is_no_link_out_of_the_folder)
{
    make_folders();
    write_json(TRIANGLE(PLAIN));
    link_to("../../outside/made.bin", "scene/data/made.bin");
    check_asks("scene/made.gltf", "data/made.bin");
    remove(test_path("scene/data/made.bin"));
    remove(test_path("scene/data"));
    link_to("../outside", "scene/data"); // the folder is the link
    check_asks("scene/made.gltf", "data/made.bin");
}

TEST(an_image_of_gltf_is_no_link_out_of_the_folder)
{
    make_folders();
    write_json(TRIANGLE(TEXTURED));
    write_bytes("scene/data/made.bin", corners, sizeof corners);
    link_to(test_path("outside/made.png"), "scene/made.png");
    check_asks("scene/made.gltf", "made.png");
    link_to("../outside/nowhere.png", "scene/made.png");
    check_loads("scene/made.gltf", false); // as without the file
    CHECK(strstr(test_last_message(), "no such file"));
}

TEST(materials_and_images_of_obj_are_no_links_out_of_the_folder)
{
    const char textured[] = "newmtl red\nmap_Kd made.png\n";
    make_folders();
    write_bytes("scene/made.obj", cube_side, sizeof cube_side - 1);
    link_to("../outside/made.mtl", "scene/made.mtl");
    check_asks("scene/made.obj", "made.mtl");
    struct scene *scene = load("scene/made.obj", true);
    CHECK_NEAR(scene->materials[scene->meshes[0].material].base_color.x, 0.8, 1e-6);
    scene_destroy(scene);
    remove(test_path("scene/made.mtl"));
    write_bytes("scene/made.mtl", textured, sizeof textured - 1);
    link_to("../outside/made.png", "scene/made.png");
    check_asks("scene/made.obj", "made.png");
}

TEST(links_within_the_folder_are_followed)
{
    make_folders();
    write_json(TRIANGLE(PLAIN));
    write_bytes("scene/other.bin", corners, sizeof corners);
    link_to("../other.bin", "scene/data/made.bin");
    check_loads("scene/made.gltf", false);
    link_to(test_path("scene/other.bin"), "scene/data/made.bin"); // absolute
    check_loads("scene/made.gltf", false);
    write_bytes("scene/made.obj", cube_side, sizeof cube_side - 1);
    write_bytes("scene/data/red.mtl", red, sizeof red - 1);
    link_to("data/red.mtl", "scene/made.mtl");
    check_loads("scene/made.obj", false);
}

// The folder is that of the link.
TEST(the_scene_file_may_be_a_link)
{
    make_folders();
    write_json(TRIANGLE(PLAIN));
    write_bytes("scene/data/made.bin", corners, sizeof corners);
    rename(test_path("scene/made.gltf"), test_path("outside/there.gltf"));
    link_to("../outside/there.gltf", "scene/made.gltf");
    check_loads("scene/made.gltf", false);
    write_bytes("outside/there.obj", cube_side, sizeof cube_side - 1);
    write_bytes("scene/made.mtl", red, sizeof red - 1);
    link_to("../outside/there.obj", "scene/made.obj");
    check_loads("scene/made.obj", false);
    link_to("scene", "linked"); // a folder on the way to the scene
    check_loads("linked/made.gltf", false);
    check_loads("linked/made.obj", false);
}

TEST(a_scene_in_memory_has_the_same_rule_for_its_folder)
{
    char folder[600];
    make_folders();
    char *json = json_of(TRIANGLE(PLAIN));
    snprintf(folder, sizeof folder, "%s", test_path("scene"));
    link_to("../../outside/made.bin", "scene/data/made.bin");
    const struct import_bytes from = { json, strlen(json), "made.gltf", folder, NULL, NULL, 0 };
    CHECK(!import_memory(test_host(), &from));
    CHECK(strstr(test_last_message(), "--follow-links"));
    free(json);
}
