// Lights, sky and materials.
#include "panel.h"

#include "overlay.h"
#include "viewer/scene/changes.h"
#include "viewer/scene/light_values.h"
#include "viewer/operations.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const float DEGREES = 57.29578f;
static const char *const units[] = { "lux", "cd", "cd" };

static float largest(const float rgb[3])
{
    return fmaxf(fmaxf(rgb[0], rgb[1]), rgb[2]);
}

// Intensity and colour of a light; the colour's largest component is 1.
static bool edit_intensity(float rgb[3], const char *unit, float most)
{
    float level = largest(rgb), color[3] = { 1, 1, 1 };
    char label[32];
    for (int i = 0; i < 3 && level > 0; i++) color[i] = rgb[i] / level;
    snprintf(label, sizeof label, "intensity (%s)", unit);
    bool changed = ui_number(label, &level, 0.0f, most, "%.4g", true);
    if (ui_color("color", color)) {
        const float scale = largest(color);
        for (int i = 0; i < 3 && scale > 0; i++) color[i] /= scale;
        changed = true;
    }
    float kelvin = 6500.0f;
    if (ui_number("temperature (K)", &kelvin, 1700.0f, 15000.0f, "set to %.0f", true)) {
        light_black_body(kelvin, color);
        changed = true;
    }
    ui_tooltip("Sets the colour to that of a black body.");
    for (int i = 0; i < 3 && changed; i++) rgb[i] = level * color[i];
    return changed;
}

static bool edit_direction(float direction[3])
{
    float elevation, azimuth;
    light_angles(direction, &elevation, &azimuth);
    elevation *= DEGREES;
    azimuth *= DEGREES;
    bool changed = ui_number("elevation (°)", &elevation, -90.0f, 90.0f, "%.1f", false);
    changed |= ui_number("azimuth (°)", &azimuth, -180.0f, 180.0f, "%.1f", false);
    ui_tooltip("Of the point from which the light comes; azimuth from −z towards +x.");
    if (changed) light_direction(elevation / DEGREES, azimuth / DEGREES, direction);
    return changed;
}

static bool edit_cone(struct ag_light_desc *light)
{
    float inner = light->inner_rad * DEGREES, outer = light->outer_rad * DEGREES;
    bool changed = ui_number("inner angle (°)", &inner, 0.0f, 89.0f, "%.1f", false);
    changed |= ui_number("outer angle (°)", &outer, 1.0f, 89.9f, "%.1f", false);
    if (!changed) return false;
    light->outer_rad = outer / DEGREES;
    light->inner_rad = fminf(inner, outer - 0.01f) / DEGREES;
    return true;
}

static void edit_light(struct viewer *v, int index)
{
    struct ag_light_info info;
    char label[160];
    if (ag_scene_get_light(v->desc->scene, index, v->desc->animation, v->time_s, &info) != AG_OK)
        return;
    struct ag_light_desc *light = &info.light;
    snprintf(label, sizeof label, "%d %s %.100s", index, viewer_light_types[light->type],
             info.name ? info.name : "");
    ui_push(index);
    bool changed = false, removed = false;
    if (ui_section(label, index < 2)) {
        changed |= ui_switch("on", &light->enabled);
        changed |= edit_intensity(light->intensity, units[light->type],
                                  light->type == AG_LIGHT_SUN ? 2e5f : 1e5f);
        if (light->type != AG_LIGHT_SUN)
            changed |=
                ui_numbers("position (m)", light->position, 3, 0.01f * v->look.speed, "%.3f");
        if (light->type != AG_LIGHT_POINT) changed |= edit_direction(light->direction);
        if (light->type == AG_LIGHT_SPOT) changed |= edit_cone(light);
        removed = ui_small_button("Remove light");
    }
    ui_pop();
    if (removed) viewer_remove_light(v, index);
    if (changed && !removed && viewer_set_light(v, index, light)) v->gizmo.light = index;
}

// Points and spots are where the camera is; a sun is high.
static void add_light(struct viewer *v, enum ag_light_type type)
{
    struct ag_light_desc light;
    ag_light_desc_default(&light, type);
    for (int i = 0; i < 3; i++) light.position[i] = v->look.eye[i];
    look_forward(&v->look, light.direction);
    if (type == AG_LIGHT_SUN) {
        light.direction[0] = 0.4f;
        light.direction[1] = -1.0f;
        light.direction[2] = 0.3f;
    }
    for (int i = 0; i < 3; i++) light.intensity[i] = type == AG_LIGHT_SUN ? 5e4f : 1000.0f;
    if (viewer_add_light(v, &light)) v->gizmo.light = v->edits.lights.count - 1;
}

static void edit_sky(struct viewer *v)
{
    struct ag_scene_info info;
    if (ag_scene_get_info(v->desc->scene, v->desc->animation, v->time_s, &info) != AG_OK ||
        !ui_section("Sky", false))
        return;
    if (edit_intensity(info.sky, "cd/m²", 5e4f)) viewer_set_sky(v, info.sky);
}

static void choose_environment(struct viewer *v, enum environment_source source)
{
    struct environment_choice choice = v->edits.environment;
    choice.source = source;
    snprintf(choice.path, sizeof choice.path, "%s", v->environment_file);
    viewer_set_environment(v, &choice);
}

static void edit_environment(struct viewer *v)
{
    struct environment_choice choice = v->edits.environment;
    float degrees = choice.rotation * DEGREES;
    if (!ui_section("Environment", false)) return;
    ui_faint("%s", choice.source == ENVIRONMENT_FILE       ? choice.path
                   : choice.source == ENVIRONMENT_OF_SCENE ? "that of the scene"
                                                           : "none");
    if (choice.source != ENVIRONMENT_NONE) {
        bool changed = ui_number("strength", &choice.strength, 0.0f, 100.0f, "%.4g", true);
        if (ui_number("rotation (°)", &degrees, -180.0f, 180.0f, "%.1f", false)) {
            choice.rotation = degrees / DEGREES;
            changed = true;
        }
        ui_tooltip("About the vertical, counterclockwise seen from above.");
        if (changed) viewer_set_environment(v, &choice);
    }
    ui_line("image", v->environment_file, sizeof v->environment_file);
    ui_tooltip("FILE.hdr or FILE.exr: light from all directions, equirectangular, cd/m². The sky's "
               "uniform radiance is added to it.");
    ui_disable(!v->environment_file[0]);
    if (ui_small_button("Use image")) choose_environment(v, ENVIRONMENT_FILE);
    ui_enable();
    ui_same_line();
    if (ui_small_button("None")) choose_environment(v, ENVIRONMENT_NONE);
    if (!v->environments.first) return;
    ui_same_line();
    if (ui_small_button("Of the scene")) choose_environment(v, ENVIRONMENT_OF_SCENE);
}

void panel_light(struct viewer *v)
{
    v->lighting = true;
    overlay_lights(v);
    gizmo_draw(v);
    ui_text("add");
    for (int i = 0; i < 3; i++) {
        ui_same_line();
        if (ui_small_button(viewer_light_types[i])) add_light(v, (enum ag_light_type)i);
    }
    for (int i = 0; i < v->edits.lights.count; i++)
        if (edits_has_light(&v->edits, i)) edit_light(v, i);
    edit_sky(v);
    edit_environment(v);
    panel_paint(v);
}
