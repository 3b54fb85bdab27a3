// The registry of built-in scenes; parses a spec and builds its scene.
#include "scene/builtin/parts.h"

#include "core/hash.h"

#include <stdio.h>
#include <string.h>

const struct builtin_scene *const builtin_scenes[] = {
    &builtin_cornell, &builtin_atrium,   &builtin_corridor, &builtin_maze, &builtin_tunnel,
    &builtin_spheres, &builtin_diagonal, &builtin_planter,  NULL,
};

enum { MAX_NAME = 32, MAX_BUILTINS = 32 };

static const struct builtin_scene *find_builtin(struct host *host, const char *spec,
                                                const char *name)
{
    const char *known[MAX_BUILTINS] = { NULL };
    size_t count = 0;
    for (; builtin_scenes[count] && count < MAX_BUILTINS; count++) {
        known[count] = builtin_scenes[count]->name;
        if (strcmp(name, known[count]) == 0) return builtin_scenes[count];
    }
    const char *nearest = nearest_name(name, known, count);
    if (nearest) {
        host_fail(host, FAIL_ARGUMENT,
                  "scene \"%s\": there is no built-in \"%s\"; did you mean \"@%s\"?", spec, name,
                  nearest);
        return NULL;
    }
    char list[MAX_NAME * MAX_BUILTINS] = "";
    for (size_t i = 0, length = 0; i < count; i++) {
        length += (size_t)snprintf(list + length, sizeof list - length, " @%s", known[i]);
    }
    host_fail(host, FAIL_ARGUMENT, "scene \"%s\": there is no built-in \"%s\"; there are%s", spec,
              name, list);
    return NULL;
}

// Hash of name, option values, geometry, materials and images. Bakes of another hash are stale.
static uint64_t content_hash(const struct scene *scene, const struct builtin_scene *builtin,
                             const void *options)
{
    uint64_t hash = hash_bytes(builtin->name, strlen(builtin->name), 0);
    for (size_t i = 0; i < builtin->options.count; i++) {
        char value[64];
        option_print(&builtin->options.rows[i], options, value, sizeof value);
        hash = hash_bytes(value, strlen(value), hash);
    }
    for (int i = 0; i < scene->mesh_count; i++) {
        const struct mesh *mesh = &scene->meshes[i];
        hash = hash_bytes(mesh->positions, mesh->vertex_count * sizeof *mesh->positions, hash);
        hash = hash_bytes(mesh->indices, mesh->index_count * sizeof *mesh->indices, hash);
        const struct material *material = &scene->materials[mesh->material];
        hash = hash_bytes(&material->base_color, sizeof material->base_color, hash);
        hash = hash_bytes(&material->emissive, sizeof material->emissive, hash);
    }
    for (int i = 0; i < scene->image_count; i++) {
        const struct scene_image *image = &scene->images[i];
        hash = hash_bytes(image->rgba, 4 * (size_t)image->width * (size_t)image->height, hash);
    }
    return hash;
}

static struct scene *build(struct host *host, const char *spec, const struct builtin_scene *builtin,
                           const void *options)
{
    struct scene *scene = scene_create(host, spec);
    if (!scene) return NULL;
    if (!builtin->build(scene, options)) {
        scene_destroy(scene);
        return NULL;
    }
    scene->content_hash = content_hash(scene, builtin, options);
    return scene;
}

struct scene *builtin_load(struct host *host, const char *spec)
{
    const char *name_start = spec[0] == '@' ? spec + 1 : spec;
    const char *colon = strchr(name_start, ':');
    size_t length = colon ? (size_t)(colon - name_start) : strlen(name_start);
    char name[MAX_NAME];
    snprintf(name, sizeof name, "%.*s", (int)(length < MAX_NAME ? length : MAX_NAME), name_start);
    const struct builtin_scene *builtin = find_builtin(host, spec, name);
    if (!builtin) return NULL;

    void *options = host_alloc(host, 1, builtin->options.size);
    if (!options) return NULL;
    struct scene *scene = NULL;
    option_defaults(&builtin->options, options);
    char owner[MAX_NAME + 1];
    snprintf(owner, sizeof owner, "@%s", builtin->name);
    if (option_parse(host, &builtin->options, owner, colon ? colon + 1 : "", options)) {
        scene = build(host, spec, builtin, options);
    }
    host_free(host, options);
    return scene;
}
