// The registry of built-in scenes, and how a spec becomes a scene.
#include "scene/builtin_parts.h"

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

// Of the name, every option's value and what was built from them: any of them changing makes old
// bakes stale.
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

int builtin_diffuse(struct scene *scene, const char *name, vec3s reflectance)
{
    struct material material = material_default();
    material.name = name;
    material.base_color = vec4_of(reflectance, 1);
    return scene_add_material(scene, &material);
}

int builtin_emitter(struct scene *scene, const char *name, vec3s radiance)
{
    struct material material = material_default();
    material.name = name;
    material.base_color = vec4_of(vec3_of(0, 0, 0), 1);
    material.emissive = radiance;
    return scene_add_material(scene, &material);
}

bool builtin_camera(struct scene *scene, const char *name, vec3s eye, vec3s target,
                    float vertical_fov_rad)
{
    struct camera camera = {
        .name = name,
        .vertical_fov_rad = vertical_fov_rad,
        .near_m = 0.01f,
    };
    camera.node = scene_add_node_looking(scene, name, eye, glms_vec3_sub(target, eye));
    return camera.node >= 0 && scene_add_camera(scene, &camera) >= 0;
}

bool builtin_point_light(struct scene *scene, const char *name, vec3s position, vec3s candela)
{
    struct light light = { .name = name, .type = LIGHT_POINT, .intensity = candela };
    light.node = scene_add_node_looking(scene, name, position, vec3_of(0, -1, 0));
    return light.node >= 0 && scene_add_light(scene, &light) >= 0;
}

bool builtin_sun(struct scene *scene, const char *name, vec3s over, vec3s direction, vec3s lux)
{
    struct light light = { .name = name, .type = LIGHT_SUN, .intensity = lux };
    light.node = scene_add_node_looking(scene, name, over, direction);
    return light.node >= 0 && scene_add_light(scene, &light) >= 0;
}

bool builtin_ball(struct scene *scene, vec3s centre, bool as_point, float lumens)
{
    static const float RADIUS = 0.12f;
    // Of luminance 1, so that lumens are photometric.
    vec3s white = vec3_of(1.13f, 0.98f, 0.815f);
    white = glms_vec3_scale(white, 1.0f / luminance(white));
    if (as_point) {
        return builtin_point_light(scene, "light", centre,
                                   glms_vec3_scale(white, lumens / (4.0f * GLM_PIf)));
    }
    // A diffuse surface of radiance L and area A shines π L A lumens.
    float area_m2 = 4.0f * GLM_PIf * RADIUS * RADIUS;
    int material =
        builtin_emitter(scene, "light", glms_vec3_scale(white, lumens / (GLM_PIf * area_m2)));
    if (material < 0) return false;
    struct shape_builder builder;
    shape_begin(&builder, scene);
    shape_sphere(&builder, centre, RADIUS, 24);
    return shape_emit(&builder, "light", material) >= 0;
}
