// Gather operators of the closed cube and of the cubes with openings.
#include "cube_operators.h"

static const size_t VALUES[] = { 1, MRT_VECTOR_COEFFICIENTS, MRT_PROBE_COEFFICIENTS };

struct mrt_point mrt_gather_point(const struct mrt_shape *shape, int probes,
                                  enum mrt_measure measure, int i)
{
    if (measure != MRT_PROBE) return mrt_shape_texel(shape, i);
    float n = (float)probes;
    vec3s at = vec3_of(((float)(i % probes) + 0.5f) / n, ((float)(i / probes % probes) + 0.5f) / n,
                       ((float)(i / (probes * probes)) + 0.5f) / n);
    if (shape->kind != MRT_CUBE)
        at = tube_inside((enum tube_bend)((int)shape->kind - MRT_TUBE), at);
    else
        at = glms_vec3_subs(at, 0.5f);
    return (struct mrt_point){ at, glms_mat3_identity() };
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
    size_t values = VALUES[measure], texels = (size_t)mrt_shape_texels(shape);
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
