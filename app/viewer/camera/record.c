#include "record.h"

#include "viewer/command.h"
#include "viewer/operations.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

bool record_begin(struct viewer *v)
{
    struct record *record = &v->record;
    if (v->path.count == 0) {
        viewer_warn(v, "the camera's path has no keys: add some");
        return false;
    }
    if (mkdir(record->folder, 0777) != 0 && errno != EEXIST) {
        viewer_warn(v, "cannot create %s: %s", record->folder, strerror(errno));
        return false;
    }
    record->runs = true;
    record->failed = false;
    record->image = 0;
    record->left = SETTLE_FRAMES; // the first begins without a history
    record->start_s = v->time_s;
    return true;
}

void record_end(struct viewer *v)
{
    if (!v->record.runs) return;
    v->record.runs = false;
    viewer_say(v, "%d images in %s", v->record.image, v->record.folder);
}

void record_place(struct viewer *v)
{
    if (!v->record.runs) return;
    path_at(&v->path, v->record.image, &v->look);
    v->look.moved = true;
    if (v->playing) v->time_s = v->record.start_s + (double)v->record.image / v->path.fps;
    viewer_change(v);
}

void record_take(struct viewer *v)
{
    struct record *record = &v->record;
    char file[600];
    if (!record->runs || --record->left > 0) return;
    snprintf(file, sizeof file, "%s/%05d.png", record->folder, record->image);
    if (!viewer_write(v, file)) {
        record->runs = false;
        record->failed = true;
        return;
    }
    record->image++;
    record->left = record->frames_each;
    if (record->image >= path_frames(&v->path)) record_end(v);
}
