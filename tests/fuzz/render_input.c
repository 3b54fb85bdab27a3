#include "fuzz/render_input.h"

#include "fuzz/fuzz.h"

#include <math.h>
#include <string.h>

static const float PI = 3.14159265f;

// ---- numbers

uint8_t input_byte(struct render_input *in)
{
    return in->at < in->size ? in->data[in->at++] : 0;
}

int input_choice(struct render_input *in, int count)
{
    return count > 1 ? input_byte(in) % count : 0;
}

bool input_bool(struct render_input *in)
{
    return input_byte(in) & 1;
}

static float any_float(struct render_input *in)
{
    float value;
    uint8_t bytes[sizeof value];
    for (size_t i = 0; i < sizeof bytes; i++) bytes[i] = input_byte(in);
    memcpy(&value, bytes, sizeof value);
    return value;
}

#define COUNT(table) ((int)(sizeof(table) / sizeof *(table)))

float input_number(struct render_input *in)
{
    static const float table[] = { 0,     0.5f,   1,    2,     -1,     -0.5f,  0.1f,    -3,
                                   1e-3f, -1e-6f, 10,   -100,  1e3f,   -3e4f,  3e4f,    1e6f,
                                   -1e8f, 1e8f,   1e9f, -1e9f, 1e-12f, 1e-30f, -1e-44f, 3e38f };
    const uint8_t byte = input_byte(in);
    if (byte < COUNT(table)) return table[byte];
    if (byte < 32) return any_float(in);
    return ((float)byte - 140.0f) / 32.0f;
}

float input_size(struct render_input *in)
{
    static const float table[] = { 1,  0.5f, 2,    0.1f, 1e-2f, 1e-3f, 1e-6f,  1e-12f,
                                   10, 100,  1e4f, 1e6f, 1e8f,  1e9f,  1e-30f, 3e38f };
    const uint8_t byte = input_byte(in);
    if (byte < COUNT(table)) return table[byte];
    if (byte < 32) return any_float(in);
    return (float)byte / 64.0f;
}

void input_vector(struct render_input *in, float out[3])
{
    for (int i = 0; i < 3; i++) out[i] = input_number(in);
}

void input_light(struct render_input *in, float out[3])
{
    static const float table[] = { 100, 0, 1, 1e-6f, 1e-30f, 1e5f, 1e9f, 1e12f, 1e15f, 1e-44f };
    for (int i = 0; i < 3; i++) {
        const uint8_t byte = input_byte(in);
        out[i] = byte < COUNT(table) ? table[byte] : (float)byte * 10.0f;
    }
}

// ---- objects

static void rotate(float m[16], int axis, float angle)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const float c = cosf(angle), s = sinf(angle);
    for (int i = 0; i < 3; i++) {
        const float a = m[4 * u + i], b = m[4 * v + i];
        m[4 * u + i] = c * a + s * b;
        m[4 * v + i] = c * b - s * a;
    }
}

void input_matrix(struct render_input *in, float out[16])
{
    memset(out, 0, 16 * sizeof *out);
    out[15] = 1;
    for (int i = 0; i < 3; i++) out[5 * i] = 1;
    input_vector(in, out + 12);
    const uint8_t shape = input_byte(in);
    if (shape & 1) rotate(out, input_choice(in, 3), input_number(in));
    if (shape & 2) rotate(out, input_choice(in, 3), input_number(in));
    for (int i = 0; i < 3; i++) {
        const float size = i == 0 || shape & 4 ? input_size(in) : 1.0f;
        const float sign = shape >> (4 + i) & 1 ? -1.0f : 1.0f;
        for (int k = 0; k < 3; k++) out[4 * i + k] *= sign * size;
        if (!(shape & 4) && i > 0)
            for (int k = 0; k < 3; k++) out[4 * i + k] *= hypotf(hypotf(out[0], out[1]), out[2]);
    }
    if (shape & 8) out[input_choice(in, 12)] = input_number(in);
    if (shape & 128) memset(out + 4 * input_choice(in, 3), 0, 3 * sizeof *out);
}

