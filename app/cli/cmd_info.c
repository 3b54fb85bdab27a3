// afterglow info: contents of a scene, and its default light and camera.
#include "commands.h"
#include "cli/files/json.h"
#include "info_blocks.h"
#include "session.h"
#include "values.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const light_types[] = {
    [AG_LIGHT_SUN] = "sun", [AG_LIGHT_POINT] = "point", [AG_LIGHT_SPOT] = "spot"
};

// Which technique's light map is counted.
#define LIGHT_MAP_GI "radiosity"

static const double SMALLEST_PLAUSIBLE_M = 0.02, LARGEST_PLAUSIBLE_M = 100.0;

struct facts {
    const char *scene;
    double likelier_scale; // 0: none; not looked for with --scene-scale
    struct ag_scene_info info;
    struct defaults defaults;
    struct ag_bake_estimate light_map; // of radiosity at its defaults; 0 texels: none
    int pages;                         // of it, with --page; 0: not asked
    bool has_environment;
    struct ag_environment_info environment;
};

// Charts are made of the geometry alone: nothing is baked.
static void find_light_map(struct session *session, double time_s, struct ag_bake_estimate *out)
{
    struct ag_bake_desc desc;
    struct ag_bake *bake = NULL;
    ag_bake_desc_default(&desc);
    desc.animation = session->animation;
    desc.time_s = time_s;
    *out = (struct ag_bake_estimate){ 0 };
    if (ag_bake_create(session->scene, LIGHT_MAP_GI, &desc, &bake) == AG_OK)
        ag_bake_estimate_cost(bake, false, out);
    ag_bake_destroy(bake);
}

static enum status count_pages(struct session *session, struct facts *facts)
{
    const int page = session->arguments->page;
    if (page == 0 || facts->light_map.charts == 0) return DONE;
    const enum ag_result result =
        ag_lightmap_count_pages(session->scene, LIGHT_MAP_GI, page, &facts->pages);
    return result == AG_OK ? DONE : fail_library(session->context, result);
}

// ---- size

// The scale at which a scene has a plausible size, if it has none at 1: its unit may be the
// centimetre or the millimetre, or such a file was scaled as if it were in metres. 0: none.
static double likelier_scale(const struct ag_scene_info *info)
{
    double size = 0.0;
    for (int k = 0; k < 3; k++)
        size = fmax(size, (double)info->bounds_max[k] - (double)info->bounds_min[k]);
    if (size > LARGEST_PLAUSIBLE_M) return size > 50.0 * LARGEST_PLAUSIBLE_M ? 0.001 : 0.01;
    if (size > 0.0 && size < SMALLEST_PLAUSIBLE_M)
        return size < 0.1 * SMALLEST_PLAUSIBLE_M ? 1000.0 : 100.0;
    return 0.0;
}

// ---- JSON

static json_t *light_json(struct session *session, int index)
{
    struct ag_light_info light;
    double time_s = session->arguments->time_s;
    if (ag_scene_get_light(session->scene, index, session->animation, time_s, &light) != AG_OK)
        return NULL;
    const struct ag_light_desc *l = &light.light;
    json_t *object = json_pack("{s:o, s:s, s:s, s:o, s:b}", "name", json_text(light.name), "type",
                               light_types[l->type], "unit", l->type == AG_LIGHT_SUN ? "lx" : "cd",
                               "intensity", json_floats(l->intensity, 3), "enabled", l->enabled);
    if (l->type != AG_LIGHT_SUN)
        json_object_set_new(object, "position", json_floats(l->position, 3));
    if (l->type != AG_LIGHT_POINT)
        json_object_set_new(object, "direction", json_floats(l->direction, 3));
    if (l->type == AG_LIGHT_SPOT) {
        json_object_set_new(object, "inner_deg", json_double(degrees(l->inner_rad)));
        json_object_set_new(object, "outer_deg", json_double(degrees(l->outer_rad)));
    }
    return object;
}

static json_t *camera_json(struct session *session, int index)
{
    const char *name = ag_scene_camera_name(session->scene, index);
    struct ag_camera camera;
    double time_s = session->arguments->time_s;
    if (!name ||
        ag_scene_camera(session->scene, name, session->animation, time_s, &camera) != AG_OK)
        return NULL;
    return json_pack("{s:o, s:o, s:o, s:o, s:f, s:o}", "name", json_text(name), "eye",
                     json_floats(camera.eye, 3), "target", json_floats(camera.target, 3), "up",
                     json_floats(camera.up, 3), "fov_deg", degrees(camera.vertical_fov_rad),
                     "near_m", json_float(camera.near_m));
}

