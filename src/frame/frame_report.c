// Reports of completed frames: read back without a wait, one slot for each pending frame.
#include "frame/frame_state.h"

#include "frame/composite/exposure_shared.h"

enum {
    SLOT_COUNT =
        sizeof(((struct frame_reports *)0)->slots) / sizeof(((struct frame_reports *)0)->slots[0])
};

bool reports_init(struct frame *f)
{
    for (int i = 0; i < SLOT_COUNT; i++)
        if (!gpu_readback_create(f->gpu, "frame.report", sizeof(struct exposure_values),
                                 &f->reports.slots[i].readback))
            return false;
    return true;
}

void reports_finish(struct frame *f)
{
    for (int i = 0; i < SLOT_COUNT; i++)
        gpu_readback_destroy(f->gpu, &f->reports.slots[i].readback);
}

static void collect(struct frame *f)
{
    for (int i = 0; i < SLOT_COUNT; i++) {
        struct exposure_values values;
        struct frame_report report = f->reports.slots[i].report;
        if (!gpu_readback_poll(f->gpu, &f->reports.slots[i].readback, &values, sizeof values))
            continue;
        report.exposure_ev = values.ev;
        if (report.number > f->reports.newest.number) f->reports.newest = report;
    }
}

void reports_record(struct frame *f, struct gpu_cmd *cmd)
{
    collect(f);
    for (int i = 0; i < SLOT_COUNT; i++) {
        struct gpu_readback *readback = &f->reports.slots[i].readback;
        if (readback->serial != 0) continue;
        f->reports.slots[i].report =
            (struct frame_report){ .number = f->number,
                                   .radiance_scale = f->constants.radiance_scale };
        gpu_readback_copy(cmd, readback, 0, f->exposure.state, 0, sizeof(struct exposure_values));
        return;
    }
}

bool frame_newest_report(struct frame *f, struct frame_report *out)
{
    collect(f);
    *out = f->reports.newest;
    return out->number > 0;
}

uint64_t frame_number(const struct frame *f)
{
    return f->number;
}
