// Objects and passes of probes.
#include "techniques/prt/probes/probes.h"

#include "techniques/common/light_map/table.h"
#include "techniques/prt/probes/probes_shared.h"
#include "techniques/prt/prt_shared.h"

#include "technique_shaders.h"

#include <stddef.h>

void prt_probes_list(const struct prt_probes *p, size_t base, const struct prt_options *options,
                     uint32_t consts, struct gpu_objects *out)
{
#define MEMBER(thing) offsetof(struct prt_probes, thing)
    const struct gpu_image_desc volume =
        probe_volume_desc(NULL, p->volume.grid, FRAME_PROBE_SLABS + 1);
    GPU_ADD(out, base, { GPU_IMAGE, "probe_volume", MEMBER(volume.image), .image = volume },
            { GPU_IMAGE, "probe_radiance", MEMBER(volume.radiance),
              .image = light_map_table(GPU_RGBA16F, (size_t)p->rows * p->count) },
            { GPU_PIPELINE, "probes", MEMBER(gather), .shader = &shader_prt_probes_gather_comp,
              .consts = consts });
    probe_apply_list(base + MEMBER(apply),
                     !options->specular ? PROBE_APPLY_DIFFUSE
                     : options->glossy  ? PROBE_APPLY_RADIANCE
                                        : PROBE_APPLY_SPECULAR,
                     out);
    // Created by prt_probes_upload.
    GPU_ADD(out, base, { GPU_IMAGE, .member = MEMBER(matrices) },
            { GPU_IMAGE, .member = MEMBER(table) }, { GPU_IMAGE, .member = MEMBER(volume.depth) });
#undef MEMBER
}

void prt_probes_record_gather(struct prt_probes *p, struct gpu_cmd *cmd,
                              const struct prt_light *light, float emitters)
{
    const struct prt_probes_push push = { p->volume.grid, p->count, p->rows, emitters };
    if (p->fresh) return;
    gpu_scope_begin(cmd, "probes");
    gpu_dispatch(cmd, p->gather,
                 GPU_BIND(gpu_transient(cmd, "prt_light_block", light, sizeof *light),
                          { .name = "prt_transfer", .image = p->matrices },
                          { .name = "probe_table", .image = p->table },
                          { .name = "volume", .image = p->volume.image },
                          { .name = "probe_radiance", .image = p->volume.radiance }),
                 &push, sizeof push, gpu_groups(p->count, PRT_PROBES_LOCAL), 1, 1);
    gpu_scope_end(cmd);
    p->fresh = true;
}
