// Reports of completed frames: read back without a wait, one slot for each pending frame.
#include "frame/frame_state.h"

#include "frame/composite/exposure_shared.h"

#include <stddef.h>

enum {
    SLOT_COUNT =
        sizeof(((struct frame_reports *)0)->slots) / sizeof(((struct frame_reports *)0)->slots[0])
};

struct report_values {
    uint32_t id[2]; // a texel of FRAME_ID
    struct exposure_values exposure;
};

bool reports_init(struct frame *f)
{
    for (int i = 0; i < SLOT_COUNT; i++)
        if (!gpu_readback_create(f->gpu, "frame.report", sizeof(struct report_values),
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
        struct report_values values;
        struct frame_report report = f->reports.slots[i].report;
        if (!gpu_readback_poll(f->gpu, &f->reports.slots[i].readback, &values, sizeof values))
            continue;
        report.exposure_ev = values.exposure.ev;
        if (report.number > f->reports.newest.number) f->reports.newest = report;
        struct frame_pick pick = f->reports.slots[i].pick;
        pick.instance = values.id[0];
        pick.triangle = values.id[1];
        if (pick.number > f->reports.newest_pick.number) f->reports.newest_pick = pick;
    }
}

void reports_record(struct frame *f, struct gpu_cmd *cmd, const struct frame_input *input)
{
    collect(f);
    for (int i = 0; i < SLOT_COUNT; i++) {
        struct gpu_readback *readback = &f->reports.slots[i].readback;
        if (readback->serial != 0) continue;
        f->reports.slots[i].report =
            (struct frame_report){ .number = f->number,
                                   .radiance_scale = f->constants.radiance_scale };
        f->reports.slots[i].pick =
            (struct frame_pick){ input->pick ? f->number : 0, input->pick_x, input->pick_y, 0, 0 };
        if (input->pick)
            gpu_readback_copy_texel(cmd, readback, offsetof(struct report_values, id),
                                    f->layers[FRAME_ID], input->pick_x, input->pick_y);
        gpu_readback_copy(cmd, readback, offsetof(struct report_values, exposure),
                          f->exposure.state, 0, sizeof(struct exposure_values));
        return;
    }
}

bool frame_newest_report(struct frame *f, struct frame_report *out)
{
    collect(f);
    *out = f->reports.newest;
    return out->number > 0;
}

bool frame_newest_pick(struct frame *f, struct frame_pick *out)
{
    collect(f);
    *out = f->reports.newest_pick;
    return out->number > 0;
}

uint64_t frame_number(const struct frame *f)
{
    return f->number;
}
