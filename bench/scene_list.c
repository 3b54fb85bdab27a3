#include "scene_list.h"

#include <regex.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_SIZE = 1024 };
static const float DEFAULT_FOV_DEG = 45.0f;

static bool read3(const char *text, float out[3])
{
    char rest;
    return sscanf(text, "%f,%f,%f%c", &out[0], &out[1], &out[2], &rest) == 3;
}

static bool read_sun(const char *text, struct listed_scene *s)
{
    char rest;
    s->has_sun = true;
    return sscanf(text, "sun:%f,%f,%f:%f,%f,%f%c", &s->direction[0], &s->direction[1],
                  &s->direction[2], &s->lux[0], &s->lux[1], &s->lux[2], &rest) == 6;
}

static bool read_option(const char *name, const char *value, struct listed_scene *s)
{
    if (strcmp(name, "--light") == 0) return read_sun(value, s);
    if (strcmp(name, "--sky") == 0) return (s->has_sky = true), read3(value, s->sky);
    if (strcmp(name, "--eye") == 0) return (s->has_eye = true), read3(value, s->eye);
    if (strcmp(name, "--target") == 0) return read3(value, s->target);
    char rest;
    return strcmp(name, "--fov") == 0 && sscanf(value, "%f%c", &s->fov_deg, &rest) == 1;
}

// The path of a built-in scene (@name), of a file in $AFTERGLOW_SCENES (SCENES/name), or of one
// beside the list.
static bool set_path(const char *list, const char *path, struct listed_scene *s)
{
    static const char PREFIX[] = "SCENES/";
    const size_t size = sizeof s->path;
    if (path[0] == '@') return snprintf(s->path, size, "%s", path) < (int)size;
    if (strncmp(path, PREFIX, strlen(PREFIX)) != 0) {
        const char *slash = strrchr(list, '/');
        const int length = slash ? (int)(slash + 1 - list) : 0;
        return snprintf(s->path, size, "%.*s%s", length, list, path) < (int)size;
    }
    const char *folder = getenv("AFTERGLOW_SCENES");
    return folder && snprintf(s->path, size, "%s/%s", folder, path + strlen(PREFIX)) < (int)size;
}

// False for a comment, an unknown option, and a file without its folder.
static bool read_line(const char *list, char *line, struct listed_scene *s)
{
    static const char SPACE[] = " \t\r\n";
    *s = (struct listed_scene){ .fov_deg = DEFAULT_FOV_DEG };
    char *rest, *name = strtok_r(line, SPACE, &rest);
    if (!name || name[0] == '#' || !strtok_r(NULL, SPACE, &rest)) return false;
    char *path = strtok_r(NULL, SPACE, &rest);
    snprintf(s->name, sizeof s->name, "%.*s", (int)sizeof s->name - 1, name);
    if (!path || !set_path(list, path, s)) return false;
    for (char *option; (option = strtok_r(NULL, SPACE, &rest));) {
        char *value = strtok_r(NULL, SPACE, &rest);
        if (value && read_option(option, value, s)) continue;
        fprintf(stderr, "%s: %s is not understood\n", s->name, option);
        return false;
    }
    return true;
}

// Whether the name matches from its start.
static bool matches(const regex_t *regex, const char *name)
{
    regmatch_t match;
    return regexec(regex, name, 1, &match, 0) == 0 && match.rm_so == 0;
}

enum ag_result scene_list_each(const char *path, const char *text,
                               enum ag_result (*each)(void *user, const struct listed_scene *scene),
                               void *user)
{
    regex_t regex;
    char line[LINE_SIZE];
    struct listed_scene scene;
    enum ag_result result = AG_OK;
    FILE *file = fopen(path, "r");
    if (!file || regcomp(&regex, text, REG_EXTENDED) != 0) {
        fprintf(stderr, "%s: cannot be read, or %s is not a regular expression\n", path, text);
        if (file) fclose(file);
        return AG_ERROR_ARGUMENT;
    }
    while (result == AG_OK && fgets(line, sizeof line, file))
        if (read_line(path, line, &scene) && matches(&regex, scene.name))
            result = each(user, &scene);
    regfree(&regex);
    fclose(file);
    return result;
}

enum ag_result listed_scene_light(const struct listed_scene *s, struct ag_scene *scene)
{
    if (!s->has_sun && !s->has_sky) return ag_scene_add_default_lighting(scene, NULL);
    enum ag_result result = AG_OK;
    struct ag_light_desc sun;
    ag_light_desc_default(&sun, AG_LIGHT_SUN);
    memcpy(sun.direction, s->direction, sizeof sun.direction);
    memcpy(sun.intensity, s->lux, sizeof sun.intensity);
    if (s->has_sun) result = ag_scene_add_light(scene, &sun, NULL);
    if (result == AG_OK && s->has_sky) result = ag_scene_set_sky(scene, s->sky);
    return result;
}

enum ag_result listed_scene_camera(const struct listed_scene *s, struct ag_scene *scene,
                                   struct ag_camera *out)
{
    static const float RAD_PER_DEG = 3.14159265f / 180.0f;
    if (!s->has_eye) return ag_scene_default_camera(scene, 0, 0.0, out, NULL);
    return ag_scene_look_at(scene, s->eye, s->target, s->fov_deg * RAD_PER_DEG, out);
}
