// Splits a pose in two, for rays that meet walls alone or clutter alone.
#include "techniques/mrt/objects/clutter.h"

#include <math.h>
#include <string.h>

// Both parts have a mesh of their own for each instance.
static bool start_part(struct host *host, struct mrt_part *part, const struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    const size_t count = (size_t)scene->instance_count;
    part->scene = *scene;
    part->pose = *pose;
    part->pose.scene = &part->scene;
    part->scene.meshes = host_alloc(host, count, sizeof *part->scene.meshes);
    part->scene.instances = host_alloc(host, count, sizeof *part->scene.instances);
    part->scene.mesh_count = (int)count;
    if (!part->scene.meshes || !part->scene.instances) return false;
    for (int i = 0; i < scene->instance_count; i++) {
        part->scene.instances[i] = scene->instances[i];
        if (scene->instances[i].mesh < 0) continue;
        part->scene.instances[i].mesh = i;
        part->scene.meshes[i] = *scene_mesh_of(scene, i);
        part->scene.meshes[i].index_count = 0;
    }
    return true;
}

// A part without triangles of an instance has that instance removed.
static void close_part(struct mrt_part *part)
{
    for (int i = 0; i < part->scene.instance_count; i++)
        if (part->scene.instances[i].mesh >= 0 && part->scene.meshes[i].index_count == 0)
            part->scene.instances[i].mesh = -1;
}

static void append(struct mesh *mesh, const uint32_t corner[3])
{
    memcpy(mesh->indices + mesh->index_count, corner, 3 * sizeof *corner);
    mesh->index_count += 3;
}

static bool split(struct mrt_clutter *out, const struct scene_pose *pose, const bool *is_clutter)
{
    const size_t all = scene_triangle_count(pose->scene);
    out->indices = host_alloc(out->host, all, 6 * sizeof *out->indices);
    out->scene_chart_triangle = host_alloc(out->host, all, sizeof *out->scene_chart_triangle);
    out->scene_triangle_0 = host_alloc(out->host, (size_t)pose->scene->instance_count + 1,
                                       sizeof *out->scene_triangle_0);
    if (!out->indices || !out->scene_chart_triangle || !out->scene_triangle_0) return false;
    if (!start_part(out->host, &out->walls, pose) || !start_part(out->host, &out->objects, pose))
        return false;
    size_t first = 0, objects = 0;
    for (int i = 0; i < pose->scene->instance_count; i++) {
        const struct mesh *mesh = scene_mesh_of(pose->scene, i);
        const uint32_t count = mesh->index_count / 3;
        out->scene_triangle_0[i + 1] = (uint32_t)first;
        if (pose->scene->instances[i].mesh < 0) continue;
        out->walls.scene.meshes[i].indices = out->indices + 3 * first;
        out->objects.scene.meshes[i].indices = out->indices + 3 * (all + first);
        for (uint32_t t = 0; t < count; t++) {
            const bool object = is_clutter[first + t];
            append(&(object ? &out->objects : &out->walls)->scene.meshes[i],
                   mesh->indices + 3 * (size_t)t);
            out->scene_chart_triangle[first + t] = object ? (uint32_t)objects : CHART_NONE;
            objects += object;
        }
        first += count;
        out->scene_triangle_0[i + 1] = (uint32_t)first;
    }
    close_part(&out->walls);
    close_part(&out->objects);
    return true;
}

// Texels of clutter: four for each of its blocks' walls at the same density, and some for a level
// of few blocks. Many small parts, as leaves, touch more: with `most` the light map is left out.
static uint32_t wanted_texels(const struct mrt_block_map *map, float side)
{
    return (uint32_t)fminf(24.0f * side * side * (float)map->count, 262144.0f) + 8192u;
}

enum { MOST_TEXELS_OF_WANTED = 4 };

static bool make_charts(struct mrt_clutter *out, const struct mrt_block_map *map,
                        const struct mrt_clutter_options *options)
{
    const uint32_t texels = wanted_texels(map, options->texels_per_edge);
    const struct charts_wish wish = {
        .technique = "drt",
        .texels = texels,
        .most_density = options->texels_per_edge / mrt_block_map_mean_edge(map),
    };
    if (!charts_init_wanted(&out->charts, out->host, &out->objects.pose, &wish)) return false;
    out->is_too_fine = out->charts.texel_count > MOST_TEXELS_OF_WANTED * texels;
    return true;
}

bool mrt_clutter_init(struct mrt_clutter *out, struct host *host, const struct scene_pose *pose,
                      const struct mrt_block_map *map, const struct mrt_clutter_options *options)
{
    *out = (struct mrt_clutter){ .host = host };
    bool *is_clutter = host_alloc(host, scene_triangle_count(pose->scene), sizeof *is_clutter);
    bool ok = is_clutter && mrt_find_clutter(host, pose, map, is_clutter, &out->triangles);
    if (ok && out->triangles > 0)
        ok = split(out, pose, is_clutter) && make_charts(out, map, options) &&
             mrt_make_clutter_faces(out, map, options->max_faces);
    host_free(host, is_clutter);
    if (!ok) mrt_clutter_finish(out);
    return ok;
}

void mrt_clutter_finish(struct mrt_clutter *clutter)
{
    struct host *host = clutter->host;
    if (!host) return;
    struct mrt_part *const parts[2] = { &clutter->walls, &clutter->objects };
    for (int i = 0; i < 2; i++) {
        // A part that was not begun has the scene's own arrays.
        if (parts[i]->pose.scene != &parts[i]->scene) continue;
        host_free(host, parts[i]->scene.meshes);
        host_free(host, parts[i]->scene.instances);
    }
    charts_finish(&clutter->charts);
    host_free(host, clutter->indices);
    host_free(host, clutter->scene_chart_triangle);
    host_free(host, clutter->scene_triangle_0);
    host_free(host, clutter->faces);
    host_free(host, clutter->texels);
    host_free(host, clutter->face_of_texel);
    host_free(host, clutter->chart_faces);
    host_free(host, clutter->first_chart_face);
    *clutter = (struct mrt_clutter){ 0 };
}
