// Every file below the folder odd of the test scenes gives a scene or one error.
#include "framework/test.h"

#include "scene/view/defaults.h"
#include "scene/pose.h"
#include "scene/scene.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const double LONGEST_S = 5.0;

static double cpu_s(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

// Processor time of this process counts: the importer has limits of its own, and the machine may be
// busy.
static void check_file(const char *path)
{
    double start = cpu_s();
    test_host()->failure = FAIL_NONE;
    test_forget_messages();
    struct scene *scene = scene_load(test_host(), path);
    if (!scene && test_host()->failure == FAIL_NONE) fail_msg("%s: no reason", path);
    if (!scene && !test_last_message()[0]) fail_msg("%s: no message", path);
    struct scene_pose pose;
    if (scene && pose_init(&pose, scene, -1, 0.0f)) {
        struct world_camera camera = default_camera(&pose);
        CHECK(isfinite(camera.eye.x) && isfinite(camera.eye.y) && isfinite(camera.eye.z));
        CHECK(isfinite(camera.forward.x) && camera.near_m > 0.0f);
        pose_finish(&pose);
    }
    scene_destroy(scene);
    double took = cpu_s() - start;
    if (took > LONGEST_S) fail_msg("%s: %.1f s", path, took);
}

static bool is_scene(const char *name)
{
    static const char *const endings[] = { ".gltf", ".glb", ".obj", ".ply", ".fbx", ".x" };
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        size_t n = strlen(name), m = strlen(endings[i]);
        if (n > m && strcmp(name + n - m, endings[i]) == 0) return true;
    }
    return false;
}

// Compressed files are unpacked first.
static bool unpack(const char *folder, const char *name, char *out, size_t size)
{
    size_t n = strlen(name);
    if (n < 4 || strcmp(name + n - 3, ".gz") != 0) return false;
    char unpacked[256], command[8192];
    snprintf(unpacked, sizeof unpacked, "%.*s", (int)(n - 3), name);
    snprintf(out, size, "%s", test_path(unpacked));
    snprintf(command, sizeof command, "gzip -dc '%s/%s' > '%s'", folder, name, out);
    return system(command) == 0;
}

// Returns the number of scenes in the folder and below.
static int check_folder(const char *folder)
{
    char path[2048];
    int count = 0;
    DIR *files = opendir(folder);
    for (const struct dirent *entry; files && (entry = readdir(files));) {
        const char *name = entry->d_name;
        if (name[0] == '.') continue;
        snprintf(path, sizeof path, "%s/%s", folder, name);
        if (!strchr(name, '.')) {
            count += check_folder(path);
        } else if (is_scene(name) || unpack(folder, name, path, sizeof path)) {
            check_file(path);
            count++;
        }
    }
    if (files) closedir(files);
    return count;
}

TEST(every_odd_file_gives_a_scene_or_one_error_in_bounded_time)
{
    CHECK(check_folder(test_scene_path("odd")) > 20);
}
