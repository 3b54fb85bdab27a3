// @cornell: the Cornell box by its published measurements (Cornell University Program of Computer
// Graphics, "Cornell Box Data"; the scene of Goral et al. 1984, "Modeling the Interaction of Light
// Between Diffuse Surfaces", as measured for Meyer et al. 1986), at one centimetre per unit of the
// data: 5.56 m wide.
//
// In the data the camera faces +z with +x to the left. Here the box is rotated by 180 degrees
// around +y and the floor's centre is the origin: the opening faces +z, the camera at z = 10.796 m
// faces -z, the red wall is on the left.
//
// Differs: the ceiling has a hole at the light, to avoid coplanar surfaces; walls can have a
// thickness; the box can be closed and have objects that move.
#include "scene/builtin/movable_objects.h"
#include "scene/builtin/parts.h"

#include <math.h>

struct cornell_options {
#define OPTION OPTION_FIELD
#include "cornell_options.def"
#undef OPTION
};

#define OPTION(...) OPTION_ROW(struct cornell_options, __VA_ARGS__)
static const struct option_row rows[] = {
#include "cornell_options.def"
};
#undef OPTION

enum cornell_light { CORNELL_QUAD, CORNELL_POINT };

// The published spectra in linear Rec. 709, as in most renderers' versions of the box.
static const vec3s WHITE = { { 0.725f, 0.71f, 0.68f } };
static const vec3s RED = { { 0.63f, 0.065f, 0.05f } };
static const vec3s GREEN = { { 0.14f, 0.45f, 0.091f } };

// The light's published emission is given without a photometric scale (0, 8, 15.6, 18.4 at 400…700
// nm). 1000 cd/m² per unit gives a luminance of 15600 cd/m², that of a fluorescent tube, and about
// 700 lux on the floor.
static const vec3s LIGHT_RADIANCE = { { 18400.0f, 15600.0f, 8000.0f } };

static const float HEIGHT = 548.8f, DEPTH = 559.2f;
// Extent of the light in the data.
static const float LIGHT_X[2] = { 213.0f, 343.0f }, LIGHT_Z[2] = { 227.0f, 332.0f };

// From coordinates of the data to the scene, metres.
static vec3s from_data(float x, float y, float z)
{
    return vec3_of(0.01f * (278.0f - x), 0.01f * y, 0.01f * (0.5f * DEPTH - z));
}

static vec3s outwards(vec3s p, float thickness, vec3s direction)
{
    return glms_vec3_muladds(direction, thickness, p);
}

// The inner corners of the shell: index x + 2 y + 4 z, each 0 or 1, along the axes of the data. The
// floor is narrower than the ceiling, and narrowest at the back: the red wall leans and is twisted,
// as published.
static void shell_corners(vec3s corner[8])
{
    corner[0] = from_data(0, 0, 0);
    corner[1] = from_data(552.8f, 0, 0);
    corner[2] = from_data(0, HEIGHT, 0);
    corner[3] = from_data(556, HEIGHT, 0);
    corner[4] = from_data(0, 0, DEPTH);
    corner[5] = from_data(549.6f, 0, DEPTH);
    corner[6] = from_data(0, HEIGHT, DEPTH);
    corner[7] = from_data(556, HEIGHT, DEPTH);
}

// The corners moved outwards by the walls' thickness; the front ones stay in the plane of the
// opening.
static void outer_corners(const vec3s inner[8], float thickness, vec3s outer[8])
{
    for (int i = 0; i < 8; i++) {
        vec3s direction = vec3_of(i & 1 ? -1.0f : 1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? -1.0f : 0.0f);
        outer[i] = outwards(inner[i], thickness, direction);
    }
}

// The corners of the light, in the order of the ceiling's: counter-clockwise from below.
static void light_corners(vec3s corner[4])
{
    corner[0] = from_data(LIGHT_X[1], HEIGHT, LIGHT_Z[0]);
    corner[1] = from_data(LIGHT_X[1], HEIGHT, LIGHT_Z[1]);
    corner[2] = from_data(LIGHT_X[0], HEIGHT, LIGHT_Z[1]);
    corner[3] = from_data(LIGHT_X[0], HEIGHT, LIGHT_Z[0]);
}

// The shell's faces by corner, counter-clockwise from inside; the order is the data's.
enum shell_face { FLOOR, CEILING, BACK, GREEN_WALL, RED_WALL, SHELL_FACES, FRONT = SHELL_FACES };
static const int SHELL[SHELL_FACES + 1][4] = {
    { 1, 0, 4, 5 }, { 3, 7, 6, 2 }, { 5, 4, 6, 7 }, { 4, 0, 2, 6 }, { 1, 5, 7, 3 }, { 0, 1, 3, 2 },
};

static void shell_face(struct shape_builder *builder, const vec3s corner[8], enum shell_face face)
{
    const int *at = SHELL[face];
    shape_quad(builder, corner[at[0]], corner[at[1]], corner[at[2]], corner[at[3]]);
}

// The ceiling around the light, without T-vertices on the edges shared with the walls.
static void ceiling(struct shape_builder *builder, const vec3s corner[8], bool hole)
{
    vec3s light[4];
    light_corners(light);
    for (int i = 0; i < 4; i++) {
        int next = (i + 1) % 4;
        shape_quad(builder, corner[SHELL[CEILING][i]], corner[SHELL[CEILING][next]], light[next],
                   light[i]);
    }
    if (!hole) shape_quad(builder, light[0], light[1], light[2], light[3]);
}

