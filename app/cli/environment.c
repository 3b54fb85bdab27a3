#include "environment.h"

#include "values.h"

#include <math.h>
#include <string.h>

static const char SUN_SKY[] = "sun-sky";

// ---- members

// The members of a value: name and number.
static bool set_member(struct environment_value *v, const char *name, double number,
                       const char **why)
{
    const bool sky = !v->path[0];
    if (strcmp(name, "rotation") == 0) {
        v->use.rotation = radians(fmod(number, 360.0));
        return true;
    }
    if (strcmp(name, "turn") == 0) {
        v->turn = radians(fmod(number, 360.0));
        return true;
    }
    if (strcmp(name, "strength") == 0) {
        *why = "strength must be 0 to 1e6";
        v->use.strength = (float)number;
        return number >= 0.0 && number <= 1e6;
    }
    if (sky && strcmp(name, "elevation") == 0) {
        *why = "elevation must be -90 to 90 degrees";
        v->sky.elevation = radians(number);
        return fabs(number) <= 90.0;
    }
    if (sky && strcmp(name, "azimuth") == 0) {
        v->sky.azimuth = radians(fmod(number, 360.0));
        return true;
    }
    if (sky && strcmp(name, "turbidity") == 0) {
        *why = "turbidity must be 2 to 10";
        v->sky.turbidity = (float)number;
        return number >= 2.0 && number <= 10.0;
    }
    *why = sky ? "its members are elevation, azimuth, turbidity, rotation, strength and turn"
               : "its members are rotation, strength and turn";
    return false;
}

// "name=number,…"
static bool set_members(struct environment_value *v, const char *text, const char **why)
{
    for (bool more = true; more;) {
        char member[64];
        const char *end = strchr(text, ',');
        const size_t length = end ? (size_t)(end - text) : strlen(text);
        *why = "members are written name=number, with commas between";
        if (length >= sizeof member) return false;
        memcpy(member, text, length);
        member[length] = 0;
        char *equals = strchr(member, '=');
        double number;
        if (!equals || !value_number(equals + 1, &number)) return false;
        *equals = 0;
        if (!set_member(v, member, number, why)) return false;
        more = end;
        text += length + 1;
    }
    return true;
}

// Members follow the last colon after which there is an equals sign: paths may have colons.
static const char *members_of(const char *text)
{
    const char *colon = strrchr(text, ':');
    return colon && strchr(colon, '=') && !strchr(colon, '/') ? colon : NULL;
}

bool value_environment(const char *text, struct environment_value *out, const char **why)
{
    const char *colon = members_of(text);
    const size_t length = colon ? (size_t)(colon - text) : strlen(text);
    ag_sun_sky_desc_default(&out->sky);
    ag_environment_use_default(&out->use);
    out->turn = 0.0f;
    *why = "it must be FILE.hdr, FILE.exr or sun-sky, with members after a colon";
    if (length == 0 || length >= sizeof out->path) return false;
    memcpy(out->path, text, length);
    out->path[length] = 0;
    if (strcmp(out->path, SUN_SKY) == 0)
        out->path[0] = 0;
    else if (!has_extension(out->path, "hdr") && !has_extension(out->path, "exr"))
        return false;
    return !colon || set_members(out, colon + 1, why);
}

enum ag_result environment_make(struct ag_context *context, const struct environment_value *value,
                                struct ag_environment **out)
{
    return value->path[0] ? ag_environment_load(context, value->path, out)
                          : ag_environment_from_sun_sky(context, &value->sky, out);
}

enum ag_result environment_turn(struct ag_scene *scene, const struct ag_environment *environment,
                                const struct environment_value *value, int frame)
{
    struct ag_environment_use use = value->use;
    use.rotation += (float)frame * value->turn;
    return ag_scene_set_environment(scene, environment, &use);
}
