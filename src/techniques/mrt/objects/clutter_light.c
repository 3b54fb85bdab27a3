// Clutter's texels as a geometry image.
#include "techniques/mrt/objects/clutter.h"

#include "techniques/mrt/light/area_light.h"
#include "trace/texels/texels.h"

static struct mrt_geometry_texel look_at(const struct trace_scene *objects,
                                         const struct mrt_clutter *clutter, uint32_t texel)
{
    const vec3s normal = chart_texel_normal(&clutter->charts, texel);
    const struct chart_texel *t = chart_texel_of(&clutter->charts, texel);
    struct surface surface;
    texel_surface(objects, &clutter->charts.triangles[t->triangle], t->u, t->v, normal, &surface);
    return (struct mrt_geometry_texel){
        .position = t->position,
        .normal = normal,
        .reflectance = vec3_xyz(texel_reflectance(objects, &clutter->charts, texel, NULL)),
        .emission = surface.emission,
        .found = true,
        .area_m2 = t->area_m2,
    };
}

struct mrt_geometry_texel *mrt_clutter_light_create(struct host *host,
                                                    const struct scene_pose *pose,
                                                    const struct mrt_clutter *clutter,
                                                    struct mrt_reflectors *reflectors)
{
    const size_t count = clutter->charts.side_texel_count;
    struct mrt_geometry_texel *out = host_alloc(host, count, sizeof *out);
    struct trace_scene *objects = trace_scene_create(host, &clutter->objects.pose);
    struct trace_scene *scene = trace_scene_create(host, pose);
    bool ok = out && objects && scene, lit;
    for (size_t i = 0; ok && i < count; i++) out[i] = look_at(objects, clutter, clutter->texels[i]);
    // Four in a row of the atlas are neighbours.
    const struct mrt_texel_list texels = { out, count, 2 };
    ok = ok && mrt_area_light_texels(scene, reflectors, &texels, &lit);
    trace_scene_destroy(objects);
    trace_scene_destroy(scene);
    if (ok) return out;
    host_free(host, out);
    return NULL;
}