void input_camera(struct render_input *in, struct ag_camera *out)
{
    static const float degrees[] = { 60, 0.001f, 1, 10, 90, 120, 170, 179.999f, 1e-6f, 1e-30f };
    static const float eyes[][3] = { { 0, 1, 3 }, { 0.1f, 1.2f, 0.3f }, { 3, 4, 5 }, { 0, 1, 0 } };
    static const float ups[][3] = { { 0, 1, 0 }, { 1, 0, 0 }, { 0, -1, 1 }, { 1e-20f, 1, 0 } };
    static const float nears[] = { 0.01f, 1e-3f, 1e-6f, 1, 100, 1e6f, 1e-30f, 1e9f };
    *out = (struct ag_camera){ .vertical_fov_rad =
                                   degrees[input_choice(in, COUNT(degrees))] * PI / 180.0f };
    const int eye = input_choice(in, COUNT(eyes) + 4);
    if (eye < COUNT(eyes))
        memcpy(out->eye, eyes[eye], sizeof out->eye);
    else
        input_vector(in, out->eye);
    input_vector(in, out->target);
    memcpy(out->up, ups[input_choice(in, COUNT(ups))], sizeof out->up);
    out->near_m = nears[input_choice(in, COUNT(nears))];
}

void input_punctual(struct render_input *in, struct ag_light_desc *out)
{
    ag_light_desc_default(out, (enum ag_light_type)input_choice(in, 3));
    input_vector(in, out->position);
    if (input_bool(in)) input_vector(in, out->direction);
    input_light(in, out->intensity);
    if (input_bool(in)) out->outer_rad = fminf(input_size(in), 0.5f * PI);
    if (input_bool(in)) out->inner_rad = out->outer_rad * (float)input_byte(in) / 256.0f;
}

void input_material(struct render_input *in, struct ag_material_desc *out)
{
    static const float factors[] = { 0.8f, 0, 1, 0.5f, 1e-3f, 1e-30f, 1e-44f };
    ag_material_desc_default(out);
    const uint8_t parts = input_byte(in);
    for (int i = 0; i < 3; i++) out->base_color[i] = factors[input_choice(in, COUNT(factors))];
    if (parts & 1) out->metallic = factors[input_choice(in, COUNT(factors))];
    if (parts & 2) out->roughness = factors[input_choice(in, COUNT(factors))];
    if (parts & 4) input_light(in, out->emissive);
    out->double_sided = parts & 8;
    if (parts & 16) out->ior = input_choice(in, 2) ? 0.0f : 1.0f + input_size(in);
    if (parts & 32) out->specular = factors[input_choice(in, COUNT(factors))];
    if (parts & 64) out->unlit = true;
    if (parts & 128) input_light(in, out->specular_color);
}

// ---- GI specs

// Options that decide how long a bake or a frame takes; text: their only value.
struct limit {
    const char *technique, *option, *text;
    double most, step;
};

#define PROPAGATION(name)                                                                          \
    { name, "dim", NULL, 16, 8 }, { name, "steps", NULL, 6, 1 },                                   \
    {                                                                                              \
        name, "bounces", NULL, 3, 1                                                                \
    }
#define VOXELS(name)                                                                               \
    { name, "resolution", NULL, 32, 16 },                                                          \
    {                                                                                              \
        name, "levels", NULL, 3, 1                                                                 \
    }
#define DICTIONARY(name)                                                                           \
    { name, "maze", "auto", 0, 0 }, { name, "texels", "4", 0, 0 }, { name, "rays", "256", 0, 0 },  \
        { name, "prior_modes", "8", 0, 0 }, { name, "modes", "4", 0, 0 },                          \
        { name, "enrich", "false", 0, 0 }, { name, "block_probes", "2", 0, 0 },                    \
        { name, "lightfield_positions", "4", 0, 0 }, { name, "lightfield_directions", "6", 0, 0 }, \
        { name, "lightfield_supersampling", "1", 0, 0 }, { name, "lightfield_modes", "16", 0, 0 }, \
        { name, "lightfield_rounds", "0", 0, 0 }, { name, "response_modes", "4", 0, 0 },           \
        { name, "bounces", NULL, 3, 1 }, { name, "delta_rays", "64", 0, 0 },                       \
        { name, "blocks", "", 0, 0 },                                                              \
    {                                                                                              \
        name, "update", "wait", 0, 0                                                               \
    }