static json_t *material_json(struct session *session, int index)
{
    struct ag_material_info m;
    if (ag_scene_get_material(session->scene, index, &m) != AG_OK) return NULL;
    return json_pack(
        "{s:o, s:o, s:o, s:o, s:o, s:b, s:s, s:b, s:b, s:b, s:b}", "name", json_text(m.name),
        "base_color", json_floats(m.material.base_color, 4), "metallic",
        json_float(m.material.metallic), "roughness", json_float(m.material.roughness), "emissive",
        json_floats(m.material.emissive, 3), "double_sided", m.material.double_sided, "alpha_mode",
        m.alpha_mode, "base_color_map", m.base_color_map, "metallic_roughness_map",
        m.metallic_roughness_map, "normal_map", m.normal_map, "emissive_map", m.emissive_map);
}

static json_t *animation_json(struct session *session, int index)
{
    struct ag_animation_info animation;
    if (ag_scene_get_animation(session->scene, index, &animation) != AG_OK) return NULL;
    return json_pack("{s:o, s:f}", "name", json_text(animation.name), "duration_s",
                     animation.duration_s);
}

static json_t *list_of(struct session *session, int count,
                       json_t *(*item)(struct session *session, int index))
{
    json_t *array = json_array();
    for (int i = 0; array && i < count; i++) json_array_append_new(array, item(session, i));
    return array;
}

// Options that give the default light and camera; null if the scene has its own.
static json_t *defaults_json(const struct defaults *d)
{
    json_t *light =
        d->light[0] ? json_pack("{s:s, s:s}", "light", d->light, "sky", d->sky) : json_null();
    json_t *camera =
        d->eye[0] ? json_pack("{s:s, s:s, s:s}", "eye", d->eye, "target", d->target, "fov", d->fov)
                  : json_null();
    return json_pack("{s:o, s:o}", "light", light, "camera", camera);
}

static json_t *environment_json(const struct facts *facts)
{
    const struct ag_environment_info *e = &facts->environment;
    if (!facts->has_environment) return json_null();
    json_t *sun = e->has_sun
                      ? json_pack("{s:o, s:o, s:f}", "to_sun", json_floats(e->to_sun, 3), "lux",
                                  json_floats(e->sun_lux, 3), "radius_deg", degrees(e->sun_radius))
                      : json_null();
    return json_pack("{s:i, s:i, s:o, s:o, s:o}", "width", e->width, "height", e->height, "mean",
                     json_floats(e->mean, 3), "sun", sun, "sh_error", json_floats(e->sh_error, 4));
}

// An empty scene has no bounds.
static json_t *bounds_json(const struct ag_scene_info *info)
{
    if (info->bounds_min[0] > info->bounds_max[0]) return json_null();
    return json_pack("{s:o, s:o}", "min", json_floats(info->bounds_min, 3), "max",
                     json_floats(info->bounds_max, 3));
}

static json_t *light_map_json(const struct facts *facts)
{
    const struct ag_bake_estimate *map = &facts->light_map;
    if (map->charts == 0) return json_null();
    json_t *out = json_pack(
        "{s:s, s:f, s:I, s:f, s:o, s:o}", "technique", LIGHT_MAP_GI, "texels", map->texels,
        "charts", (json_int_t)map->charts, "texels_per_chart", map->texels / map->charts,
        "texels_per_m", json_float(map->texels_per_m), "utilisation", json_float(map->utilisation));
    if (facts->pages > 0) json_object_set_new(out, "pages", json_integer(facts->pages));
    return out;
}

static enum status info_json(struct session *session, const struct facts *facts)
{
    const struct ag_scene_info *i = &facts->info;
    return json_print(
        json_pack("{s:o, s:o, s:o, s:I, s:I, s:i, s:i, s:i, s:i, s:i, s:o, s:o, s:b, s:I, s:o, "
                  "s:o, s:o, s:o, s:o, "
                  "s:o, s:o}",
                  "scene", json_text(facts->scene), "scene_scale",
                  json_float(session->arguments->scene_scale), "likelier_scale",
                  facts->likelier_scale > 0.0 ? json_real(facts->likelier_scale) : json_null(),
                  "triangles", (json_int_t)i->triangles, "vertices", (json_int_t)i->vertices,
                  "meshes", i->meshes, "instances", i->instances, "images", i->images, "skins",
                  i->skins, "nodes", i->nodes, "bounds", bounds_json(i), "sky",
                  json_floats(i->sky, 3), "emissive", i->emissive, "memory_bytes",
                  (json_int_t)i->memory_bytes, "lights", list_of(session, i->lights, light_json),
                  "cameras", list_of(session, i->cameras, camera_json), "materials",
                  list_of(session, i->materials, material_json), "animations",
                  list_of(session, i->animations, animation_json), "defaults",
                  defaults_json(&facts->defaults), "light_map", light_map_json(facts),
                  "environment", environment_json(facts)));
}

// ---- text

