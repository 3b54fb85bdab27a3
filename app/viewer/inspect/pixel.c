#include "pixel.h"

#include "shell/json_values.h"
#include "viewer/operations.h"

#include <math.h>

const char *const pixel_layers[PIXEL_LAYERS] = { "color",      "direct", "indirect", "specular",
                                                 "irradiance", "albedo", "normal",   "position",
                                                 "depth",      "id" };

// ---- layers

static void forget(struct viewer *v, int part)
{
    for (int i = 0; i < PIXEL_LAYERS; i++) {
        ag_image_destroy(v->desc->context, v->pixels.layers[part][i]);
        v->pixels.layers[part][i] = NULL;
    }
    v->pixels.version[part] = 0;
}

void pixels_forget(struct viewer *v)
{
    forget(v, 0);
    forget(v, 1);
}

// A failure is said once: the version is taken all the same.
bool pixels_read(struct viewer *v, bool other)
{
    const int part = other ? 1 : 0;
    struct ag_image **layers = v->pixels.layers[part];
    struct rendering *rendering = other ? &v->other : &v->main;
    if (v->pixels.version[part] == v->version) return layers[PIXEL_LAYERS - 1] != NULL;
    if (v->dirty > 0 || !rendering->shown.vk_image) return false;
    forget(v, part);
    v->pixels.version[part] = v->version;
    for (int i = 0; i < PIXEL_LAYERS; i++)
        if (!viewer_check(v, ag_renderer_read(rendering->renderer, pixel_layers[i], &layers[i])))
            return false;
    return true;
}

// ---- one pixel

bool pixel_chosen(const struct viewer *v, struct pixel_at *out)
{
    const struct region r = viewer_region(v);
    const float x = v->mouse_x, y = v->mouse_y;
    *out = (struct pixel_at){ .x = (int)(v->scale * x), .y = (int)(v->scale * y) };
    out->clicked = x < r.x0 || y < r.y0 || x >= r.x1 || y >= r.y1;
    if (out->clicked) {
        out->x = v->pick_at[0];
        out->y = v->pick_at[1];
    }
    out->other = v->split && ((out->clicked ? v->pick_right : v->mouse_right) ||
                              (float)out->x >= viewer_first_share(v) * (float)v->main.width);
    return out->x >= 0 && out->y >= 0 && out->x < v->main.width && out->y < v->main.height;
}

static void find_surface(struct viewer *v, struct pixel *pixel)
{
    struct ag_scene *scene = v->desc->scene;
    struct ag_instance_info instance;
    struct ag_mesh_info mesh;
    struct ag_material_info material;
    if (pixel->instance < 0 || ag_scene_get_instance(scene, pixel->instance, v->desc->animation,
                                                     v->time_s, &instance) != AG_OK)
        return;
    if (instance.name) pixel->instance_name = instance.name;
    if (ag_scene_get_mesh(scene, instance.mesh, &mesh) != AG_OK) return;
    pixel->mesh = instance.mesh;
    if (mesh.name) pixel->mesh_name = mesh.name;
    if (ag_scene_get_material(scene, mesh.material, &material) != AG_OK) return;
    pixel->material = mesh.material;
    if (material.name) pixel->material_name = material.name;
}

bool pixel_get(struct viewer *v, const struct pixel_at *at, struct pixel *out)
{
    static const float middle_grey = 0.18f * 1.2f; // cd/m² at EV 0: docs/units.md
    *out = (struct pixel){
        .mesh = -1, .material = -1, .instance_name = "", .mesh_name = "", .material_name = ""
    };
    for (int i = 0; i < PIXEL_LAYERS; i++) {
        const struct ag_image *image = v->pixels.layers[at->other ? 1 : 0][i];
        if (!image || at->x >= image->width || at->y >= image->height) return false;
        const size_t first = (size_t)at->y * (size_t)image->width + (size_t)at->x;
        for (int c = 0; c < image->channels && c < 3; c++)
            out->layers[i][c] = image->pixels[first * (size_t)image->channels + (size_t)c];
    }
    const float *color = out->layers[PIXEL_COLOR];
    out->luminance = 0.2126f * color[0] + 0.7152f * color[1] + 0.0722f * color[2];
    out->ev = out->luminance > 0 ? log2f(out->luminance / middle_grey) : -INFINITY;
    out->instance = (int)out->layers[PIXEL_ID][0];
    out->triangle = (int)out->layers[PIXEL_ID][1];
    find_surface(v, out);
    return true;
}

// ---- JSON

json_t *pixel_json(const struct pixel_at *at, const struct pixel *pixel)
{
    json_t *object = json_pack("{s:[ii]}", "pixel", at->x, at->y);
    for (int i = 0; i < PIXEL_ID; i++)
        json_object_set_new(object, pixel_layers[i],
                            i == PIXEL_DEPTH ? json_float(pixel->layers[i][0])
                                             : json_floats(pixel->layers[i], 3));
    json_object_set_new(object, "luminance", json_float(pixel->luminance));
    json_object_set_new(object, "ev", json_float(pixel->ev));
    json_object_set_new(object, "instance", json_integer(pixel->instance));
    json_object_set_new(object, "instance_name", json_text(pixel->instance_name));
    json_object_set_new(object, "triangle", json_integer(pixel->triangle));
    json_object_set_new(object, "mesh", json_integer(pixel->mesh));
    json_object_set_new(object, "mesh_name", json_text(pixel->mesh_name));
    json_object_set_new(object, "material", json_integer(pixel->material));
    json_object_set_new(object, "material_name", json_text(pixel->material_name));
    return object;
}
