#include "scene/environment/cube_map.h"

#include "core/parallel.h"
#include "image/png_file.h"
#include "scene/environment/environment_map.h"
#include "scene/environment/equirect.h"

#include <math.h>
#include <string.h>

struct resampling {
    const struct cube_map *cube;
    const struct image *out;
    versors cube_from_world;
    int samples; // of a texel's side
    float linear[256];
};

// A point of a face: s and t from 0 to 1.
struct face_point {
    int face;
    float s, t;
};

static struct face_point find_face(vec3s d)
{
    const float x = fabsf(d.x), y = fabsf(d.y), z = fabsf(d.z);
    float sc, tc, major;
    int face;
    if (x >= y && x >= z) {
        face = d.x < 0.0f;
        sc = d.x < 0.0f ? d.z : -d.z, tc = -d.y, major = x;
    } else if (y >= z) {
        face = 2 + (d.y < 0.0f);
        sc = d.x, tc = d.y < 0.0f ? -d.z : d.z, major = y;
    } else {
        face = 4 + (d.z < 0.0f);
        sc = d.z < 0.0f ? -d.x : d.x, tc = -d.y, major = z;
    }
    return (struct face_point){ face, 0.5f * (sc / major + 1.0f), 0.5f * (tc / major + 1.0f) };
}

static int clamp_index(int i, int size)
{
    return i < 0 ? 0 : i >= size ? size - 1 : i;
}

static vec3s texel(const struct resampling *r, int face, int column, int row)
{
    const int size = r->cube->size;
    const size_t at = (size_t)clamp_index(row, size) * (size_t)size;
    const uint8_t *rgbd = r->cube->faces[face] + 4 * (at + (size_t)clamp_index(column, size));
    const float scale = 255.0f / (float)(rgbd[3] > 0 ? rgbd[3] : 1);
    return vec3_of(scale * r->linear[rgbd[0]], scale * r->linear[rgbd[1]],
                   scale * r->linear[rgbd[2]]);
}

// Interpolated linearly within a face. Rows begin at t = 1.
static vec3s radiance_at(const struct resampling *r, vec3s direction)
{
    const vec3s d = glms_quat_rotatev(r->cube_from_world, direction);
    const struct face_point p = find_face(vec3_of(d.x, d.y, -d.z));
    const float x = p.s * (float)r->cube->size - 0.5f,
                y = (1.0f - p.t) * (float)r->cube->size - 0.5f;
    const float left = floorf(x), top = floorf(y);
    const int column = (int)left, row = (int)top;
    const vec3s above =
        glms_vec3_lerp(texel(r, p.face, column, row), texel(r, p.face, column + 1, row), x - left);
    const vec3s below = glms_vec3_lerp(texel(r, p.face, column, row + 1),
                                       texel(r, p.face, column + 1, row + 1), x - left);
    return glms_vec3_lerp(above, below, y - top);
}

static vec3s texel_mean(const struct resampling *r, int column, int row)
{
    const int n = r->samples;
    vec3s sum = vec3_of(0, 0, 0);
    for (int i = 0; i < n * n; i++) {
        const vec2s uv = equirect_texel_uv(r->out->width * n, r->out->height * n,
                                           column * n + i % n, row * n + i / n);
        sum = glms_vec3_add(sum, radiance_at(r, equirect_direction(uv)));
    }
    return glms_vec3_divs(sum, (float)(n * n));
}

static void resample_row(void *user, size_t row)
{
    const struct resampling *r = user;
    for (int x = 0; x < r->out->width; x++) {
        const vec3s radiance = texel_mean(r, x, (int)row);
        memcpy(image_at(r->out, x, (int)row), radiance.raw, sizeof radiance.raw);
    }
}

int cube_map_width(const struct cube_map *cube)
{
    static const int LEAST = 64;
    const int width =
        cube->size > ENVIRONMENT_MAX_WIDTH / 4 ? ENVIRONMENT_MAX_WIDTH : 4 * cube->size;
    return width < LEAST ? LEAST : width;
}

bool cube_map_to_equirect(struct host *host, const struct cube_map *cube, versors world_from_cube,
                          struct image *out)
{
    const int width = cube_map_width(cube);
    struct resampling r = { .cube = cube,
                            .out = out,
                            .cube_from_world = glms_quat_conjugate(world_from_cube),
                            .samples = 1 + (4 * cube->size + width - 1) / width };
    for (int i = 0; i < 256; i++) r.linear[i] = srgb_decode((float)i / 255.0f);
    if (!image_init(out, host, width, width / 2, 3)) return false;
    parallel_for((size_t)out->height, 4, resample_row, &r);
    return true;
}
