// Irradiance 0 at every pixel: direct light alone, the baseline of comparisons.
#include "techniques/none/none.h"

static void none_record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    (void)state;
    gpu_scope_begin(cmd, "clear");
    gpu_clear_image(cmd, view->layers[FRAME_IRRADIANCE],
                    (const float[4]){ 0.0f, 0.0f, 0.0f, 1.0f });
    gpu_scope_end(cmd);
}

const struct technique technique_none = {
    .name = "none",
    .title = "no indirect light",
    .paper = "none",
    .role = ROLE_SOURCE,
    .capabilities = CAN_MOVE_GEOMETRY | CAN_MOVE_LIGHTS,
    .needs = FRAME_WRITES_IRRADIANCE,
    .record = none_record,
};
