// A record of a scene and its charts.
#include "lightmap/update/record.h"

#include "bake/scene_key.h"

#include <string.h>

// ---- instances

static struct box3 bounds_of(const struct scene_pose *pose, int instance)
{
    const struct mesh *mesh = scene_mesh_of(pose->scene, instance);
    const vec3s *deformed = pose->deformed[instance].positions;
    struct box3 box = box3_empty();
    if (!deformed) return box3_transform(pose_world_from_instance(pose, instance), mesh->bounds);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) box = box3_add_point(box, deformed[v]);
    return box;
}

static struct hash128 *hash_materials(struct host *host, const struct scene *scene)
{
    const size_t count = (size_t)scene->material_count;
    struct hash128 *keys = host_alloc(host, count, sizeof *keys);
    for (size_t i = 0; keys && i < count; i++)
        keys[i] = scene_key_add_material((struct hash128){ 0 }, scene, (int)i);
    return keys;
}

static struct record_instance instance_of(const struct scene_pose *pose, int instance,
                                          const struct hash128 *materials)
{
    const struct mesh *mesh = scene_mesh_of(pose->scene, instance);
    const struct hash128 none = { 0 };
    struct record_instance out = { .triangles = mesh->index_count / 3 };
    if (out.triangles == 0) return out;
    const struct material *material = &pose->scene->materials[mesh->material];
    out.shape = scene_key_add_shape(none, pose, instance);
    // Charts of double-sided materials have backs.
    out.shape = hash128_add(out.shape, &material->double_sided, sizeof material->double_sided);
    out.surface = scene_key_add_attributes(materials[mesh->material], pose->scene, instance);
    out.bounds = bounds_of(pose, instance);
    return out;
}

static bool add_instances(struct lightmap_record *r, const struct scene_pose *pose)
{
    const size_t count = (size_t)pose->scene->instance_count;
    struct hash128 *materials = hash_materials(r->host, pose->scene);
    r->instances = host_alloc(r->host, count, sizeof *r->instances);
    const bool ok = materials && r->instances;
    for (size_t i = 0; ok && i < count; i++) r->instances[i] = instance_of(pose, (int)i, materials);
    r->instance_count = (uint32_t)count;
    host_free(r->host, materials);
    return ok;
}

// ---- lights

static bool add_lights(struct lightmap_record *r, const struct scene_pose *pose)
{
    const int count = pose_light_count(pose);
    r->environment = environment_key(&pose->scene->environment);
    r->lights = host_alloc(r->host, (size_t)count, sizeof *r->lights);
    for (int i = 0; r->lights && i < count; i++)
        if (i >= pose->scene->light_count || !pose->scene->lights[i].off)
            r->lights[r->light_count++] = pose_light(pose, i);
    return r->lights;
}

// ---- charts

static struct record_chart chart_of(const struct lightmap_record *r, const struct charts *charts,
                                    uint32_t index)
{
    const struct chart *c = &charts->charts[index];
    const bool across = c->turns % 2 == 1;
    struct record_chart out = { .width = across ? c->height : c->width,
                                .height = across ? c->width : c->height,
                                .first_texel = c->first_texel,
                                .texel_count = c->texel_count,
                                .first_back = c->first_back };
    for (uint32_t i = c->first_triangle; i < c->first_triangle + c->triangle_count; i++) {
        const struct chart_triangle *t = &charts->triangles[i];
        out.key = hash128_add(out.key, &t->triangle, sizeof t->triangle);
        if (i > c->first_triangle && t->instance == charts->triangles[i - 1].instance) continue;
        out.key = hash128_add(out.key, &r->instances[t->instance].shape, sizeof(struct hash128));
    }
    return out;
}

bool lightmap_record_add_charts(struct lightmap_record *r, const struct charts *charts)
{
    r->charts = host_alloc(r->host, charts->count, sizeof *r->charts);
    r->places = host_alloc(r->host, charts->texel_count, sizeof *r->places);
    if (!r->charts || !r->places) return false;
    r->texels_per_m = charts->texels_per_m;
    r->search = charts->search;
    r->chart_count = charts->count;
    r->texel_count = charts->texel_count;
    r->row_count = charts->side_texel_count;
    for (uint32_t i = 0; i < charts->count; i++) {
        const struct chart *chart = &charts->charts[i];
        r->charts[i] = chart_of(r, charts, i);
        for (uint32_t k = chart->first_texel; k < chart->first_texel + chart->texel_count; k++) {
            const struct chart_place at = chart_own_place(chart, &charts->texels[k]);
            r->places[k] = (struct record_place){ .x = (uint16_t)at.x, .y = (uint16_t)at.y };
        }
    }
    return true;
}

static bool copy_rest(struct lightmap_record *r, const float *rest)
{
    r->rest = host_alloc(r->host, r->row_count, LIGHTMAP_COLUMNS * sizeof *r->rest);
    if (r->rest && r->row_count > 0)
        memcpy(r->rest, rest, r->row_count * LIGHTMAP_COLUMNS * sizeof *r->rest);
    return r->rest;
}

bool lightmap_record_init(struct lightmap_record *out, struct host *host,
                          const struct scene_pose *statics, const struct charts *charts,
                          const float *rest)
{
    *out = (struct lightmap_record){ .host = host };
    const bool ok = add_instances(out, statics) && add_lights(out, statics) &&
                    (!charts || lightmap_record_add_charts(out, charts)) &&
                    (!rest || copy_rest(out, rest));
    if (!ok) lightmap_record_finish(out);
    return ok;
}

void lightmap_record_finish(struct lightmap_record *r)
{
    if (!r->host) return;
    host_free(r->host, r->options);
    host_free(r->host, r->instances);
    host_free(r->host, r->lights);
    host_free(r->host, r->charts);
    host_free(r->host, r->places);
    host_free(r->host, r->rest);
    *r = (struct lightmap_record){ 0 };
}
