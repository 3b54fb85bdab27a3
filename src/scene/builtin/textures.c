// Tileable noise, procedural textures, and their colour and normal images. See textures.h.
#include "scene/builtin/textures.h"

#include "core/rng.h"
#include "image/png_file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Value noise with period 1: random values at cells × cells lattice points, smoothly interpolated.
static float lattice(int x, int y, int cells, uint32_t seed)
{
    uint32_t column = (uint32_t)((x % cells + cells) % cells);
    uint32_t row = (uint32_t)((y % cells + cells) % cells);
    return (float)(pcg_hash(column + 977u * row + 131071u * seed) >> 8) * 0x1p-24f;
}

static float fade(float t)
{
    return t * t * (3.0f - 2.0f * t);
}

static float noise(float u, float v, int cells, uint32_t seed)
{
    float x = u * (float)cells, y = v * (float)cells;
    int i = (int)floorf(x), j = (int)floorf(y);
    float s = fade(x - (float)i), t = fade(y - (float)j);
    float top = glm_lerp(lattice(i, j, cells, seed), lattice(i + 1, j, cells, seed), s);
    float bottom = glm_lerp(lattice(i, j + 1, cells, seed), lattice(i + 1, j + 1, cells, seed), s);
    return glm_lerp(top, bottom, t);
}

// Four octaves, about 0…1.
static float turbulence(float u, float v, int cells, uint32_t seed)
{
    float sum = 0.0f, weight = 0.5f;
    for (uint32_t octave = 0; octave < 4; octave++) {
        sum += weight * noise(u, v, cells << octave, seed + octave);
        weight *= 0.5f;
    }
    return sum / 0.9375f;
}

static float smooth_step(float low, float high, float x)
{
    float t = glm_clamp((x - low) / (high - low), 0.0f, 1.0f);
    return fade(t);
}

// The cell of a point in a grid of rectangles, and its distance to the nearest joint, as a fraction
// of the texture's width.
struct panel {
    int column, row;
    float edge;
};

static struct panel panel_at(float u, float v, int columns, int rows, float shift)
{
    float y = v * (float)rows;
    int row = (int)floorf(y);
    float x = u * (float)columns + (row % 2 ? shift : 0.0f);
    int column = (int)floorf(x);
    float in_x = x - (float)column, in_y = y - (float)row;
    float edge_x = fminf(in_x, 1.0f - in_x) / (float)columns;
    float edge_y = fminf(in_y, 1.0f - in_y) / (float)rows;
    return (struct panel){ column % columns, row % rows, fminf(edge_x, edge_y) };
}

static float panel_random(struct panel panel, uint32_t seed)
{
    return lattice(panel.column, panel.row, 64, seed);
}

static vec3s blend(vec3s a, vec3s b, float t)
{
    return glms_vec3_lerp(a, b, t);
}

struct paint paint_bricks(float u, float v)
{
    struct panel stone = panel_at(u, v, 2, 4, 0.5f);
    float face = smooth_step(0.006f, 0.022f, stone.edge);
    float grain = turbulence(u, v, 16, 11), age = turbulence(u, v, 3, 12);
    vec3s warm = vec3_of(0.56f, 0.45f, 0.33f), cool = vec3_of(0.47f, 0.41f, 0.34f);
    vec3s colour = blend(warm, cool, panel_random(stone, 13));
    colour = glms_vec3_scale(colour, 0.72f + 0.28f * grain + 0.2f * age);
    vec3s mortar = glms_vec3_scale(vec3_of(0.36f, 0.33f, 0.29f), 0.7f + 0.4f * grain);
    return (struct paint){ blend(mortar, colour, face), 0.011f * face + 0.006f * grain * face };
}

struct paint paint_tiles(float u, float v)
{
    struct panel tile = panel_at(u, v, 2, 2, 0.0f);
    float face = smooth_step(0.004f, 0.012f, tile.edge);
    float veins = turbulence(u, v, 5, 21);
    float vein = 1.0f - smooth_step(0.0f, 0.035f, fabsf(veins - 0.5f));
    bool light = (tile.column + tile.row) % 2 == 0;
    vec3s colour = light ? vec3_of(0.58f, 0.54f, 0.47f) : vec3_of(0.27f, 0.16f, 0.12f);
    colour = glms_vec3_scale(colour, 0.86f + 0.22f * turbulence(u, v, 24, 22) - 0.12f * vein);
    vec3s joint = vec3_of(0.17f, 0.15f, 0.13f);
    return (struct paint){ blend(joint, colour, face), 0.004f * face };
}

struct paint paint_stone(float u, float v)
{
    float grain = turbulence(u, v, 32, 31), cloud = turbulence(u, v, 4, 32);
    vec3s colour = blend(vec3_of(0.53f, 0.48f, 0.40f), vec3_of(0.66f, 0.61f, 0.52f), cloud);
    return (struct paint){ glms_vec3_scale(colour, 0.85f + 0.25f * grain), 0.004f * grain };
}

struct paint paint_cloth(float u, float v)
{
    float threads = 96.0f * 2.0f * GLM_PIf;
    float weave = 0.5f + 0.25f * (sinf(threads * u) + sinf(threads * v));
    float diamond = fabsf(fabsf(u - 0.5f) + fabsf(v - 0.5f) - 0.36f);
    float figure = smooth_step(0.03f, 0.045f, diamond);
    float shade = (0.88f + 0.12f * weave) * (0.62f + 0.38f * figure);
    return (struct paint){ vec3_of(shade, shade, shade), 0.0008f * weave };
}