static void print_vector(const char *before, const float v[3], const char *after)
{
    printf("%s%.6g, %.6g, %.6g%s", before, (double)v[0], (double)v[1], (double)v[2], after);
}

static void print_size(const struct facts *facts)
{
    const struct ag_scene_info *i = &facts->info;
    float size[3];
    if (i->bounds_min[0] > i->bounds_max[0]) return;
    for (int k = 0; k < 3; k++) size[k] = i->bounds_max[k] - i->bounds_min[k];
    print_vector("bounds       ", i->bounds_min, " to ");
    print_vector("", i->bounds_max, " m\n");
    print_vector("size         ", size, " m\n");
    const double scale = facts->likelier_scale;
    if (!(scale > 0.0)) return;
    printf("             implausible in metres; --scene-scale %g makes it", scale);
    for (int k = 0; k < 3; k++) size[k] *= (float)scale;
    print_vector(" ", size, " m\n");
}

static void print_counts(const struct facts *facts)
{
    const struct ag_scene_info *i = &facts->info;
    printf("triangles    %llu\nvertices     %llu\n", (unsigned long long)i->triangles,
           (unsigned long long)i->vertices);
    printf("meshes       %d\ninstances    %d\nmaterials    %d\nimages       %d\n", i->meshes,
           i->instances, i->materials, i->images);
    printf("skins        %d\nnodes        %d\n", i->skins, i->nodes);
    print_size(facts);
    printf("memory       %.1f MB\n", (double)i->memory_bytes * 1e-6);
    print_vector("sky          ", i->sky, " cd/m2\n");
    printf("emissive     %s\n", i->emissive ? "yes" : "no");
}

static void print_light_map(const struct facts *facts)
{
    const struct ag_bake_estimate *map = &facts->light_map;
    if (map->charts == 0) return;
    printf("light map    ");
    if (facts->pages > 0) printf("%d page%s of ", facts->pages, facts->pages == 1 ? "" : "s");
    printf("%.0f texels in %u charts, %.3g each, %.3g per metre, %.0f %% of the atlas (%s)\n",
           map->texels, (unsigned)map->charts, map->texels / map->charts, (double)map->texels_per_m,
           100.0 * (double)map->utilisation, LIGHT_MAP_GI);
}

// Strength 1 and rotation 0.
static void print_environment(const struct facts *facts)
{
    const struct ag_environment_info *e = &facts->environment;
    if (!facts->has_environment) return;
    printf("environment  %d x %d", e->width, e->height);
    print_vector(", mean radiance ", e->mean, " cd/m2\n");
    if (e->has_sun) {
        print_vector("  sun        ", e->sun_lux, " lx");
        print_vector(" from ", e->to_sun, "");
        printf(", radius %.3g degrees\n", degrees(e->sun_radius));
    } else {
        printf("  sun        none\n");
    }
    printf("  spherical harmonics of order 2 to 5 lack %.3g, %.3g, %.3g, %.3g of the radiance "
           "(RMS)\n",
           (double)e->sh_error[0], (double)e->sh_error[1], (double)e->sh_error[2],
           (double)e->sh_error[3]);
}

static void print_lights(struct session *session, int count)
{
    printf("lights       %d\n", count);
    for (int i = 0; i < count; i++) {
        struct ag_light_info light;
        if (ag_scene_get_light(session->scene, i, session->animation, session->arguments->time_s,
                               &light) != AG_OK)
            continue;
        const struct ag_light_desc *l = &light.light;
        printf("  %-10s %s", light.name, light_types[l->type]);
        if (l->type != AG_LIGHT_SUN) print_vector(" at ", l->position, "");
        if (l->type != AG_LIGHT_POINT) print_vector(" towards ", l->direction, "");
        if (l->type == AG_LIGHT_SPOT)
            printf(", %.4g to %.4g degrees", degrees(l->inner_rad), degrees(l->outer_rad));
        print_vector(", ", l->intensity, l->type == AG_LIGHT_SUN ? " lx" : " cd");
        printf("%s\n", l->enabled ? "" : ", off");
    }
}

static void print_cameras(struct session *session, int count)
{
    printf("cameras      %d\n", count);
    for (int i = 0; i < count; i++) {
        const char *name = ag_scene_camera_name(session->scene, i);
        struct ag_camera camera;
        if (!name || ag_scene_camera(session->scene, name, session->animation,
                                     session->arguments->time_s, &camera) != AG_OK)
            continue;
        printf("  %-10s", name);
        print_vector(" at ", camera.eye, "");
        print_vector(" looking at ", camera.target, "");
        printf(", %.4g degrees\n", degrees(camera.vertical_fov_rad));
    }
}