static const struct limit limits[] = {
    DICTIONARY("mrt"),
    DICTIONARY("drt"),
    PROPAGATION("lpv"),
    PROPAGATION("holpv"),
    VOXELS("vct"),
    VOXELS("vctao"),
    { "radiosity", "texels", "2048", 0, 0 },
    { "radiosity", "rays", "16", 0, 0 },
    { "radiosity", "sources", "8", 0, 0 },
    { "radiosity", "density", NULL, 4, 0 },
    { "radiosity", "probe_spacing", "0", 0, 0 },
    { "dnrt", "size", "16", 0, 0 },
    { "dnrt", "rays", "16", 0, 0 },
    { "dnrt", "keys", NULL, 3, 1 },
    { "dnrt", "map_size", NULL, 32, 1 },
};

static const struct limit *limit_of(const char *technique, const char *option)
{
    for (int i = 0; i < COUNT(limits); i++)
        if (strcmp(limits[i].technique, technique) == 0 && strcmp(limits[i].option, option) == 0)
            return &limits[i];
    return NULL;
}

static void print_choice(const char *names, int index, char *out, size_t size)
{
    for (; index > 0; index--) names += strcspn(names, "|") + 1;
    snprintf(out, size, "%.*s", (int)strcspn(names, "|"), names);
}

static void print_value(struct render_input *in, const struct ag_option_info *option,
                        const struct limit *limit, char *out, size_t size)
{
    const uint8_t byte = input_byte(in);
    const double most = limit ? limit->most : option->max, span = most - option->min;
    const double step = limit && limit->step > 0.0 ? limit->step : 1.0;
    const double value = byte == 1 ? most : option->min + byte * span / 255;
    if (strcmp(option->type, "choice") == 0)
        print_choice(option->unit, byte % ((int)most + 1), out, size);
    else if (strcmp(option->type, "bool") == 0)
        snprintf(out, size, "%s", byte & 1 ? "true" : "false");
    else if (strcmp(option->type, "int") == 0)
        snprintf(out, size, "%.0f", fmax(floor(value / step) * step, option->min));
    else if (byte < 32)
        snprintf(out, size, "%.9g", fmin(fmax(option->min, (double)input_size(in)), most));
    else
        snprintf(out, size, "%.9g", value);
}

// Nothing for an option that keeps its default.
static void print_option(struct render_input *in, const char *technique, bool probes,
                         const struct ag_option_info *option, char *out, size_t size)
{
    const struct limit *limit = limit_of(technique, option->name);
    out[0] = 0;
    if (probes && strcmp(option->name, "probes") == 0)
        snprintf(out, size, "true");
    else if (limit && limit->text)
        snprintf(out, size, "%s", limit->text);
    else if (strcmp(option->type, "text") != 0 && (limit || input_bool(in)))
        print_value(in, option, limit, out, size);
}

static void append(char *out, const char *a, const char *b, const char *c)
{
    const size_t used = strlen(out);
    FUZZ_CHECK((size_t)snprintf(out + used, INPUT_SPEC_SIZE - used, "%s%s%s", a, b, c) <
               INPUT_SPEC_SIZE - used);
}

static void print_technique(struct render_input *in, int index, bool probes, char *out)
{
    struct ag_technique_info technique;
    struct ag_option_info option;
    char value[64];
    const char *separator = ":";
    FUZZ_CHECK(ag_technique_get(index, &technique));
    append(out, out[0] ? "+" : "", technique.name, "");
    for (int i = 0; ag_technique_option_get(index, i, &option); i++) {
        print_option(in, technique.name, probes, &option, value, sizeof value);
        if (!value[0]) continue;
        append(out, separator, option.name, "=");
        append(out, value, "", "");
        separator = ",";
    }
}

// The n-th technique of a role, counted around.
static int technique_of(const char *role, int n)
{
    int found[32], count = 0;
    struct ag_technique_info technique;
    for (int i = 0; ag_technique_get(i, &technique) && count < COUNT(found); i++)
        if (strcmp(technique.role, role) == 0) found[count++] = i;
    FUZZ_CHECK(count > 0);
    return found[n % count];
}

void input_spec(struct render_input *in, char out[INPUT_SPEC_SIZE])
{
    const uint8_t more = input_byte(in);
    const int source = technique_of("source", input_byte(in));
    struct ag_technique_info technique;
    FUZZ_CHECK(ag_technique_get(source, &technique));
    const bool delta = more & 1 && technique.publishes_probes;
    out[0] = 0;
    print_technique(in, source, delta, out);
    if (delta) print_technique(in, technique_of("delta", 0), false, out);
    if (more & 2) print_technique(in, technique_of("visibility", more >> 2), false, out);
    if (more & 128) print_technique(in, technique_of("reflection", 0), false, out);
}
