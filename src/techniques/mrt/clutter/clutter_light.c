// Clutter's texels as a geometry image.
#include "techniques/mrt/clutter/clutter_light.h"

// Rays that find the material start so far from the surface, m.
static const float AWAY = 1e-3f;

static void look_at(const struct trace_scene *objects, const struct mrt_clutter *clutter,
                    uint32_t texel, struct mrt_geometry_texel *out)
{
    const vec3s normal = chart_texel_normal(&clutter->charts, texel);
    const vec3s position = chart_texel_of(&clutter->charts, texel)->position;
    struct trace_hit hit;
    *out = (struct mrt_geometry_texel){ .position = position, .normal = normal, .found = true };
    if (!trace_closest(objects, glms_vec3_muladds(normal, AWAY, position), glms_vec3_negate(normal),
                       2.0f * AWAY, &hit))
        return;
    out->albedo = glms_vec3_scale(hit.albedo, 1.0f - hit.metallic);
    out->emission = hit.emission;
}

static bool look(struct mrt_scene_images *images, const struct mrt_clutter *clutter)
{
    struct trace_scene *objects = trace_scene_create(images->host, &clutter->objects.pose);
    if (!objects) return false;
    for (uint32_t i = 0; i < clutter->charts.side_texel_count; i++)
        look_at(objects, clutter, clutter->texels[i], &images->geometry[i]);
    trace_scene_destroy(objects);
    return true;
}

struct mrt_clutter_texel *mrt_clutter_light_create(struct host *host, const struct scene_pose *pose,
                                                   const struct mrt_clutter *clutter)
{
    const size_t count = clutter->charts.side_texel_count;
    struct mrt_scene_images images = { .host = host };
    struct mrt_clutter_texel *out = host_alloc(host, count, sizeof *out);
    struct trace_scene *scene = trace_scene_create(host, pose);
    images.geometry = host_alloc(host, count, sizeof *images.geometry);
    const bool ok = out && scene && images.geometry && look(&images, clutter) &&
                    mrt_unbounced_texels(&images, pose, scene, count);
    for (size_t i = 0; ok && i < count; i++)
        out[i] = (struct mrt_clutter_texel){
            images.geometry[i], chart_texel_of(&clutter->charts, clutter->texels[i])->area_m2,
            images.emitted[i], images.sky[i]
        };
    mrt_scene_images_finish(&images);
    trace_scene_destroy(scene);
    if (ok) return out;
    host_free(host, out);
    return NULL;
}
