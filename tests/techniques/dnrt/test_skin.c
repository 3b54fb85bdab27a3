// Skinned objects: volumes turn with the joints' common ancestor.
#include "frame/frame_fixture.h"
#include "techniques/dnrt/floor_fixture.h"

#include "techniques/dnrt/dnrt_object.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SOURCE "lpv:geometry=off,dim=16,cascades=1,bounces=0,probes=true"

// ---- a board of a body and an arm above it, upright across x

enum { BODY, ARM, JOINTS };
enum { VERTICES = 48, INDICES = 72 };

struct board {
    vec3s positions[VERTICES], normals[VERTICES];
    uint16_t joints[VERTICES][4];
    vec4s weights[VERTICES];
    uint32_t indices[INDICES];
    struct mesh mesh;
};

// Six faces of four vertices: the two axes beside the face's own, so that fronts face outwards.
static void add_box(struct board *b, int joint, vec3s min, vec3s max)
{
    struct mesh *mesh = &b->mesh;
    for (int face = 0; face < 6; face++) {
        const int axis = face / 2, side = face % 2;
        const int u = (axis + (side ? 1 : 2)) % 3, v = (axis + (side ? 2 : 1)) % 3;
        const uint32_t first = mesh->vertex_count, quad[6] = { 0, 1, 2, 0, 2, 3 };
        for (int corner = 0; corner < 4; corner++) {
            const uint32_t at = mesh->vertex_count++;
            vec3s p = side ? max : min;
            p.raw[u] = corner == 1 || corner == 2 ? max.raw[u] : min.raw[u];
            p.raw[v] = corner >= 2 ? max.raw[v] : min.raw[v];
            b->positions[at] = p;
            b->normals[at].raw[axis] = side ? 1.0f : -1.0f;
            b->joints[at][0] = (uint16_t)joint;
            b->weights[at].raw[0] = 1.0f;
        }
        for (int i = 0; i < 6; i++) b->indices[mesh->index_count++] = first + quad[i];
    }
}

static void make_board(struct board *b, int material)
{
    *b = (struct board){ .mesh = { .name = "board", .material = material } };
    b->mesh.positions = b->positions;
    b->mesh.normals = b->normals;
    b->mesh.indices = b->indices;
    b->mesh.joints = b->joints;
    b->mesh.weights = b->weights;
    add_box(b, BODY, vec3_of(-0.5f, 0.1f, -0.04f), vec3_of(0.3f, 0.8f, 0.04f));
    add_box(b, ARM, vec3_of(0.3f, 0.6f, -0.03f), vec3_of(0.6f, 0.7f, 0.03f));
}

// Nodes of a character: an armature where it stands, a joint that moves nothing and turns with
// nothing, the body, and its arm. Its skin's bind pose is the rest pose.
struct character {
    int armature, handle, body, arm, instance;
    int joints[JOINTS + 1];
    mat4s joint_from_mesh[JOINTS + 1];
    struct skin skin;
};

static struct node child_of(int parent, vec3s translation, vec3s axis, float angle)
{
    struct node node = node_default();
    node.parent = parent;
    node.translation = translation;
    node.rotation = glms_quatv(angle, axis);
    return node;
}

static void add_character(struct character *c, struct scene *scene, vec3s at, float turn,
                          int material)
{
    static const vec3s Y = { { 0, 1, 0 } }, Z = { { 0, 0, 1 } };
    struct board board;
    make_board(&board, material);
    const struct node armature = child_of(-1, at, Y, turn);
    *c = (struct character){ .armature = scene_add_node(scene, &armature) };
    const struct node handle = child_of(c->armature, vec3_of(2, 0, 1), Y, 0);
    c->handle = scene_add_node(scene, &handle);
    // Bones along y, as modelling programs have them, on their side: the bind pose undoes it.
    const struct node body = child_of(c->armature, vec3_of(0, 0.4f, 0), Z, 0.5f);
    c->body = scene_add_node(scene, &body);
    const struct node arm = child_of(c->body, vec3_of(0.3f, 0.1f, 0), Z, -0.7f);
    c->arm = scene_add_node(scene, &arm);
    const int joints[] = { c->body, c->arm, c->handle };
    struct scene_pose rest;
    CHECK(pose_init(&rest, scene, -1, 0));
    for (int j = 0; j < JOINTS + 1; j++) {
        c->joints[j] = joints[j];
        c->joint_from_mesh[j] =
            glms_mat4_inv(pose_ancestor_from_node(&rest, c->armature, joints[j]));
    }
    pose_finish(&rest);
    c->skin = (struct skin){ JOINTS + 1, c->joints, c->joint_from_mesh };
    scene->skins = &c->skin;
    scene->skin_count = 1;
    const struct instance instance = {
        .node = c->armature, .mesh = scene_add_mesh(scene, &board.mesh), .skin = 0, .movable = true
    };
    c->instance = scene_add_instance(scene, &instance);
    CHECK(c->instance >= 0);
}

