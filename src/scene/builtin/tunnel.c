// @tunnel: a chain of round pipes, each straight, bent left or bent right (the three shapes of the
// cylinder dictionary in Loos 2015, chapter 3), closed at both ends.
#include "scene/builtin/parts.h"

#include "core/rng.h"

#include <math.h>
#include <stdio.h>

struct tunnel_options {
#define OPTION OPTION_FIELD
#include "tunnel_options.def"
#undef OPTION
};

#define OPTION(...) OPTION_ROW(struct tunnel_options, __VA_ARGS__)
static const struct option_row rows[] = {
#include "tunnel_options.def"
};
#undef OPTION

// A piece fills a square of PIECE metres; its axis connects the midpoints of two sides.
static const float PIECE = 4.0f, RADIUS = 1.5f, WALL = 0.15f;
enum { MAX_PIECES = 64, STEPS = 8, SEGMENTS = 32, MAX_FRAMES = MAX_PIECES * STEPS + 1 };

struct tunnel {
    int pieces;
    int bend[MAX_PIECES];     // -1 left, 0 straight, 1 right
    mat4s frames[MAX_FRAMES]; // origin on the axis; x to the left, y up, z along the axis
};

// A frame at `position` whose z axis has this heading: 0 along -z, π/2 along +x.
static mat4s frame_at(vec3s position, float heading)
{
    vec3s along = vec3_of(sinf(heading), 0, -cosf(heading));
    return (mat4s){ .col = { vec4_of(glms_vec3_cross(vec3_of(0, 1, 0), along), 0),
                             { { 0, 1, 0, 0 } },
                             vec4_of(along, 0),
                             vec4_of(position, 1) } };
}

// -1 left, 0 straight, 1 right. The tunnel never heads along +z, so it cannot intersect itself.
static int choose_bend(uint32_t seed, int piece, int quarter)
{
    int bend = (int)(pcg_hash(seed * 4099u + (uint32_t)piece) % 3u) - 1;
    return quarter + bend < -1 || quarter + bend > 1 ? 0 : bend;
}

static void lay_tunnel(struct tunnel *tunnel, int pieces, uint32_t seed)
{
    tunnel->pieces = pieces;
    vec3s position = vec3_of(0, RADIUS, 0);
    int quarter = 0; // heading in right angles
    tunnel->frames[0] = frame_at(position, 0);
    for (int p = 0; p < pieces; p++) {
        int bend = p == 0 ? 0 : choose_bend(seed, p, quarter);
        tunnel->bend[p] = bend;
        float heading = GLM_PI_2f * (float)quarter;
        mat4s start = frame_at(position, heading);
        for (int s = 1; s <= STEPS; s++) {
            float t = (float)s / (float)STEPS, turn = GLM_PI_2f * t * (float)bend;
            // A bend is a quarter circle of half the piece's size; x of the frame is to the left.
            float arc = 0.5f * PIECE;
            vec3s local =
                bend ? vec3_of(-(float)bend * arc * (1.0f - cosf(turn)), 0, arc * sinf(fabsf(turn)))
                     : vec3_of(0, 0, t * PIECE);
            tunnel->frames[p * STEPS + s] = frame_at(mat4_point(start, local), heading + turn);
        }
        position = vec3_xyz(tunnel->frames[(p + 1) * STEPS].col[3]);
        quarter += bend;
    }
}

// Inner faces: one mesh per piece, in alternating colours.
static bool build_inside(struct scene *scene, const struct tunnel *tunnel)
{
    static const vec3s colours[4] = { { { 0.75f, 0.74f, 0.70f } },
                                      { { 0.70f, 0.22f, 0.14f } },
                                      { { 0.75f, 0.74f, 0.70f } },
                                      { { 0.16f, 0.38f, 0.62f } } };
    struct shape_builder builder;
    shape_begin(&builder, scene);
    for (int p = 0; p < tunnel->pieces; p++) {
        char name[32];
        snprintf(name, sizeof name, "piece %d", p);
        int material = builtin_diffuse(scene, name, colours[p % 4]);
        if (material < 0) return false;
        struct shape_pipe pipe = { .frames = tunnel->frames + p * STEPS,
                                   .count = STEPS + 1,
                                   .radius = RADIUS,
                                   .segments = SEGMENTS,
                                   .inside_out = true,
                                   .start_cap = p == 0,
                                   .end_cap = p + 1 == tunnel->pieces };
        shape_sweep(&builder, &pipe);
        if (shape_emit(&builder, name, material) < 0) return false;
    }
    return true;
}

