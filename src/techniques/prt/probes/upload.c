// From a bake, which is untrusted, to the tables of probes.
#include "techniques/prt/probes/probes.h"

#include "bake/tensors.h"
#include "techniques/common/light_map/table.h"
#include "techniques/common/probes/rays.h"
#include "techniques/prt/probes/probes_shared.h"
#include "techniques/prt/prt_state.h"

struct content {
    const uint16_t *matrix, *depth;
    const float *emitted;
    const vec4s *place;
    uint32_t *owner; // of each probe: the one whose light it shows
};

static bool find_tensors(const struct prt_probes *p, struct host *host, uint64_t numbers,
                         const struct tensors *bake, struct content *c)
{
    const uint64_t n = p->count, rows = p->rows;
#define EXPECT(...) TENSORS_EXPECT(host, bake, __VA_ARGS__)
    return (c->matrix = EXPECT(PRT_PROBE_MATRIX, TENSOR_F16, n, rows, numbers)) &&
           (c->emitted = EXPECT(PRT_PROBE_EMITTED, TENSOR_F32, n, rows, 3)) &&
           (c->place = EXPECT(PRT_PROBE_PLACE, TENSOR_F32, n, 4)) &&
           (c->depth = EXPECT(PRT_PROBE_DEPTH, TENSOR_F16, n, PROBE_DEPTHS, 2));
#undef EXPECT
}

static bool upload_matrices(struct prt_probes *p, struct host *host, struct gpu *gpu,
                            const struct prt_options *options, const struct content *c)
{
    const size_t probes = p->count, rows = p->rows, numbers = prt_dimension(options);
    const size_t count = prt_row_entries(options) * rows * probes;
    uint16_t *table =
        host_alloc(host, light_map_table_capacity(count), sizeof(uint16_t[PRT_VECTOR_HALVES]));
    for (size_t i = 0; table && i < probes; i++)
        for (size_t row = 0; row < rows; row++)
            for (size_t k = 0; k < numbers; k++)
                *prt_table_half(table, PRT_VECTOR_HALVES, rows * probes, row * probes + i, k) =
                    c->matrix[(c->owner[i] * rows + row) * numbers + k];
    return light_map_table_upload(host, gpu, "probe_matrices", GPU_RGBA32U, table, count,
                                  &p->matrices);
}

static bool upload_table(struct prt_probes *p, struct host *host, struct gpu *gpu,
                         const struct content *c)
{
    const size_t probes = p->count, rows = p->rows, count = (PRT_PROBE_LIGHT + rows) * probes;
    vec4s *table = host_alloc(host, light_map_table_capacity(count), sizeof *table);
    for (size_t i = 0; table && i < probes; i++) {
        table[PRT_PROBE_OFFSET * probes + i] =
            probe_offset(p->volume.grid, (uint32_t)i, c->place[i]);
        for (size_t row = 0; row < rows; row++) {
            const float *from = c->emitted + 3 * (c->owner[i] * rows + row);
            table[(PRT_PROBE_LIGHT + row) * probes + i] =
                vec4_of(vec3_of(from[0], from[1], from[2]), 0.0f);
        }
    }
    return light_map_table_upload(host, gpu, "probe_table", GPU_RGBA32F, table, count, &p->table);
}

bool prt_probes_upload(struct prt_probes *p, struct host *host, struct gpu *gpu, struct box3 bounds,
                       const struct prt_options *options, const struct tensors *bake)
{
    struct content c = { .owner = NULL };
    p->volume.grid = probe_grid_around(bounds, options->probe_spacing, prt_probes_most(options));
    p->count = probe_grid_count(p->volume.grid);
    p->rows = prt_probe_rows(options);
    const bool ok = find_tensors(p, host, prt_dimension(options), bake, &c) &&
                    (c.owner = probe_owners(host, p->volume.grid, c.place)) &&
                    upload_matrices(p, host, gpu, options, &c) && upload_table(p, host, gpu, &c) &&
                    probe_depth_create(host, gpu, p->count, c.depth, &p->volume.depth);
    host_free(host, c.owner);
    return ok;
}
