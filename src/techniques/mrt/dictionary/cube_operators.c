// Gather operators of the closed cube and of the cubes with openings.
#include "cube_operators.h"

#include "techniques/mrt/dictionary/gather.h"

static size_t points_of(const struct mrt_cube_operators *o, enum mrt_measure measure)
{
    return measure == MRT_PROBE ? (size_t)(o->probes * o->probes * o->probes)
                                : (size_t)mrt_shape_texels(&o->cube);
}

bool mrt_cube_operators_init(struct host *host, int resolution, int probes, int rays,
                             struct mrt_cube_operators *out)
{
    *out = (struct mrt_cube_operators){ .cube = mrt_cube(resolution, 0), .probes = probes };
    size_t texels = (size_t)mrt_shape_texels(&out->cube);
    for (int m = 0; m < 3; m++) {
        if (!mrt_rays_init(host, (enum mrt_measure)m, rays, &out->rays[m]) ||
            !matrix_f32_init(host, &out->by_measure[m],
                             points_of(out, (enum mrt_measure)m) * (size_t)out->rays[m].values,
                             texels)) {
            mrt_cube_operators_finish(host, out);
            return false;
        }
    }
    return true;
}

void mrt_cube_operators_finish(struct host *host, struct mrt_cube_operators *operators)
{
    for (int m = 0; m < 3; m++) {
        mrt_rays_finish(host, &operators->rays[m]);
        matrix_f32_finish(host, &operators->by_measure[m]);
    }
}

size_t mrt_cube_operators_tasks(const struct mrt_cube_operators *o)
{
    return points_of(o, MRT_IRRADIANCE) + points_of(o, MRT_VECTOR) + points_of(o, MRT_PROBE);
}

vec3s mrt_probe_position(int probes, int i)
{
    float n = (float)probes;
    return vec3_of(((float)(i % probes) + 0.5f) / n - 0.5f,
                   ((float)(i / probes % probes) + 0.5f) / n - 0.5f,
                   ((float)(i / (probes * probes)) + 0.5f) / n - 0.5f);
}

void mrt_cube_operators_run(struct mrt_cube_operators *o, size_t task)
{
    enum mrt_measure measure = MRT_IRRADIANCE;
    while (task >= points_of(o, measure)) task -= points_of(o, measure++);
    struct mrt_point at =
        measure == MRT_PROBE
            ? (struct mrt_point){ mrt_probe_position(o->probes, (int)task), glms_mat3_identity() }
            : mrt_shape_texel(&o->cube, (int)task);
    struct matrix_f32 *to = &o->by_measure[measure];
    size_t first = task * (size_t)o->rays[measure].values;
    mrt_gather(&o->cube, at, &o->rays[measure], to->at + first * to->stride, to->stride);
}

// The texel of the closed cube at which a face of `shape` begins, in order of its faces.
static int present_faces(const struct mrt_shape *shape, size_t first[CUBE_FACES])
{
    int count = 0;
    for (int f = 0; f < CUBE_FACES; f++)
        if (!(shape->missing >> f & 1u))
            first[count++] = (size_t)(f * shape->resolution * shape->resolution);
    return count;
}

bool mrt_cube_operator_of(struct host *host, const struct mrt_cube_operators *closed,
                          enum mrt_measure measure, const struct mrt_shape *shape,
                          struct matrix_f64 *out)
{
    size_t faces[CUBE_FACES], in_face = (size_t)(shape->resolution * shape->resolution);
    const struct matrix_f32 *all = &closed->by_measure[measure];
    present_faces(shape, faces);
    bool whole = measure == MRT_PROBE;
    size_t values = (size_t)closed->rays[measure].values, texels = (size_t)mrt_shape_texels(shape);
    if (!matrix_f64_init(host, out, whole ? all->rows : texels * values, texels)) return false;
    for (size_t r = 0; r < out->rows; r++) {
        size_t texel = r / values;
        size_t from = whole ? r : (faces[texel / in_face] + texel % in_face) * values + r % values;
        for (size_t c = 0; c < texels; c++)
            out->at[r * out->stride + c] =
                (double)all->at[from * all->stride + faces[c / in_face] + c % in_face];
    }
    return true;
}
