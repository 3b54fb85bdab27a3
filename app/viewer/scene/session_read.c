// Applies session files: all that one says, or nothing.
#include "session_file.h"

#include "changes.h"
#include "session_values.h"
#include "viewer/methods/bakes.h"
#include "viewer/methods/running.h"
#include "viewer/operations.h"
#include "viewer/methods/tone.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool apply_methods(struct session_values *s)
{
    struct viewer *v = s->v;
    if (strcmp(s->gi, v->gi) != 0 && !viewer_set_gi(v, s->gi)) return false;
    if (!s->reference && !viewer_set_reference(v, false)) return false;
    if (s->other_gi[0] ? !viewer_set_split(v, s->other_gi) : v->split && !viewer_set_split(v, NULL))
        return false;
    return !s->reference || viewer_set_reference(v, true);
}

static bool apply(struct session_values *s)
{
    struct viewer *v = s->v;
    if (!viewer_restore(v, &s->edits) || !apply_methods(s)) return false;
    viewer_set_layer(v, s->layer);
    if (s->debug_view && !bakes_running(v) && !viewer_set_debug_view(v, s->debug_view))
        return false;
    v->time_s = s->time_s;
    if (!s->look.moved) viewer_set_camera(v, s->scene_camera);
    if (s->look.moved) v->look = s->look;
    v->scene_camera = s->scene_camera;
    v->auto_exposure = s->auto_exposure;
    v->exposure_ev = s->exposure_ev;
    if (!viewer_set_tonemap(v, (enum ag_tonemap)s->tonemap) ||
        !viewer_set_metering(v, (enum ag_metering)s->metering))
        return false;
    v->scale = s->scale;
    v->split_at = s->split_at;
    v->side_by_side = s->side_by_side;
    v->difference = s->difference;
    v->budget_ms = s->budget_ms;
    record_end(v);
    v->path = s->camera_path;
    paint_restore(v, &s->paint);
    viewer_change(v);
    return true;
}

static void take(struct viewer *v, struct session_values *out)
{
    out->v = v;
    out->look = v->look;
    out->scene_camera = v->scene_camera;
    out->time_s = v->time_s;
    out->auto_exposure = v->auto_exposure;
    out->difference = v->difference;
    out->exposure_ev = v->exposure_ev;
    out->scale = v->scale;
    out->split_at = v->split_at;
    out->side_by_side = v->side_by_side;
    out->budget_ms = v->budget_ms;
    out->layer = v->layer;
    out->tonemap = (int)v->tonemap;
    out->metering = (int)v->metering;
    snprintf(out->gi, sizeof out->gi, "%s", v->gi);
    out->debug_view = v->debug_view;
    snprintf(out->other_gi, sizeof out->other_gi, "%s", v->split ? v->other_gi : "");
    out->reference = v->truth != NULL;
    out->camera_path = v->path;
}

static bool use(struct viewer *v, const char *path, json_t *document)
{
    struct session_values *now = calloc(1, sizeof *now), *before = calloc(1, sizeof *before);
    bool done = now && before;
    if (!done) viewer_warn(v, "cannot use %s: out of memory", path);
    if (done) {
        take(v, now);
        take(v, before);
        before->edits = v->edits;
        done = dabs_copy(&before->paint, &v->paint.dabs);
        now->edits = v->edits; // a session says all changes
        edits_forget(&now->edits);
        done = done && session_values_read(now, document, path);
        if (done && !apply(now)) {
            char why[VIEWER_MESSAGE];
            snprintf(why, sizeof why, "%s", v->message);
            apply(before);
            viewer_warn(v, "%s", why);
            done = false;
        }
    }
    if (now) dabs_close(&now->paint);
    if (before) dabs_close(&before->paint);
    free(now);
    free(before);
    return done;
}

bool session_file_scene(const char *path, char *out, size_t size)
{
    json_t *document = json_load_file(path, 0, NULL);
    const char *scene = json_string_value(json_object_get(document, "scene"));
    const bool found = scene && json_object_get(document, "afterglow_session");
    if (found) snprintf(out, size, "%s", scene);
    json_decref(document);
    return found;
}

bool session_file_read(struct viewer *v, const char *path)
{
    json_error_t error;
    json_t *document = json_load_file(path, JSON_REJECT_DUPLICATES, &error);
    if (!document) {
        if (error.line < 0)
            viewer_warn(v, "cannot read %s", path);
        else
            viewer_warn(v, "cannot use %s: line %d: %s", path, error.line, error.text);
        return false;
    }
    const bool done = use(v, path, document);
    json_decref(document);
    if (done) viewer_note(v, "session", -1);
    if (done) viewer_say(v, "read: %s", path);
    return done;
}
