// View space has x right, y up and looks along −z; matrices have element [4 × column + row].
#include "engine_camera.h"

#include <math.h>
#include <string.h>

static const float NEAR_M = 0.1f, FAR_M = 20, HALF_HEIGHT = 0.36f; // of the image, at 1 m

// Element `index` of the Halton sequence, 0…1.
static float halton(int index, int base)
{
    float fraction = 1, sum = 0;
    for (; index > 0; index /= base) {
        fraction /= (float)base;
        sum += fraction * (float)(index % base);
    }
    return sum;
}

// The camera looks along the heading, an angle from −z to x.
static void set_view(const float eye[3], float heading, float m[16])
{
    const float axes[3][3] = { { cosf(heading), 0, sinf(heading) },
                               { 0, 1, 0 },
                               { -sinf(heading), 0, cosf(heading) } };
    memset(m, 0, 16 * sizeof *m);
    m[15] = 1;
    for (int row = 0; row < 3; row++)
        for (int i = 0; i < 3; i++) {
            m[4 * i + row] = axes[row][i];
            m[12 + row] -= axes[row][i] * eye[i];
        }
}

static void set_projection(enum engine_depth depth, float aspect, float m[16])
{
    const bool forward = depth == ENGINE_FORWARD;
    memset(m, 0, 16 * sizeof *m);
    m[0] = 1 / (HALF_HEIGHT * aspect);
    m[5] = -1 / HALF_HEIGHT; // Vulkan's clip space has +y down
    m[10] = forward ? -FAR_M / (FAR_M - NEAR_M) : 0;
    m[11] = -1;
    m[14] = forward ? -NEAR_M * FAR_M / (FAR_M - NEAR_M) : NEAR_M;
}

void engine_camera_set(int frame, enum engine_depth depth, int width, int height,
                       struct engine_camera *out)
{
    const float eye[3] = { -0.4f + 0.01f * (float)frame, 1, 4 };
    memset(out, 0, sizeof *out);
    set_view(eye, -0.1f * eye[0], out->matrices.view_from_world);
    set_projection(depth, (float)width / (float)height, out->matrices.clip_from_view);
    out->jitter[0] = halton(frame % 8 + 1, 2) - 0.5f;
    out->jitter[1] = halton(frame % 8 + 1, 3) - 0.5f;
    // The divisor is −z: an image that moves by +1 in clip space has −1 in the column of z.
    out->matrices.clip_from_view[8] = -2 * out->jitter[0] / (float)width;
    out->matrices.clip_from_view[9] = -2 * out->jitter[1] / (float)height;
}

void engine_camera_ray(const struct engine_camera *camera, const float pixel[2], int width,
                       int height, float eye[3], float ray[3])
{
    const float *view = camera->matrices.view_from_world, *clip = camera->matrices.clip_from_view;
    const float x = (2 * (pixel[0] + 0.5f) / (float)width - 1 + clip[8]) / clip[0];
    const float y = (2 * (pixel[1] + 0.5f) / (float)height - 1 + clip[9]) / clip[5];
    for (int i = 0; i < 3; i++) {
        const float *column = view + 4 * i; // a world axis in view space
        eye[i] = -(column[0] * view[12] + column[1] * view[13] + column[2] * view[14]);
        ray[i] = column[0] * x + column[1] * y - column[2];
    }
}

float engine_camera_depth(const struct engine_camera *camera, float distance)
{
    const float *clip = camera->matrices.clip_from_view;
    if (isinf(distance)) return clip[10] < 0 ? 1.0f : 0.0f;
    return clip[14] / distance - clip[10];
}

void engine_camera_project(const struct engine_camera *camera, const float point[3], int width,
                           int height, float pixel[2])
{
    const float *view = camera->matrices.view_from_world, *clip = camera->matrices.clip_from_view;
    float at[3];
    for (int row = 0; row < 3; row++) {
        at[row] = view[12 + row];
        for (int i = 0; i < 3; i++) at[row] += view[4 * i + row] * point[i];
    }
    pixel[0] = (clip[0] * at[0] / -at[2] + 1) / 2 * (float)width - 0.5f;
    pixel[1] = (clip[5] * at[1] / -at[2] + 1) / 2 * (float)height - 0.5f;
}
