// {"afterglow_environment": {"bufferView", "strength", "rotation", "name", "sun"}} in the extras of
// the default scene. The view is an OpenEXR file with the map's image, from which the sun was
// taken, {"direction", "illuminance", "radius"}: towards it in the map's space, lux, radians.
#include "scene/import/gltf/gltf.h"

#include "image/exr.h"
#include "scene/environment/environment_map.h"

#include <float.h>
#include <math.h>

bool gltf_is_environment_sun(const json_t *light)
{
    return json_is_true(json_object_get(json_object_get(light, "extras"), GLTF_ENVIRONMENT_SUN));
}

static bool load_sun(struct gltf_object object, struct environment_sun *out)
{
    struct gltf_object sun = gltf_child(object, "sun");
    *out = (struct environment_sun){ .found = sun.json };
    if (!sun.json) return !object.gltf->failed;
    if (!gltf_floats(sun, "direction", 3, out->to_sun.raw) ||
        !gltf_floats(sun, "illuminance", 3, out->illuminance_lux.raw))
        return gltf_wrong(object, "its sun has no direction or no illuminance");
    out->radius_rad = gltf_float(sun, "radius", 0.0f, 0.0f, GLM_PIf);
    if (!(fabsf(glms_vec3_norm(out->to_sun) - 1.0f) < 1e-3f))
        return gltf_wrong(object, "the direction of its sun is not a unit vector");
    for (int c = 0; c < 3; c++)
        if (!(out->illuminance_lux.raw[c] >= 0.0f))
            return gltf_wrong(object, "the illuminance of its sun is negative");
    return !object.gltf->failed;
}

// An image of more pixels than the largest map is refused before it is allocated.
static bool load_image(struct gltf_object object, struct image *out)
{
    static const size_t MOST = (size_t)ENVIRONMENT_MAX_WIDTH * ENVIRONMENT_MAX_WIDTH / 2;
    struct gltf *gltf = object.gltf;
    struct gltf_view view;
    const int index = gltf_index(object, "bufferView", gltf->views);
    if (index < 0) return gltf_wrong(object, "has no bufferView");
    if (!gltf_view(gltf, index, &view)) return false;
    if (!exr_decode(gltf->import->host, "the environment", view.data, view.size, MOST, out))
        return false;
    if (out->width > ENVIRONMENT_MAX_WIDTH)
        return gltf_wrong(object, "is wider than %d", ENVIRONMENT_MAX_WIDTH);
    return import_charge(gltf->import, (size_t)out->width * (size_t)out->height,
                         2 * 3 * sizeof(float));
}

bool gltf_load_environment_extras(struct gltf_object scene)
{
    struct environment *environment = &scene.gltf->import->scene->environment;
    struct host *host = scene.gltf->import->host;
    struct gltf_object object = gltf_child(gltf_child(scene, "extras"), GLTF_ENVIRONMENT);
    object.kind = "environment of scene";
    const char *name = gltf_string(object, "name");
    struct environment_sun sun;
    struct image image = { 0 };
    environment->strength = gltf_float(object, "strength", 1.0f, 0.0f, 1e6f);
    environment->rotation_rad = gltf_float(object, "rotation", 0.0f, -FLT_MAX, FLT_MAX);
    if (scene.gltf->failed || !load_sun(object, &sun)) return false;
    name = import_name(scene.gltf->import, name, "environment", scene.index);
    if (name && load_image(object, &image))
        environment->map = environment_map_restore(host, name, &image, &sun);
    image_finish(&image, host);
    return environment->map;
}
