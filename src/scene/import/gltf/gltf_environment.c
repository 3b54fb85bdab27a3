// Light from outside of the scene: a uniform sky, EXT_lights_image_based and the environments that
// the exporter writes.
#include "scene/import/gltf/gltf.h"

#include <math.h>

static const char IMAGE_BASED[] = "EXT_lights_image_based";

// {"afterglow_sky": [r, g, b]} in the extras of the default scene, cd/m²: glTF has no sky.
static bool load_sky(struct gltf_object scene)
{
    struct gltf_object of = scene;
    of.json = json_object_get(scene.json, "extras");
    vec3s sky = vec3_of(0, 0, 0);
    if (!json_object_get(of.json, "afterglow_sky")) return true;
    if (!gltf_floats(of, "afterglow_sky", 3, sky.raw)) return false;
    for (int c = 0; c < 3; c++)
        if (!(sky.raw[c] >= 0.0f)) return gltf_wrong(of, "afterglow_sky is negative");
    scene.gltf->import->scene->environment.sky = sky;
    return true;
}

// The identity where the light has none.
static bool load_rotation(struct gltf_object light, versors *out)
{
    *out = glms_quat_identity();
    if (!gltf_floats(light, "rotation", 4, out->raw)) return !light.gltf->failed;
    const float length = glms_quat_norm(*out);
    if (!(length > 0.0f) || !isfinite(length))
        return gltf_wrong(light, "its rotation is not a unit quaternion");
    *out = glms_quat_normalize(*out);
    return true;
}

// An environment turns about +y without a change of its map; other rotations are those of the cube.
static float extract_turn(versors *rotation)
{
    if (rotation->x != 0.0f || rotation->z != 0.0f) return 0.0f;
    const float turn = 2.0f * atan2f(rotation->y, rotation->w);
    *rotation = glms_quat_identity();
    return turn;
}

static bool load_image_based(struct gltf_object scene)
{
    static const float MAX_STRENGTH = 1e6f; // ag_environment_use
    struct gltf *gltf = scene.gltf;
    struct environment *environment = &gltf->import->scene->environment;
    const struct gltf_object root = { gltf, gltf->root, "file", 0 };
    json_t *lights = gltf_array(gltf_extension(root, IMAGE_BASED), "lights");
    const int index = gltf_index(gltf_extension(scene, IMAGE_BASED), "light", lights);
    if (index < 0) return !gltf->failed;
    const struct gltf_object light = gltf_element(gltf, lights, "image-based light", (size_t)index);
    versors rotation;
    bool ok = true;
    if (!load_rotation(light, &rotation)) return false;
    environment->rotation_rad = extract_turn(&rotation);
    environment->strength = gltf_float(light, "intensity", 1.0f, 0.0f, MAX_STRENGTH);
    if (json_array_size(gltf_array(light, "specularImages")) == 0)
        import_note(gltf->import, "image-based light (it has no specularImages)");
    else if (!gltf->failed)
        environment->map = gltf_cube_map(gltf, light, rotation, &ok);
    return ok && !gltf->failed;
}

bool gltf_load_environment(struct gltf *gltf)
{
    const struct gltf_object root = { gltf, gltf->root, "file", 0 };
    json_t *scenes = gltf_array(root, "scenes");
    const int chosen = gltf_index(root, "scene", scenes);
    if (gltf->failed || json_array_size(scenes) == 0) return !gltf->failed;
    const struct gltf_object scene =
        gltf_element(gltf, scenes, "scene", chosen < 0 ? 0 : (size_t)chosen);
    const bool ok = load_sky(scene) && (gltf_has(gltf_child(scene, "extras"), GLTF_ENVIRONMENT)
                                            ? gltf_load_environment_extras(scene)
                                            : load_image_based(scene));
    struct scene *out = gltf->import->scene;
    out->file_environment = environment_map_use_key(&out->environment);
    return ok && !gltf->failed;
}
