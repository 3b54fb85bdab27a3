// The camera's path: its keys, and the flight recorded to images.
#include "panel.h"
#include "viewer/operations.h"

#include <stdio.h>

static void go_to(struct viewer *v, int key)
{
    struct path one = v->path;
    one.keys[0] = v->path.keys[key];
    one.count = 1;
    path_at(&one, 0, &v->look);
    v->look.moved = true;
    viewer_change(v);
}

static void list_keys(struct viewer *v)
{
    for (int i = 0; i < v->path.count; i++) {
        const struct path_key *key = &v->path.keys[i];
        ui_push(i);
        if (ui_small_button("go")) go_to(v, i);
        ui_same_line();
        const bool removed = ui_small_button("x");
        ui_tooltip("Remove this key");
        ui_same_line();
        ui_text("%d: %.2f, %.2f, %.2f", i, (double)key->eye[0], (double)key->eye[1],
                (double)key->eye[2]);
        ui_pop();
        if (removed) path_remove(&v->path, i--);
    }
}

static void show_progress(struct viewer *v)
{
    char text[64];
    const int total = path_frames(&v->path);
    snprintf(text, sizeof text, "image %d of %d", v->record.image + 1, total);
    ui_progress((double)v->record.image / total, text);
    if (ui_button("Stop")) record_end(v);
}

void panel_path(struct viewer *v)
{
    if (v->record.runs) {
        show_progress(v);
        return;
    }
    if (ui_button("Add this view") && !path_add(&v->path, &v->look))
        viewer_warn(v, "the path has %d keys already", PATH_KEYS);
    ui_tooltip("The camera flies through these views along a smooth curve.");
    list_keys(v);
    ui_number("seconds from key to key", &v->path.seconds, 0.1f, 60.0f, "%.1f", true);
    ui_integer("images a second", &v->path.fps, 1, 120);
    ui_integer("frames an image", &v->record.frames_each, 1, 64);
    ui_tooltip("Methods with a history of frames need some for each image.");
    ui_line("folder", v->record.folder, sizeof v->record.folder);
    ui_disable(v->path.count == 0);
    if (ui_button("Record")) record_begin(v);
    ui_enable();
    ui_same_line();
    ui_faint("%d images", path_frames(&v->path));
}