// Its skin is not the scene's own.
static void leave(struct scene *scene)
{
    scene->skins = NULL;
    scene->skin_count = 0;
    scene->animations = NULL;
    scene->animation_count = 0;
}

// ---- its turn, in a second

struct turn {
    float times[2], values[8];
    struct animation_channel channel;
    struct animation animation;
};

static void animate_turn(struct turn *t, struct scene *scene, int node, vec3s axis, float angle)
{
    const versors from = scene->nodes[node].rotation;
    const versors to = glms_quat_mul(glms_quatv(angle, axis), from);
    *t = (struct turn){ .times = { 0, 1 } };
    memcpy(t->values, from.raw, sizeof from.raw);
    memcpy(t->values + 4, to.raw, sizeof to.raw);
    t->channel = (struct animation_channel){ .node = node,
                                             .path = PATH_ROTATION,
                                             .interpolation = INTERPOLATE_LINEAR,
                                             .key_count = 2,
                                             .width = 4,
                                             .times_s = t->times,
                                             .values = t->values };
    t->animation = (struct animation){ "turn", 2, &t->channel, 1 };
    scene->animations = &t->animation;
    scene->animation_count = 1;
}

// ---- frames

static const vec3s AT = { { 0.1f, 0.05f, -0.1f } };
static const float QUARTER = GLM_PI_2f;

enum what { RIGID, SKINNED, ALONE };

// Irradiance of the floor around the board at a time, baked at time 0. The caller frees it.
static float *render(struct gpu *gpu, enum what what, float time)
{
    struct frame_fixture s;
    struct character character;
    struct turn turn;
    fixture_init(&s, gpu);
    fixture_floor(&s, 1.2f, fixture_matte(&s, vec3_of(0.7f, 0.7f, 0.7f)));
    const int red = fixture_matte(&s, vec3_of(0.9f, 0.2f, 0.1f));
    if (what == RIGID) {
        struct board board;
        make_board(&board, red);
        board.mesh.joints = NULL;
        board.mesh.weights = NULL;
        const struct node node = child_of(-1, AT, vec3_of(0, 1, 0), 0);
        const int i = fixture_instance(&s, scene_add_mesh(s.scene, &board.mesh), &node);
        animate_turn(&turn, s.scene, s.scene->instances[i].node, vec3_of(0, 1, 0), QUARTER);
    } else {
        add_character(&character, s.scene, AT, 0, red);
        animate_turn(&turn, s.scene, character.body, vec3_of(0, 1, 0), QUARTER);
    }
    fixture_add_sun(&s, vec3_of(1, -0.3f, 0), vec3_of(3000, 3000, 3000));
    fixture_look(&s, vec3_of(0, 2.4f, 3.4f), vec3_of(0, 0.2f, -0.2f));
    s.input.want_id_layer = true;
    const char *gi = what == ALONE ? SOURCE : SOURCE "+dnrt:size=16,rays=1024";
    float *irradiance = floor_irradiance(&s, gpu, gi, 0, time);
    leave(s.scene);
    fixture_finish(&s);
    return irradiance;
}

// Both are in the pose of the bake, then both have turned by a quarter. Volumes are of the same
// mesh, but for rounding, which lets one ray of a thousand hit where another one misses: of a
// sample's change, that is some thousandths.
TEST_GPU(a_turned_character_has_the_light_of_a_turned_rigid_object)
{
    for (int turned = 0; turned < 2; turned++) {
        float *rigid = render(gpu, RIGID, (float)turned);
        float *skinned = render(gpu, SKINNED, (float)turned);
        float *alone = render(gpu, ALONE, (float)turned);
        const double change = floor_difference(rigid, alone);
        const double error = floor_difference(rigid, skinned);
        print_message("turned by %d degrees: change %g lux, of which the skin differs by %g\n",
                      90 * turned, change, error);
        CHECK(change > 1000 && error < 5e-3 * change);
        free(rigid);
        free(skinned);
        free(alone);
    }
}

