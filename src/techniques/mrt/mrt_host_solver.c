// The solver on the CPU within a frame.
#include "mrt_host_solver.h"

#include <string.h>

void mrt_host_solver_set_reflectance(struct mrt_host_solver *solver,
                                     const struct mrt_geometry_texel *geometry)
{
    for (int i = 0; i < solver->texels; i++)
        solver->reflectance[i] = mrt_shown_reflectance(&geometry[i]);
}

bool mrt_host_solver_init(struct mrt_host_solver *out, struct host *host, struct gpu *gpu,
                          const struct mrt_level *level, const struct mrt_geometry_texel *geometry)
{
    const size_t texels = (size_t)level->first_texel[level->map->count];
    *out = (struct mrt_host_solver){ .host = host, .gpu = gpu, .texels = (int)texels };
    out->reflectance = host_alloc(host, texels, sizeof *out->reflectance);
    out->direct = host_alloc(host, texels, sizeof *out->direct);
    out->radiosity = host_alloc(host, texels, sizeof *out->radiosity);
    out->irradiance = host_alloc(host, texels, sizeof *out->irradiance);
    if (!out->reflectance || !out->direct || !out->radiosity || !out->irradiance) return false;
    mrt_host_solver_set_reflectance(out, geometry);
    for (int i = 0; i < 2; i++)
        if (!gpu_readback_create(gpu, "direct_readback", texels * sizeof *out->direct,
                                 &out->slots[i].readback))
            return false;
    return mrt_solver_init(host, level, &out->solver);
}

void mrt_host_solver_finish(struct mrt_host_solver *solver)
{
    if (!solver->host) return;
    for (int i = 0; i < 2; i++) gpu_readback_destroy(solver->gpu, &solver->slots[i].readback);
    mrt_solver_finish(&solver->solver);
    host_free(solver->host, solver->reflectance);
    host_free(solver->host, solver->direct);
    host_free(solver->host, solver->radiosity);
    host_free(solver->host, solver->irradiance);
    *solver = (struct mrt_host_solver){ 0 };
}

void mrt_host_solver_forget(struct mrt_host_solver *solver)
{
    solver->solved = false;
    for (int i = 0; i < 2; i++) solver->slots[i].readback.serial = 0;
}

// weight: of the irradiance that is reflected again.
static void bounce(struct mrt_host_solver *s, float weight)
{
    for (int i = 0; i < s->texels; i++) {
        vec3s again = glms_vec3_mul(s->reflectance[i], s->irradiance[i]);
        s->radiosity[i] = glms_vec3_muladds(again, weight, s->direct[i]);
    }
    mrt_solve(&s->solver, &s->radiosity[0].x, &s->irradiance[0].x);
}

static void solve(struct mrt_host_solver *s, const struct mrt_host_slot *slot,
                  const struct mrt_host_frame *frame)
{
    // Last irradiance in the scale of this radiosity.
    const float rescale = frame->feedback && s->solved ? slot->scale / s->scale : 0.0f;
    for (int i = 0; i < frame->bounces; i++)
        bounce(s, i == 0 ? rescale : i == 1 ? frame->rest : 1.0f);
    s->newest = slot->frame;
    s->scale = slot->scale;
    s->solved = true;
}

// In the scale of this frame. `direct` has been used and serves as memory.
static void upload(struct mrt_host_solver *s, struct gpu_cmd *cmd, float rescale,
                   const vec3s *values, gpu_buffer to)
{
    const size_t bytes = (size_t)s->texels * sizeof *values;
    for (int i = 0; i < s->texels; i++) s->direct[i] = glms_vec3_scale(values[i], rescale);
    const struct gpu_binding data = gpu_transient(cmd, "light", s->direct, bytes);
    gpu_copy_buffer(cmd, to, 0, data.buffer, data.offset, bytes);
}

static void upload_solution(struct mrt_host_solver *s, struct gpu_cmd *cmd,
                            const struct mrt_host_frame *frame)
{
    const float rescale = frame->radiance_scale / s->scale;
    upload(s, cmd, rescale, s->irradiance, frame->irradiance);
    if (frame->radiosity.id) upload(s, cmd, rescale, s->radiosity, frame->radiosity);
}

// Into `direct`: the newest that is due and complete; NULL: none.
static const struct mrt_host_slot *read_newest(struct mrt_host_solver *s, uint64_t index)
{
    const size_t bytes = (size_t)s->texels * sizeof *s->direct;
    const struct mrt_host_slot *newest = NULL;
    const int older = s->slots[1].frame < s->slots[0].frame;
    for (int i = 0; i < 2; i++) {
        struct mrt_host_slot *slot = &s->slots[older ^ i];
        const bool due = slot->frame + MRT_HOST_DELAY <= index;
        if (due && gpu_readback_poll(s->gpu, &slot->readback, s->direct, bytes)) newest = slot;
    }
    return newest;
}

// A slot that the GPU has not completed yet is left alone.
static void start_copy(struct mrt_host_solver *s, struct gpu_cmd *cmd,
                       const struct mrt_host_frame *frame)
{
    struct mrt_host_slot *slot = &s->slots[frame->index % 2];
    if (slot->readback.serial != 0) return;
    gpu_readback_copy(cmd, &slot->readback, 0, frame->direct, 0,
                      (size_t)s->texels * sizeof *s->direct);
    slot->frame = frame->index;
    slot->scale = frame->radiance_scale;
}

bool mrt_host_solver_record(struct mrt_host_solver *s, struct gpu_cmd *cmd,
                            const struct mrt_host_frame *frame)
{
    const struct mrt_host_slot *slot = read_newest(s, frame->index);
    if (slot) solve(s, slot, frame);
    start_copy(s, cmd, frame);
    if (s->solved) upload_solution(s, cmd, frame);
    return s->solved;
}
