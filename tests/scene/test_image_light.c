// EXT_lights_image_based: each direction shows the texel of the cube that is there, and a light
// that is not usable is one warning or one failure.
#include "scene/image_light_maker.h"

#include "scene/environment/environment_map.h"

// Directions of a face in the scene: of its centre, and of columns and rows of its image.
static const struct {
    vec3s centre, right, down;
} FACES[MADE_FACES] = {
    { { { 1, 0, 0 } }, { { 0, 0, 1 } }, { { 0, 1, 0 } } },
    { { { -1, 0, 0 } }, { { 0, 0, -1 } }, { { 0, 1, 0 } } },
    { { { 0, 1, 0 } }, { { 1, 0, 0 } }, { { 0, 0, 1 } } },
    { { { 0, -1, 0 } }, { { 1, 0, 0 } }, { { 0, 0, -1 } } },
    { { { 0, 0, -1 } }, { { 1, 0, 0 } }, { { 0, 1, 0 } } },
    { { { 0, 0, 1 } }, { { -1, 0, 0 } }, { { 0, 1, 0 } } },
};

static vec3s towards(int face, float right, float down)
{
    const vec3s d = glms_vec3_muladds(FACES[face].right, right, FACES[face].centre);
    return glms_vec3_normalize(glms_vec3_muladds(FACES[face].down, down, d));
}

static vec3s quadrant(int face, bool right, bool lower)
{
    return vec3_of(srgb_decode((float)(40 * (face + 1)) / 255.0f),
                   srgb_decode((right ? 200.0f : 60.0f) / 255.0f),
                   srgb_decode((lower ? 220.0f : 80.0f) / 255.0f));
}

static void check_radiance(const struct scene *scene, vec3s direction, vec3s expected)
{
    const vec3s found = environment_radiance(&scene->environment, direction);
    for (int c = 0; c < 3; c++) CHECK_RELATIVE(found.raw[c], expected.raw[c], 1e-4);
}

// turn: of the light in the scene.
static void check_quadrants(const struct scene *scene, versors turn, float scale)
{
    for (int i = 0; i < 4 * MADE_FACES; i++) {
        const bool right = i & 1, lower = i & 2;
        const vec3s d = towards(i / 4, right ? 0.5f : -0.5f, lower ? 0.5f : -0.5f);
        check_radiance(scene, glms_quat_rotatev(turn, d),
                       glms_vec3_scale(quadrant(i / 4, right, lower), scale));
    }
}

static void check_light(const char *light, uint8_t alpha, versors turn, float scale)
{
    struct made_faces made = { 0 };
    quadrants(&made, alpha);
    struct scene *scene = load_light(&made, ALL_FACES, light);
    if (!scene) fail_msg("%s", test_last_message());
    assert_non_null(scene->environment.map);
    check_quadrants(scene, turn, scale);
    scene_destroy(scene);
}

TEST(each_direction_shows_its_face)
{
    check_light("", 255, glms_quat_identity(), 1.0f);
}

TEST(alpha_divides_and_intensity_multiplies)
{
    check_light(",'intensity':3", 51, glms_quat_identity(), 15.0f);
    check_light("", 0, glms_quat_identity(), 255.0f);
}

TEST(rotations_turn_the_light)
{
    check_light(",'rotation':[0,0.70710678,0,0.70710678]", 255,
                glms_quatv(GLM_PI_2f, vec3_of(0, 1, 0)), 1.0f);
    check_light(",'rotation':[0.70710678,0,0,0.70710678]", 255,
                glms_quatv(GLM_PI_2f, vec3_of(1, 0, 0)), 1.0f);
    // A direction of any length.
    check_light(",'rotation':[0.3,0.4,-0.2,0.6]", 255,
                glms_quat_normalize((versors){ { 0.3f, 0.4f, -0.2f, 0.6f } }), 1.0f);
}