// The walls' outer faces and the rim around the opening.
static void outside(struct shape_builder *builder, const vec3s inner[8], float thickness)
{
    vec3s outer[8];
    outer_corners(inner, thickness, outer);
    for (int face = 0; face < SHELL_FACES; face++) {
        const int *at = SHELL[face];
        shape_quad(builder, outer[at[0]], outer[at[3]], outer[at[2]], outer[at[1]]);
    }
    static const int around[5] = { 0, 1, 3, 2, 0 };
    for (int i = 0; i < 4; i++) {
        int p = around[i], q = around[i + 1];
        shape_quad(builder, outer[q], outer[p], inner[p], inner[q]);
    }
}

// A block from its top's corners (x, z in the data), counter-clockwise from above.
static void block(struct shape_builder *builder, float height, const float corner[4][2])
{
    vec3s top[4], bottom[4];
    for (int i = 0; i < 4; i++) {
        top[i] = from_data(corner[i][0], height, corner[i][1]);
        bottom[i] = from_data(corner[i][0], 0, corner[i][1]);
    }
    shape_quad(builder, top[0], top[1], top[2], top[3]);
    shape_quad(builder, bottom[3], bottom[2], bottom[1], bottom[0]);
    for (int p = 0; p < 4; p++) {
        int q = (p + 1) % 4;
        shape_quad(builder, bottom[q], top[q], top[p], bottom[p]);
    }
}

// White as the other walls, with a specular lobe where it is not matte.
static int add_floor(struct scene *scene, const struct cornell_options *options, int white)
{
    const float roughness = options->floor_roughness, metallic = options->floor_metallic;
    if (roughness == 1.0f && metallic == 0.0f) return white;
    struct material material = material_default();
    material.name = "floor";
    material.base_color = vec4_of(WHITE, 1);
    material.roughness = roughness;
    material.metallic = metallic;
    return scene_add_material(scene, &material);
}

static bool build_shell(struct scene *scene, const struct cornell_options *options)
{
    int white = builtin_diffuse(scene, "white", WHITE);
    int red = builtin_diffuse(scene, "red", RED);
    int green = builtin_diffuse(scene, "green", GREEN);
    const int floor = add_floor(scene, options, white);
    if (white < 0 || red < 0 || green < 0 || floor < 0) return false;
    vec3s corner[8];
    shell_corners(corner);
    struct shape_builder builder;
    shape_begin(&builder, scene);
    shell_face(&builder, corner, FLOOR);
    if (shape_emit(&builder, "floor", floor) < 0) return false;
    if (options->ceiling) {
        ceiling(&builder, corner, options->light == CORNELL_QUAD);
        if (shape_emit(&builder, "ceiling", white) < 0) return false;
    }
    shell_face(&builder, corner, BACK);
    if (shape_emit(&builder, "back wall", white) < 0) return false;
    shell_face(&builder, corner, GREEN_WALL);
    if (shape_emit(&builder, "green wall", green) < 0) return false;
    shell_face(&builder, corner, RED_WALL);
    if (shape_emit(&builder, "red wall", red) < 0) return false;
    if (options->closed) {
        shell_face(&builder, corner, FRONT);
        if (shape_emit(&builder, "front wall", white) < 0) return false;
    }
    if (options->walls > 0.0f) {
        outside(&builder, corner, options->walls);
        if (shape_emit(&builder, "outside", white) < 0) return false;
    }
    if (!options->blocks) return true;
    block(&builder, 165.0f,
          (const float[4][2]){ { 130, 65 }, { 82, 225 }, { 240, 272 }, { 290, 114 } });
    if (shape_emit(&builder, "short block", white) < 0) return false;
    block(&builder, 330.0f,
          (const float[4][2]){ { 423, 247 }, { 265, 296 }, { 314, 456 }, { 472, 406 } });
    return shape_emit(&builder, "tall block", white) >= 0;
}

// The quad has the flux π L A per channel; a point light of the same flux has the intensity L A
// / 4.
static bool build_light(struct scene *scene, const struct cornell_options *options)
{
    vec3s radiance = glms_vec3_scale(LIGHT_RADIANCE, options->power), corner[4];
    light_corners(corner);
    if (options->light == CORNELL_POINT) {
        float area_m2 = 1e-4f * (LIGHT_X[1] - LIGHT_X[0]) * (LIGHT_Z[1] - LIGHT_Z[0]);
        vec3s below = glms_vec3_scale(glms_vec3_add(corner[0], corner[2]), 0.5f);
        below.y -= 0.3f;
        return builtin_point_light(scene, "light", below,
                                   glms_vec3_scale(radiance, 0.25f * area_m2));
    }
    int material = builtin_emitter(scene, "light", radiance);
    if (material < 0) return false;
    struct shape_builder builder;
    shape_begin(&builder, scene);
    shape_quad(&builder, corner[0], corner[1], corner[2], corner[3]);
    return shape_emit(&builder, "light", material) >= 0;
}

static bool build_cornell(struct scene *scene, const void *options)
{
    // Published: position (278, 273, -800), focal length 35 mm, sensor height 25 mm.
    float vertical_fov_rad = 2.0f * atanf(0.5f * 0.025f / 0.035f);
    const struct cornell_options *o = options;
    if (!o->ceiling && o->walls > 0.0f)
        return host_fail(scene->host, FAIL_ARGUMENT,
                         "scene %s: without a ceiling walls have no thickness; use walls=0",
                         scene->name);
    return build_shell(scene, o) && (!o->ceiling || build_light(scene, o)) &&
           cornell_add_objects(scene, o->objects) && (!o->bowl || cornell_add_bowl(scene)) &&
           builtin_camera(scene, "main", from_data(278, 273, -800), from_data(278, 273, 0),
                          vertical_fov_rad);
}

const struct builtin_scene builtin_cornell = {
    .name = "cornell",
    .title = "the Cornell box by its published measurements, 5.56 m wide",
    .options = OPTION_TABLE(struct cornell_options, rows, NULL),
    .build = build_cornell,
};