static void print_materials(struct session *session, int count)
{
    printf("materials    %d\n", count);
    for (int i = 0; i < count; i++) {
        struct ag_material_info m;
        if (ag_scene_get_material(session->scene, i, &m) != AG_OK) continue;
        printf("  %-24s", m.name);
        print_vector(" colour ", m.material.base_color, "");
        printf(", metallic %.3g, roughness %.3g", (double)m.material.metallic,
               (double)m.material.roughness);
        const float *emissive = m.material.emissive;
        if (emissive[0] > 0 || emissive[1] > 0 || emissive[2] > 0)
            print_vector(", emissive ", emissive, " cd/m2");
        printf("%s%s%s%s%s\n", m.base_color_map ? ", colour map" : "",
               m.metallic_roughness_map ? ", roughness map" : "",
               m.normal_map ? ", normal map" : "", m.emissive_map ? ", emissive map" : "",
               strcmp(m.alpha_mode, "opaque") != 0 ? ", alpha mask or blend" : "");
    }
}

static void print_animations(struct session *session, int count)
{
    printf("animations   %d\n", count);
    for (int i = 0; i < count; i++) {
        struct ag_animation_info animation;
        if (ag_scene_get_animation(session->scene, i, &animation) == AG_OK)
            printf("  %-2d %-20s %.4g s\n", i, animation.name, animation.duration_s);
    }
}

static void print_defaults(const struct defaults *d)
{
    if (!d->light[0] && !d->eye[0]) return;
    printf("default light and camera, as options:\n");
    if (d->light[0]) printf("  --light %s --sky %s\n", d->light, d->sky);
    if (d->eye[0]) printf("  --eye %s --target %s --fov %s\n", d->eye, d->target, d->fov);
}

static void info_text(struct session *session, const struct facts *facts)
{
    printf("%s\n", printable(facts->scene).s);
    print_counts(facts);
    print_light_map(facts);
    print_environment(facts);
    print_lights(session, facts->info.lights);
    print_cameras(session, facts->info.cameras);
    print_animations(session, facts->info.animations);
    print_materials(session, facts->info.materials);
    print_defaults(&facts->defaults);
}

// That of --environment, or of the scene's file.
static enum status find_environment(struct session *session, struct facts *facts)
{
    struct ag_environment *environment = NULL;
    enum ag_result result =
        session->arguments->environment
            ? environment_make(session->context, &session->arguments->environment_value,
                               &environment)
            : ag_scene_get_environment(session->scene, &environment, NULL);
    if (result == AG_OK && environment)
        result = ag_environment_get_info(environment, &facts->environment);
    facts->has_environment = result == AG_OK && environment;
    ag_environment_destroy(environment);
    return result == AG_OK ? DONE : fail_library(session->context, result);
}

static enum status info(const struct arguments *arguments)
{
    struct session session;
    struct facts facts = { .scene = arguments->positional[0] };
    enum status status = session_begin(&session, arguments);
    if (status == DONE) status = session_load(&session, facts.scene, arguments->scene_scale);
    if (status == DONE) status = defaults_light(&session, &facts.defaults);
    if (status == DONE) status = defaults_camera(&session, arguments->time_s, &facts.defaults);
    if (status == DONE) {
        enum ag_result result =
            ag_scene_get_info(session.scene, session.animation, arguments->time_s, &facts.info);
        if (result != AG_OK) status = fail_library(session.context, result);
    }
    if (status == DONE && !arguments->has_scene_scale)
        facts.likelier_scale = likelier_scale(&facts.info);
    if (status == DONE) status = find_environment(&session, &facts);
    if (status == DONE) status = info_write_blocks(&session);
    if (status == DONE) find_light_map(&session, arguments->time_s, &facts.light_map);
    if (status == DONE) status = count_pages(&session, &facts);
    if (status == DONE && arguments->json)
        status = info_json(&session, &facts);
    else if (status == DONE)
        info_text(&session, &facts);
    session_end(&session);
    return status;
}

const struct command command_info = {
    .name = "info",
    .bit = INFO,
    .positional_count = 1,
    .usage = "SCENE [options]",
    .summary = "show the contents of SCENE: size, lights, cameras, materials",
    .text = "Shows counts, size, lights, cameras, animations and materials of SCENE.\n"
            "The light map is that of radiosity at its defaults.\n"
            "If light or camera are missing, shows the options that render would use.\n"
            "Lengths are in metres, suns in lux, other lights in candela.\n"
            "For a scene of an implausible size, shows the --scene-scale that may be right.\n"
            "Writes the blocks that stand for SCENE in mrt, to be edited (--blocks).\n",
    .examples = "  afterglow info house.glb\n"
                "  afterglow info @cornell:light=point --json\n"
                "  afterglow info fox.glb --animation Run --time 0.5\n"
                "  afterglow info house.glb --blocks house.json\n",
    .run = info,
};
