// TEXCOORD_1 of a file: light maps use a valid unwrap without a word, and replace a broken one with
// one warning. Figures of the light map by info.
#include "cli/program.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GI "radiosity:texels=2048,rays=64,sources=8"

enum { CORNERS = 8 };

// A floor and a wall of 4 m, each a square with coordinates of its own.
static const float positions[CORNERS][3] = {
    { -2, 0, 2 },  { 2, 0, 2 },  { 2, 0, -2 }, { -2, 0, -2 },
    { -2, 0, -2 }, { 2, 0, -2 }, { 2, 4, -2 }, { -2, 4, -2 },
};
// Both squares are one island.
static float valid[CORNERS][2] = {
    { 0, 0 },    { 0.4f, 0 },    { 0.4f, 0.4f }, { 0, 0.4f },
    { 0, 0.4f }, { 0.4f, 0.4f }, { 0.4f, 0.8f }, { 0, 0.8f },
};

#define JSON                                                                                       \
    "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],"                    \
    "'meshes':[{'name':'sheet','primitives':[{'attributes':{'POSITION':0,'TEXCOORD_0':2%s},"       \
    "'indices':3}]}],'accessors':["                                                                \
    "{'bufferView':0,'componentType':5126,'type':'VEC3','count':8,'min':[-2,0,-2],"                \
    "'max':[2,4,2]},"                                                                              \
    "{'bufferView':1,'componentType':5126,'type':'VEC2','count':8},"                               \
    "{'bufferView':0,'componentType':5126,'type':'VEC2','count':8},"                               \
    "{'bufferView':2,'componentType':5123,'type':'SCALAR','count':12}],"                           \
    "'bufferViews':[{'buffer':0,'byteLength':96},"                                                 \
    "{'buffer':0,'byteOffset':96,'byteLength':64},"                                                \
    "{'buffer':0,'byteOffset':160,'byteLength':24}],"                                              \
    "'buffers':[{'uri':'%s.bin','byteLength':184}]}"

static const char *path_with(const char *name, const char *ending)
{
    static char paths[16][400];
    static int next;
    char *path = paths[next++ % 16], file[100];
    snprintf(file, sizeof file, "%s%s", name, ending);
    snprintf(path, sizeof paths[0], "%s", test_path(file));
    return path;
}

// Writes NAME.gltf and NAME.bin. uv: [CORNERS], NULL: without TEXCOORD_1. The path of the former.
static const char *write_sheet(const char *name, float (*uv)[2])
{
    static const uint16_t corners[12] = { 0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7 };
    char json[2000];
    uint8_t bytes[184];
    const int length = snprintf(json, sizeof json, JSON, uv ? ",'TEXCOORD_1':1" : "", name);
    for (char *c = json; *c; c++)
        if (*c == '\'') *c = '"';
    memcpy(bytes, positions, sizeof positions);
    memcpy(bytes + 96, uv ? uv : valid, sizeof valid);
    memcpy(bytes + 160, corners, sizeof corners);
    write_file(path_with(name, ".bin"), (const char *)bytes, sizeof bytes);
    write_file(path_with(name, ".gltf"), json, (size_t)length);
    return path_with(name, ".gltf");
}

static int count_of(const char *text, const char *word)
{
    int count = 0;
    for (const char *at = text; (at = strstr(at, word)); at++) count++;
    return count;
}

// Renders NAME.gltf; returns the image. fault: what the one warning says; NULL: there is none.
static const char *render(const char *name, float (*uv)[2], const char *fault)
{
    const char *scene = write_sheet(name, uv), *image = path_with(name, ".exr");
    const struct run *r = run_expect(
        0, "render --size 32x24 --light sun:-1,-2,-1:9,9,9 --gi " GI " --aov color,irradiance -o",
        image, scene, NULL);
    const int warnings = count_of(r->err, "warning: ");
    if (warnings != (fault ? 1 : 0) || (fault && !strstr(r->err, fault)))
        fail_msg("%d warnings: %s", warnings, r->err);
    if (fault && !strstr(r->err, "TEXCOORD_1")) fail_msg("%s", r->err);
    return image;
}

