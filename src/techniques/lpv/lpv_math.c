// Faces of neighbour cells, their solid angles in closed form, and the propagation step as a
// matrix.
//
// Differs from Martin 2012, eq. 3.3 in the weight: with Ω/4π and a lobe of unit peak a step keeps a
// quarter of the flux. Here the flux through a face is Φ = Ω I(ω) and the re-projected lobe has the
// flux Φ (for a clamped cosine: Φ/π (cosθ)₊), so that the solid angles' sum of 4π makes the step
// conserve flux. And the lobe's width is a parameter, see README.md.
#include "techniques/lpv/lpv_math.h"

#include "core/sh.h"

#include <math.h>

vec3s lpv_direction(int direction)
{
    vec3s out = vec3_of(0, 0, 0);
    out.raw[direction / 2] = direction % 2 == 0 ? 1.0f : -1.0f;
    return out;
}

// Of the rectangle [0,x] × [0,y]: ∫∫ d / (u² + v² + d²)^(3/2) du dv. atan2 is right for d → 0 too.
static double corner_sr(double x, double y, double distance)
{
    return atan2(x * y, distance * sqrt(x * x + y * y + distance * distance));
}

double lpv_rectangle_sr(double x0, double x1, double y0, double y1, double distance)
{
    return corner_sr(x1, y1, distance) - corner_sr(x0, y1, distance) - corner_sr(x1, y0, distance) +
           corner_sr(x0, y0, distance);
}

void lpv_faces(int direction, struct lpv_face out[LPV_FACES])
{
    // In units of the cell, from the source's centre: the neighbour's far face lies at 1.5, its
    // side faces span 0.5 … 1.5 along the direction and stand at 0.5 across it.
    const vec3s forward = lpv_direction(direction);
    out[0] = (struct lpv_face){ forward, forward, lpv_rectangle_sr(-0.5, 0.5, -0.5, 0.5, 1.5) };
    int count = 1;
    for (int side = 0; side < LPV_DIRECTIONS; side++) {
        if (side / 2 == direction / 2) continue;
        const vec3s normal = lpv_direction(side);
        const vec3s centre = glms_vec3_add(forward, glms_vec3_scale(normal, 0.5f));
        out[count++] = (struct lpv_face){ glms_vec3_normalize(centre), normal,
                                          lpv_rectangle_sr(0.5, 1.5, -0.5, 0.5, 0.5) };
    }
}

void lpv_lobe_coefficients(vec3s axis, float mean_cosine, float out[4])
{
    sh_eval(2, axis, out); // ∫ (1 + 3 g cosθ)/4π Y: band 0 Y00, band 1 g Y1m(axis)
    for (int i = 1; i < 4; i++) out[i] *= mean_cosine;
}

void lpv_step_matrix(int direction, enum lpv_lobe lobe, float mean_cosine, double out[4][4])
{
    struct lpv_face faces[LPV_FACES];
    lpv_faces(direction, faces);
    for (int i = 0; i < 16; i++) out[i / 4][i % 4] = 0.0;
    for (int f = 0; f < LPV_FACES; f++) {
        float seen[4], sent[4];
        sh_eval(2, faces[f].direction, seen);
        lpv_lobe_coefficients(lobe == LPV_LOBE_NORMAL ? faces[f].normal : faces[f].direction,
                              mean_cosine, sent);
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < 4; j++)
                out[i][j] += faces[f].solid_angle_sr * (double)sent[i] * (double)seen[j];
    }
}

struct lpv_step lpv_step_of(enum lpv_lobe lobe, float mean_cosine)
{
    enum { Y = 1, X = 3 };
    double m[4][4];
    lpv_step_matrix(0, lobe, mean_cosine, m); // towards +x
    return (struct lpv_step){ .keep = (float)m[0][0],
                              .drive = (float)m[0][X],
                              .aim = (float)m[X][0],
                              .along = (float)m[X][X],
                              .across = (float)m[Y][Y] };
}
