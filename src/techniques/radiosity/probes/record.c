// The passes of probes.
#include "techniques/radiosity/probes/probes.h"

#include "techniques/radiosity/probes/probes_shared.h"
#include "techniques/radiosity/radiosity_shared.h"

void radiosity_probes_record_gather(struct radiosity_probes *p, struct gpu_cmd *cmd,
                                    const struct frame_view *view, gpu_image radiosity,
                                    const struct light_map_emission *emission)
{
    static const vec4s NONE = { { 0.0f, 0.0f, 0.0f, 0.0f } };
    const uint32_t columns = emission ? emission->count : 0;
    const vec4s *weights = columns > 0 ? emission->weights : &NONE;
    const size_t bytes = (columns > 0 ? columns : 1) * sizeof *weights;
    const struct radiosity_probe_gather_push push = { p->volume.grid, p->count, p->entries,
                                                      columns };
    gpu_scope_begin(cmd, "probes");
    gpu_dispatch(cmd, p->gather,
                 GPU_BIND(view->constants_binding, { .name = "probe_table", .buffer = p->table },
                          { .name = "probe_factors", .buffer = p->factors },
                          gpu_transient(cmd, "emission_weights", weights, bytes),
                          { .name = "probe_emission", .buffer = p->emission },
                          { .name = "radiosity_sent", .image = radiosity },
                          { .name = "volume", .image = p->volume.image }),
                 &push, sizeof push, gpu_groups(push.probes, RADIOSITY_LOCAL), 1, 1);
    gpu_scope_end(cmd);
    p->fresh = true;
}