// The coordinates of the corners from `first` on are moved along v.
static void move(float out[CORNERS][2], int first, float v)
{
    memcpy(out, valid, sizeof valid);
    for (int i = first; i < CORNERS; i++) out[i][1] += v;
}

static double difference(const char *a, const char *b)
{
    json_t *errors = run_json(run_expect(0, "diff --json", a, b, NULL));
    const double flip = json_number_value(json_object_get(errors, "flip"));
    json_decref(errors);
    return flip;
}

TEST(broken_unwraps_are_replaced_with_one_warning_each)
{
    static const struct {
        const char *name, *fault;
        int first;
        float v;
    } cases[] = {
        { "overlapping", "overlaps itself", 4, -0.3f },
        { "outside", "leaves 0", 4, 0.3f },
        { "not-finite", "is not finite", 7, NAN },
    };
    require_device();
    setenv("AFTERGLOW_CACHE", make_folder("unwrap-cache"), 1);
    const char *plain = render("plain", NULL, NULL);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        float uv[CORNERS][2];
        move(uv, cases[i].first, cases[i].v);
        const char *image = render(cases[i].name, uv, cases[i].fault);
        CHECK(difference(plain, image) == 0.0); // the charts are those without TEXCOORD_1
    }
}

TEST(valid_unwrap_is_used_without_a_warning)
{
    require_device();
    setenv("AFTERGLOW_CACHE", make_folder("valid-cache"), 1);
    const char *plain = render("without", NULL, NULL), *image = render("with", valid, NULL);
    CHECK(difference(plain, image) < 0.05);
}

// ---- figures

static double number_of(const json_t *report, const char *group, const char *name)
{
    const json_t *value =
        json_object_get(json_object_get(json_object_get(report, "quality"), group), name);
    assert_non_null(value);
    return json_number_value(value);
}

// Charts of normals replace two islands on one place.
TEST(light_maps_of_valid_and_of_overlapping_coordinates_have_no_overlap)
{
    float overlapping[CORNERS][2];
    move(overlapping, 4, -0.4f);
    setenv("AFTERGLOW_CACHE", make_folder("overlap-cache"), 1);
    for (int broken = 0; broken < 2; broken++) {
        const char *scene = write_sheet(broken ? "twice" : "once", broken ? overlapping : valid);
        const struct run *r =
            run_expect(0, "bake --gi radiosity:texels=2048 --spp 1 --json --lightmap",
                       test_path(broken ? "maps-twice" : "maps-once"), scene, NULL);
        assert_int_equal(strstr(r->err, "overlaps itself") != NULL, broken);
        json_t *report = run_json(r);
        CHECK(number_of(report, "overlaps", "shared") == 0.0);
        CHECK(number_of(report, "overlaps", "folded") == 0.0);
        CHECK(number_of(report, "charts", "unwrapped") == (broken ? 0.0 : 1.0));
        json_decref(report);
    }
}

// ---- info

TEST(info_has_charts_texels_and_density_of_the_light_map)
{
    const char *scene = write_sheet("sheet", valid);
    const struct run *r = run_expect(0, "info --json", scene, NULL);
    json_t *info = run_json(r);
    const json_t *map = json_object_get(info, "light_map");
    const double texels = json_number_value(json_object_get(map, "texels"));
    const double charts = json_number_value(json_object_get(map, "charts"));
    const double density = json_number_value(json_object_get(map, "texels_per_m"));
    CHECK_STRING(json_string_value(json_object_get(map, "technique")), "radiosity");
    CHECK(charts == 1); // 2 without the unwrap
    // 4 m by 8 m at this density, and the texels that the border touches.
    const double side = 4.0 * density;
    CHECK(texels >= 2 * side * side && texels <= (side + 2) * (2 * side + 2));
    CHECK_NEAR(texels, 65536, 4096);
    json_decref(info);
    char line[200];
    snprintf(line, sizeof line, "light map    %.0f texels in 1 charts, %.3g each, %.3g per metre",
             texels, texels, density);
    r = run_expect(0, "info", scene, NULL);
    if (!strstr(r->out, line)) fail_msg("no \"%s\" in %s", line, r->out);
}