// The difference between two directions that are close to each other is small across edges too.
TEST(faces_meet_at_their_edges)
{
    enum { SIZE = 32 };
    struct made_faces made = { 0 };
    uint8_t rgba[SIZE * SIZE][4];
    for (int face = 0; face < MADE_FACES; face++) {
        for (int i = 0; i < SIZE * SIZE; i++) {
            const float x = (2.0f * (float)(i % SIZE) + 1.0f) / SIZE - 1.0f;
            const float y = (2.0f * (float)(i / SIZE) + 1.0f) / SIZE - 1.0f;
            const vec3s d = towards(face, x, y);
            for (int c = 0; c < 3; c++)
                rgba[i][c] = (uint8_t)(255.0f * srgb_encode(0.5f + 0.4f * d.raw[c]) + 0.5f);
            rgba[i][3] = 255;
        }
        add_face(&made, face, rgba[0], SIZE, SIZE);
    }
    struct scene *scene = load_light(&made, ALL_FACES, "");
    assert_non_null(scene);
    for (int i = 0; i < 1000; i++) {
        const float z = -1.0f + (float)i / 500.0f, r = sqrtf(1.0f - z * z), a = 2.4f * (float)i;
        const vec3s d = vec3_of(r * cosf(a), z, r * sinf(a));
        const vec3s found = environment_radiance(&scene->environment, d);
        for (int c = 0; c < 3; c++) CHECK_NEAR(found.raw[c], 0.5f + 0.4f * d.raw[c], 0.02);
    }
    scene_destroy(scene);
}

// ---- lights that are not usable

static void expect_refusal(const char *images, const char *light, const char *message)
{
    struct made_faces made = { 0 };
    quadrants(&made, 255);
    struct scene *scene = load_light(&made, images, light);
    if (scene || !strstr(test_last_message(), message))
        fail_msg("%s %s: %s", images, light, test_last_message());
}

TEST(invalid_lights_are_refused)
{
    expect_refusal("[[0,1,2,3,4]]", "", "specularImages[0] is not an array of six images");
    expect_refusal("[3]", "", "specularImages[0] is not an array of six images");
    expect_refusal("{}", "", "specularImages is not an array");
    expect_refusal("[[0,1,2,3,4,6]]", "", "specularImages 6 does not exist; there are 6");
    expect_refusal("[[0,1,2,3,4,'x']]", "", "specularImages is not an index");
    expect_refusal(ALL_FACES, ",'intensity':-1", "intensity");
    expect_refusal(ALL_FACES, ",'intensity':1e300", "intensity");
    expect_refusal(ALL_FACES, ",'rotation':[0,0,0,0]", "quaternion");
    expect_refusal(ALL_FACES, ",'rotation':[0,0,0]", "rotation");
}

static void expect_note(const struct made_faces *made, const char *images, const char *message)
{
    struct scene *scene = load_light(made, images, "");
    if (!scene || scene->environment.map || !strstr(test_last_message(), message))
        fail_msg("%s: %s", images, test_last_message());
    scene_destroy(scene);
}

TEST(lights_that_cannot_be_decoded_are_ignored_with_a_warning)
{
    static const uint8_t black[64][4];
    struct made_faces made = { 0 };
    for (int i = 0; i < MADE_FACES; i++) add_face(&made, i, black[0], 8, i == 3 ? 4 : 8);
    expect_note(&made, ALL_FACES, "face -Y: it is not square");
    expect_note(&made, "[]", "it has no specularImages");
    made = (struct made_faces){ 0 };
    for (int i = 0; i < MADE_FACES; i++) add_face(&made, i, black[0], 8 - i / 5, 8 - i / 5);
    expect_note(&made, ALL_FACES, "face -Z: its size is not that of the first face");
    made = (struct made_faces){ 0 };
    quadrants(&made, 255);
    made.bytes[made.offset[2]] = 0;
    expect_note(&made, ALL_FACES, "face +Y: neither JPEG nor PNG");
    made.bytes[made.offset[2]] = 0x89;
    made.length[2] -= 30;
    expect_note(&made, ALL_FACES, "face +Y");
}

// A change of every third byte.
TEST(damaged_files_do_no_harm)
{
    struct made_faces made = { 0 };
    quadrants(&made, 255);
    char *json = light_json(&made, ALL_FACES, ",'rotation':[0,1,0,0]");
    for (size_t i = 0; i < strlen(json); i += 3) {
        char *damaged = strdup(json);
        CHECK(damaged);
        damaged[i] = damaged[i] == '9' ? '-' : '9';
        struct scene *scene = load_gltf(damaged, made.bytes, made.size);
        if (scene) scene_destroy(scene);
        free(damaged);
    }
    free(json);
}