struct paint paint_wood(float u, float v)
{
    struct panel plank = panel_at(u, v, 4, 1, 0.0f);
    float face = smooth_step(0.003f, 0.01f, fminf(plank.edge, 0.02f));
    float rings = noise(u, 0.25f * v, 48, 41u) * 0.6f + turbulence(u, v, 8, 42) * 0.4f;
    vec3s colour = blend(vec3_of(0.20f, 0.10f, 0.05f), vec3_of(0.36f, 0.20f, 0.10f), rings);
    colour = glms_vec3_scale(colour, 0.8f + 0.4f * panel_random(plank, 43));
    return (struct paint){ glms_vec3_scale(colour, 0.25f + 0.75f * face), 0.006f * face };
}

struct paint paint_plaster(float u, float v)
{
    float cloud = turbulence(u, v, 4, 51);
    vec3s colour = blend(vec3_of(0.70f, 0.66f, 0.58f), vec3_of(0.78f, 0.75f, 0.68f), cloud);
    return (struct paint){ colour, 0.003f * turbulence(u, v, 16, 52) };
}

static uint8_t to_byte(float value)
{
    return (uint8_t)(glm_clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

static struct paint *paint_all(struct host *host, painter paint, int size)
{
    struct paint *painting = host_alloc(host, (size_t)size * (size_t)size, sizeof *painting);
    for (int y = 0; painting && y < size; y++) {
        for (int x = 0; x < size; x++) {
            painting[y * size + x] =
                paint(((float)x + 0.5f) / (float)size, ((float)y + 0.5f) / (float)size);
        }
    }
    return painting;
}

static void write_texel(uint8_t *texel, vec3s value)
{
    for (int c = 0; c < 3; c++) texel[c] = to_byte(value.raw[c]);
    texel[3] = 255;
}

static void write_colours(const struct paint *painting, uint8_t *rgba, int size)
{
    for (int i = 0; i < size * size; i++) {
        vec3s colour = painting[i].colour;
        write_texel(rgba + 4 * i,
                    vec3_of(srgb_encode(colour.x), srgb_encode(colour.y), srgb_encode(colour.z)));
    }
}

// Central differences of the height; green points up in the image, along -v.
static void write_normals(const struct paint *painting, uint8_t *rgba, int size)
{
    float per_texel = 0.5f * (float)size;
    for (int y = 0; y < size; y++) {
        int above = (y + size - 1) % size, below = (y + 1) % size;
        for (int x = 0; x < size; x++) {
            int left = (x + size - 1) % size, right = (x + 1) % size;
            float along_u = painting[y * size + right].height - painting[y * size + left].height;
            float along_v = painting[below * size + x].height - painting[above * size + x].height;
            vec3s normal =
                glms_vec3_normalize(vec3_of(-along_u * per_texel, along_v * per_texel, 1.0f));
            vec3s half = vec3_of(0.5f, 0.5f, 0.5f);
            write_texel(rgba + 4 * (y * size + x), glms_vec3_muladds(normal, 0.5f, half));
        }
    }
}

// Adds colour and normal images; the index of the first, that of the normals is one more.
static int add_images(struct scene *scene, const char *name, painter paint, int size)
{
    char colour_name[64], normal_name[64];
    snprintf(colour_name, sizeof colour_name, "%s colour", name);
    snprintf(normal_name, sizeof normal_name, "%s normals", name);
    // Materials of the same painter share the images.
    for (int i = 0; i < scene->image_count; i++) {
        if (strcmp(scene->images[i].name, colour_name) == 0) return i;
    }
    int index = -1;
    struct scene_image image = { .name = colour_name, .width = size, .height = size };
    struct paint *painting = paint_all(scene->host, paint, size);
    image.rgba = host_alloc(scene->host, (size_t)size * (size_t)size, 4);
    if (!painting || !image.rgba) goto end;
    write_colours(painting, image.rgba, size);
    index = scene_add_image(scene, &image);
    if (index < 0) goto end;
    image.name = normal_name;
    write_normals(painting, image.rgba, size);
    if (scene_add_image(scene, &image) < 0) index = -1;
end:
    host_free(scene->host, painting);
    host_free(scene->host, image.rgba);
    return index;
}

static const char *painter_name(painter paint)
{
    static const struct {
        painter paint;
        const char *name;
    } names[] = {
        { paint_bricks, "bricks" }, { paint_tiles, "tiles" }, { paint_stone, "stone" },
        { paint_cloth, "cloth" },   { paint_wood, "wood" },   { paint_plaster, "plaster" },
    };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (names[i].paint == paint) return names[i].name;
    }
    return "painted";
}

int builtin_painted(struct scene *scene, const struct painted *painted, int size)
{
    const char *image_name = painter_name(painted->paint);
    struct material material = material_default();
    material.name = painted->name;
    material.base_color = vec4_of(painted->tint, 1);
    material.roughness = painted->roughness;
    float repeats = 1.0f / painted->period_m;
    struct texture_use use = texture_use_none();
    use.uv_scale[0] = use.uv_scale[1] = repeats;
    material.base_color_map = material.normal_map = use;
    int images = add_images(scene, image_name, painted->paint, size);
    if (images < 0) return -1;
    material.base_color_map.image = images;
    material.normal_map.image = images + 1;
    return scene_add_material(scene, &material);
}