// ---- the frame of a character

static void check_close(vec3s a, vec3s b, float within)
{
    for (int i = 0; i < 3; i++) CHECK_NEAR(a.raw[i], b.raw[i], within);
}

static struct dnrt_frame frame_at(const struct scene *scene, float time)
{
    struct scene_pose pose;
    struct dnrt_objects objects;
    struct dnrt_frame frame;
    mat3s stretch;
    CHECK(pose_init(&pose, scene, 0, time));
    CHECK(dnrt_objects_init(&objects, test_host(), &pose, 1, false) && objects.count == 1);
    CHECK(dnrt_object_frame(&objects, &pose, 0, &frame, &stretch));
    dnrt_objects_finish(&objects);
    pose_finish(&pose);
    return frame;
}

// The armature and the handle stand still.
TEST(a_frame_turns_with_the_joint_that_moves_all)
{
    struct scene *scene = scene_create(test_host(), "test");
    struct character c;
    struct turn turn;
    const struct material grey = material_default();
    add_character(&c, scene, AT, 0, scene_add_material(scene, &grey));
    animate_turn(&turn, scene, c.body, vec3_of(0, 1, 0), QUARTER);
    const struct dnrt_frame before = frame_at(scene, 0), after = frame_at(scene, 1);
    check_close(before.rotation.col[0], vec3_of(1, 0, 0), 1e-5f);
    check_close(after.rotation.col[0], vec3_of(0, 0, -1), 1e-5f);
    check_close(after.rotation.col[1], vec3_of(0, 1, 0), 1e-5f);
    const vec3s from = glms_vec3_sub(before.origin, AT), to = glms_vec3_sub(after.origin, AT);
    check_close(to, vec3_of(from.z, from.y, -from.x), 1e-5f);
    leave(scene);
    scene_destroy(scene);
}

TEST(a_frame_does_not_turn_with_an_arm)
{
    struct scene *scene = scene_create(test_host(), "test");
    struct character c;
    struct turn turn;
    const struct material grey = material_default();
    add_character(&c, scene, AT, 0, scene_add_material(scene, &grey));
    animate_turn(&turn, scene, c.arm, vec3_of(0, 0, 1), QUARTER);
    const struct dnrt_frame before = frame_at(scene, 0), after = frame_at(scene, 1);
    for (int i = 0; i < 3; i++) check_close(after.rotation.col[i], before.rotation.col[i], 1e-6f);
    // By a share of the arm's vertices, half of all, of its own way.
    const float moved = glms_vec3_distance(before.origin, after.origin);
    CHECK(moved > 0.05f && moved < 0.3f);
    leave(scene);
    scene_destroy(scene);
}

// The vertices that are baked, of a character that stands somewhere.
static struct deformed_mesh baked_vertices(vec3s at, float turn)
{
    struct scene *scene = scene_create(test_host(), "test");
    struct character c;
    struct scene_pose pose;
    struct dnrt_root root;
    const struct material grey = material_default();
    add_character(&c, scene, at, turn, scene_add_material(scene, &grey));
    scene->nodes[c.arm].rotation = glms_quatv(0.4f, vec3_of(1, 0, 0)); // not of the bind pose
    CHECK(pose_init(&pose, scene, -1, 0));
    CHECK(dnrt_find_root(test_host(), scene, c.instance, &root) && root.node == c.body);
    struct deformed_mesh out = { .positions = calloc(VERTICES, sizeof(vec3s)),
                                 .normals = calloc(VERTICES, sizeof(vec3s)) };
    CHECK(dnrt_deformed_mesh(test_host(), &pose, c.instance, &root, &out));
    pose_finish(&pose);
    leave(scene);
    scene_destroy(scene);
    return out;
}

TEST(baked_vertices_do_not_depend_on_where_a_character_stands)
{
    struct deformed_mesh a = baked_vertices(vec3_of(0, 0, 0), 0);
    struct deformed_mesh b = baked_vertices(vec3_of(7.3f, 0.1f, -20), 1.1f);
    CHECK(memcmp(a.positions, b.positions, VERTICES * sizeof *a.positions) == 0);
    CHECK(memcmp(a.normals, b.normals, VERTICES * sizeof *a.normals) == 0);
    free(a.positions);
    free(a.normals);
    free(b.positions);
    free(b.normals);
}