// The outer face, offset by the wall's thickness, also at both ends.
static bool build_outside(struct scene *scene, struct tunnel *tunnel)
{
    int material = builtin_diffuse(scene, "outside", vec3_of(0.5f, 0.5f, 0.5f));
    if (material < 0) return false;
    int last = tunnel->pieces * STEPS;
    tunnel->frames[0] = glms_mat4_mul(tunnel->frames[0], glms_translate_make(vec3_of(0, 0, -WALL)));
    tunnel->frames[last] =
        glms_mat4_mul(tunnel->frames[last], glms_translate_make(vec3_of(0, 0, WALL)));
    struct shape_builder builder;
    shape_begin(&builder, scene);
    struct shape_pipe pipe = { .frames = tunnel->frames,
                               .count = last + 1,
                               .radius = RADIUS + WALL,
                               .segments = SEGMENTS,
                               .start_cap = true,
                               .end_cap = true };
    shape_sweep(&builder, &pipe);
    return shape_emit(&builder, "outside", material) >= 0;
}

// One block of the block map for each piece. In its cell the axis runs from −z, y is up.
static bool build_blocks(struct scene *scene, const struct tunnel *tunnel)
{
    static const char *const shapes[] = { "left", "straight", "right" };
    static const char *const exits[] = { "+x", "+z", "-x" };
    mat4s frame_from_cell = glms_mat4_mul(glms_translate_make(vec3_of(0, 0, 0.5f * PIECE)),
                                          glms_scale_make(vec3_of(PIECE, PIECE, PIECE)));
    for (int p = 0; p < tunnel->pieces; p++) {
        char name[32], neighbors[64] = "";
        snprintf(name, sizeof name, "block %d", p);
        int bend = 1 + tunnel->bend[p];
        if (p + 1 < tunnel->pieces)
            snprintf(neighbors, sizeof neighbors, "\"%s\":\"block %d\"", exits[bend], p + 1);
        mat4s block = glms_mat4_mul(tunnel->frames[p * STEPS], frame_from_cell);
        if (!builtin_block(scene, name, block, shapes[bend], neighbors)) return false;
    }
    return true;
}

static bool build_tunnel(struct scene *scene, const void *options)
{
    const struct tunnel_options *o = options;
    struct tunnel *tunnel = host_alloc(scene->host, 1, sizeof *tunnel);
    if (!tunnel) return false;
    lay_tunnel(tunnel, o->pieces, (uint32_t)o->seed);
    int lit = o->pieces > 1 ? STEPS + STEPS / 2 : STEPS / 2;
    vec3s camera = mat4_point(tunnel->frames[0], vec3_of(0.5f, 0.3f, 1.2f));
    vec3s target = mat4_point(tunnel->frames[STEPS], vec3_of(0, 0, 0));
    vec3s light = mat4_point(tunnel->frames[lit], vec3_of(0, 0.5f * RADIUS, 0));
    bool ok = build_blocks(scene, tunnel) && build_inside(scene, tunnel) &&
              build_outside(scene, tunnel) &&
              builtin_sphere_light(scene, light, o->light == 1, o->lumens) &&
              builtin_camera(scene, "main", camera, target, glm_rad(70.0f));
    host_free(scene->host, tunnel);
    return ok;
}

const struct builtin_scene builtin_tunnel = {
    .name = "tunnel",
    .title = "a chain of straight and bent pipes with one light",
    .options = OPTION_TABLE(struct tunnel_options, rows, NULL),
    .build = build_tunnel,
};
