// Properties of all built-in scenes, and published measurements.
#include "framework/test.h"

#include "scene/builtin/builtin.h"
#include "scene/pose.h"
#include "scene/view/raycast.h"

#include "core/rng.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct scene *load(const char *spec)
{
    struct scene *scene = builtin_load(test_host(), spec);
    CHECK(scene);
    return scene;
}

static vec3s corner_of(const struct mesh *mesh, uint32_t index)
{
    return mesh->positions[mesh->indices[index]];
}

// Twice the area along the normal of triangle t.
static vec3s area_normal(const struct mesh *mesh, uint32_t t)
{
    vec3s a = corner_of(mesh, 3 * t), b = corner_of(mesh, 3 * t + 1),
          c = corner_of(mesh, 3 * t + 2);
    return glms_vec3_cross(glms_vec3_sub(b, a), glms_vec3_sub(c, a));
}

static double mesh_area(const struct mesh *mesh)
{
    double area = 0;
    for (uint32_t t = 0; t < mesh->index_count / 3; t++) {
        area += 0.5 * (double)glms_vec3_norm(area_normal(mesh, t));
    }
    return area;
}

static const struct mesh *mesh_named(const struct scene *scene, const char *name)
{
    for (int i = 0; i < scene->mesh_count; i++) {
        if (strcmp(scene->meshes[i].name, name) == 0) return &scene->meshes[i];
    }
    fail_msg("no mesh \"%s\" in %s", name, scene->name);
    return NULL;
}

static void check_triangles(const struct mesh *mesh)
{
    vec3s size = box3_size(mesh->bounds);
    float extent = fmaxf(size.x, fmaxf(size.y, size.z));
    for (uint32_t t = 0; t < mesh->index_count / 3; t++) {
        vec3s normal = area_normal(mesh, t);
        float doubled_area = glms_vec3_norm(normal);
        if (doubled_area <= 1e-9f * extent * extent) {
            fail_msg("triangle %u of \"%s\" has no area", t, mesh->name);
        }
        for (uint32_t k = 0; k < 3; k++) {
            vec3s vertex_normal = mesh->normals[mesh->indices[3 * t + k]];
            if (glms_vec3_dot(normal, vertex_normal) <= 0.2f * doubled_area) {
                fail_msg("triangle %u of \"%s\" winds against its normal", t, mesh->name);
            }
        }
    }
}

static void check_mesh(const struct scene *scene, const struct mesh *mesh)
{
    CHECK(mesh->index_count > 0 && mesh->index_count % 3 == 0);
    CHECK(mesh->material >= 0 && mesh->material < scene->material_count);
    for (uint32_t i = 0; i < mesh->index_count; i++) CHECK(mesh->indices[i] < mesh->vertex_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        CHECK_NEAR(glms_vec3_norm(mesh->normals[v]), 1, 1e-4);
        if (!mesh->tangents) continue;
        vec3s tangent = vec3_xyz(mesh->tangents[v]);
        CHECK_NEAR(glms_vec3_norm(tangent), 1, 1e-3);
        CHECK_NEAR(fabsf(mesh->tangents[v].w), 1, 0);
    }
    check_triangles(mesh);
}

static void check_scene(const struct scene *scene)
{
    CHECK(scene->mesh_count > 0 && scene->instance_count == scene->mesh_count);
    for (int i = 0; i < scene->mesh_count; i++) check_mesh(scene, &scene->meshes[i]);
    CHECK(scene->camera_count >= 1);
    CHECK_STRING(scene->cameras[0].name, "main");
    CHECK(scene->light_count > 0 || scene_has_emission(scene));
}

TEST(every_builtin_is_well_formed)
{
    for (int i = 0; builtin_scenes[i]; i++) {
        char spec[64];
        snprintf(spec, sizeof spec, "@%s", builtin_scenes[i]->name);
        struct scene *scene = load(spec);
        CHECK_STRING(scene->name, spec);
        check_scene(scene);
        scene_destroy(scene);
    }
}

TEST(every_builtin_is_the_same_for_the_same_options)
{
    for (int i = 0; builtin_scenes[i]; i++) {
        struct scene *a = load(builtin_scenes[i]->name), *b = load(builtin_scenes[i]->name);
        CHECK(a->content_hash == b->content_hash && a->content_hash != 0);
        CHECK(a->mesh_count == b->mesh_count && a->image_count == b->image_count);
        for (int m = 0; m < a->mesh_count; m++) {
            const struct mesh *p = &a->meshes[m], *q = &b->meshes[m];
            CHECK(p->vertex_count == q->vertex_count && p->index_count == q->index_count);
            CHECK(memcmp(p->positions, q->positions, p->vertex_count * sizeof(vec3s)) == 0);
            CHECK(memcmp(p->normals, q->normals, p->vertex_count * sizeof(vec3s)) == 0);
            CHECK(memcmp(p->indices, q->indices, p->index_count * sizeof(uint32_t)) == 0);
        }
        scene_destroy(a);
        scene_destroy(b);
    }
}

// "name=value" for an option at its minimum or maximum.
static void write_limit(const struct option_row *row, int end, char *out, size_t size)
{
    double value = end ? row->max : row->min;
    if (row->type == OPTION_TYPE_choice) {
        const char *choice = row->unit;
        for (int skip = (int)value; skip > 0; skip--) choice = strchr(choice, '|') + 1;
        snprintf(out, size, "%s=%.*s", row->name, (int)strcspn(choice, "|"), choice);
    } else {
        snprintf(out, size, "%s=%.9g", row->name, value);
    }
}

TEST(every_option_builds_at_its_minimum_and_maximum)
{
    for (int i = 0; builtin_scenes[i]; i++) {
        const struct option_table *table = &builtin_scenes[i]->options;
        for (size_t r = 0; r < 2 * table->count; r++) {
            char option[64], spec[128];
            write_limit(&table->rows[r / 2], (int)(r % 2), option, sizeof option);
            snprintf(spec, sizeof spec, "@%s:%s", builtin_scenes[i]->name, option);
            struct scene *scene = load(spec);
            for (int m = 0; m < scene->mesh_count; m++) check_mesh(scene, &scene->meshes[m]);
            scene_destroy(scene);
        }
    }
}

TEST(an_unknown_name_is_refused_with_a_suggestion)
{
    CHECK(!builtin_load(test_host(), "@cornel"));
    CHECK(strstr(test_last_message(), "@cornell"));
    CHECK(!builtin_load(test_host(), "@cornell:ligth=point"));
    CHECK(strstr(test_last_message(), "light"));
    CHECK(!builtin_load(test_host(), "@cornell:light=candle"));
    CHECK(!builtin_load(test_host(), "@"));
    CHECK(strstr(test_last_message(), "@cornell") && strstr(test_last_message(), "@diagonal"));
    CHECK(!builtin_load(test_host(), "@a_name_that_is_very_much_longer_than_any_that_there_is"));
}

// A directed edge between welded points.
struct edge {
    vec3s from, to;
};

static int compare_points(vec3s a, vec3s b)
{
    for (int axis = 0; axis < 3; axis++) {
        if (a.raw[axis] != b.raw[axis]) return a.raw[axis] < b.raw[axis] ? -1 : 1;
    }
    return 0;
}

static int compare_edges(const void *a, const void *b)
{
    const struct edge *p = a, *q = b;
    int order = compare_points(p->from, q->from);
    return order ? order : compare_points(p->to, q->to);
}

// The number of edges of the meshes first…last whose two directions are not equally frequent: 0 for
// closed surfaces.
static size_t count_open_edges(const struct scene *scene, int first, int last)
{
    size_t count = 0, open = 0;
    for (int m = first; m <= last; m++) count += scene->meshes[m].index_count;
    struct edge *edges = malloc(2 * count * sizeof *edges), *reversed = edges + count;
    CHECK(edges);
    size_t e = 0;
    for (int m = first; m <= last; m++) {
        const struct mesh *mesh = &scene->meshes[m];
        for (uint32_t i = 0; i < mesh->index_count; i++) {
            uint32_t next = i % 3 == 2 ? i - 2 : i + 1;
            edges[e] = (struct edge){ corner_of(mesh, i), corner_of(mesh, next) };
            reversed[e] = (struct edge){ edges[e].to, edges[e].from };
            e++;
        }
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    qsort(reversed, count, sizeof *reversed, compare_edges);
    for (size_t a = 0, b = 0; a < count || b < count;) {
        int order = a == count ? 1 : b == count ? -1 : compare_edges(&edges[a], &reversed[b]);
        open += order != 0;
        a += order <= 0;
        b += order >= 0;
    }
    free(edges);
    return open;
}

TEST(cornell_has_the_published_dimensions)
{
    struct scene *scene = load("@cornell");
    const struct mesh *floor = mesh_named(scene, "floor"), *back = mesh_named(scene, "back wall");
    struct box3 ceiling = mesh_named(scene, "ceiling")->bounds;
    CHECK_NEAR(box3_size(ceiling).x, 5.56, 1e-5);
    CHECK_NEAR(box3_size(ceiling).z, 5.592, 1e-5);
    CHECK_NEAR(ceiling.min.y, 5.488, 1e-5);
    // Trapezia: the floor is 552.8 wide in front and 549.6 at the back, the back wall 549.6 below
    // and 556 above.
    CHECK_RELATIVE(mesh_area(floor), 0.5 * (5.528 + 5.496) * 5.592, 1e-6);
    CHECK_RELATIVE(mesh_area(back), 0.5 * (5.496 + 5.56) * 5.488, 1e-6);
    CHECK_RELATIVE(mesh_area(mesh_named(scene, "green wall")), 5.592 * 5.488, 1e-6);
    CHECK_RELATIVE(mesh_area(mesh_named(scene, "light")), 1.30 * 1.05, 1e-6);
    CHECK_RELATIVE(mesh_area(mesh_named(scene, "ceiling")), 5.56 * 5.592 - 1.30 * 1.05, 1e-6);
    CHECK_NEAR(mesh_named(scene, "tall block")->bounds.max.y, 3.30, 1e-6);
    CHECK_NEAR(mesh_named(scene, "short block")->bounds.max.y, 1.65, 1e-6);
    scene_destroy(scene);
}

TEST(cornell_opens_towards_plus_z_with_red_to_the_left)
{
    struct scene *scene = load("@cornell");
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0));
    struct world_camera camera = pose_camera(&pose, 0);
    CHECK_NEAR(camera.eye.z, 8.0 + 2.796, 1e-5);
    CHECK_NEAR(camera.forward.z, -1, 1e-6);
    CHECK_NEAR(camera.vertical_fov_rad, 39.3077 * GLM_PI / 180, 1e-5);
    CHECK(mesh_named(scene, "red wall")->bounds.max.x < -2.7f);
    CHECK(mesh_named(scene, "green wall")->bounds.min.x > 2.7f);
    CHECK(mesh_named(scene, "back wall")->bounds.max.z < -2.7f);
    // The surfaces face inwards.
    CHECK(mesh_named(scene, "floor")->normals[0].y > 0.99f);
    CHECK(mesh_named(scene, "ceiling")->normals[0].y < -0.99f);
    CHECK(mesh_named(scene, "light")->normals[0].y < -0.99f);
    CHECK(mesh_named(scene, "back wall")->normals[0].z > 0.99f);
    CHECK(mesh_named(scene, "red wall")->normals[0].x > 0.99f);
    CHECK(mesh_named(scene, "green wall")->normals[0].x < -0.99f);
    pose_finish(&pose);
    scene_destroy(scene);
}

TEST(cornell_point_light_has_the_power_of_the_quad)
{
    struct scene *quad = load("@cornell:power=2"), *point = load("@cornell:light=point,power=2");
    CHECK(quad->light_count == 0 && scene_has_emission(quad));
    CHECK(point->light_count == 1 && !scene_has_emission(point));
    const struct mesh *light = mesh_named(quad, "light");
    for (int c = 0; c < 3; c++) {
        double quad_lumens =
            GLM_PI * mesh_area(light) * (double)quad->materials[light->material].emissive.raw[c];
        CHECK_RELATIVE(4 * GLM_PI * (double)point->lights[0].intensity.raw[c], quad_lumens, 1e-5);
    }
    // Without the light the ceiling has no hole.
    CHECK_RELATIVE(mesh_area(mesh_named(point, "ceiling")), 5.56 * 5.592, 1e-6);
    scene_destroy(quad);
    scene_destroy(point);
}

TEST(cornell_is_closed_where_it_should_be)
{
    struct scene *scene = load("@cornell:walls=0.2");
    int blocks = 0;
    for (int m = 0; m < scene->mesh_count; m++) {
        if (!strstr(scene->meshes[m].name, "block")) continue;
        CHECK(count_open_edges(scene, m, m) == 0);
        blocks++;
    }
    CHECK(blocks == 2);
    CHECK(count_open_edges(scene, 0, scene->mesh_count - 1) == 0);
    scene_destroy(scene);
    scene = load("@cornell:walls=0,blocks=0"); // open at the front only
    CHECK(count_open_edges(scene, 0, scene->mesh_count - 1) == 8);
    scene_destroy(scene);
}

// All meshes but the light, a single quad.
static void check_closed(const char *spec)
{
    struct scene *scene = load(spec);
    int last = scene->mesh_count - 1;
    if (strcmp(scene->meshes[last].name, "light") == 0 && scene->meshes[last].index_count == 6) {
        last--;
    }
    size_t open = count_open_edges(scene, 0, last);
    if (open > 0) fail_msg("%s has %zu open edges", spec, open);
    scene_destroy(scene);
}

TEST(rooms_are_closed_so_that_no_light_leaks)
{
    static const char *const specs[] = {
        "@corridor",
        "@corridor:width=3,length=12",
        "@maze",
        "@maze:blocks=1",
        "@maze:blocks=64",
        "@maze:blocks=20,seed=7",
        "@maze:blocks=3,pillars=4",
        "@tunnel",
        "@tunnel:pieces=1",
        "@tunnel:pieces=64",
        "@tunnel:pieces=20,seed=9",
        "@spheres",
        "@spheres:furnace=1",
        "@diagonal",
        "@atrium",
        "@planter",
    };
    for (size_t i = 0; i < sizeof specs / sizeof *specs; i++) check_closed(specs[i]);
}

TEST(the_object_of_a_corridor_is_movable_and_closed)
{
    check_closed("@corridor:object=true");
    struct scene *scene = load("@corridor:object=true");
    int movable = 0;
    for (int i = 0; i < scene->instance_count; i++) movable += scene->instances[i].movable;
    assert_int_equal(movable, 1);
    scene_destroy(scene);
}

TEST(a_maze_has_the_requested_number_of_blocks)
{
    for (int blocks = 1; blocks <= 64; blocks += 9) {
        char spec[64];
        snprintf(spec, sizeof spec, "@maze:blocks=%d,size=2", blocks);
        struct scene *scene = load(spec);
        // A tree of n blocks has n - 1 passages, each as long as a wall is thick, 0.16 m.
        const struct mesh *floor = mesh_named(scene, "floor");
        double area = 0;
        for (uint32_t t = 0; t < floor->index_count / 3; t++) {
            vec3s normal = area_normal(floor, t);
            if (normal.y > 0) area += 0.5 * (double)normal.y;
        }
        CHECK_RELATIVE(area, blocks * 1.84 * 1.84 + (blocks - 1) * 1.84 * 0.16, 1e-5);
        scene_destroy(scene);
    }
}

TEST(sphere_and_point_lights_have_the_same_luminous_flux)
{
    struct scene *ball = load("@maze:lumens=5000");
    struct scene *point = load("@maze:lumens=5000,light=point");
    const struct mesh *light = mesh_named(ball, "light");
    double radiance = (double)luminance(ball->materials[light->material].emissive);
    CHECK_RELATIVE(GLM_PI * radiance * 4 * GLM_PI * 0.12 * 0.12, 5000, 1e-4);
    CHECK_RELATIVE(4 * GLM_PI * (double)luminance(point->lights[0].intensity), 5000, 1e-4);
    scene_destroy(ball);
    scene_destroy(point);
}

TEST(the_furnace_has_one_emissive_material)
{
    struct scene *scene = load("@spheres:furnace=1,albedo=0.25,radiance=10");
    CHECK(scene->mesh_count == 1 && scene->light_count == 0);
    CHECK_NEAR(scene->materials[0].emissive.y, 10, 0);
    CHECK_NEAR(scene->materials[0].base_color.y, 0.25, 0);
    CHECK_RELATIVE(mesh_area(&scene->meshes[0]), 6 * 4.0 * 4.0 + 6 * 4.4 * 4.4, 1e-5);
    scene_destroy(scene);
}

TEST(the_sun_of_the_atrium_lights_floor_wall_and_cloth)
{
    struct scene *scene = load("@atrium");
    size_t triangles = scene_triangle_count(scene);
    CHECK(triangles >= 16000 && triangles <= 40000);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0));
    CHECK_NEAR(mesh_named(scene, "floor")->bounds.max.x - mesh_named(scene, "floor")->bounds.min.x,
               25, 1e-4);
    vec3s towards = glms_vec3_negate(pose_light(&pose, 0).direction);
    struct raycast raycast;
    CHECK(raycast_init(&raycast, test_host(), &pose));
    // The floor of the courtyard is partly lit, mostly in its far half; the floor of the aisles
    // is not.
    int courtyard = 0, aisle = 0;
    for (int i = 0; i < 400; i++) {
        float x = -11.5f + 23.0f * (float)i / 399.0f;
        vec3s far_half = vec3_of(x, 0.01f, -1.5f), in_aisle = vec3_of(x, 0.01f, 5.5f);
        courtyard += !raycast_blocked(&raycast, far_half, towards, INFINITY);
        aisle += !raycast_blocked(&raycast, in_aisle, towards, INFINITY);
    }
    CHECK(courtyard > 200 && courtyard < 400 && aisle == 0);
    // A ray down from above the courtyard always hits: no hole in the floor.
    for (int i = 0; i < 2000; i++) {
        vec2s u = r2_sequence((uint32_t)i);
        vec3s above = vec3_of(-12 + 24 * u.x, 30, -7 + 14 * u.y);
        CHECK(raycast_blocked(&raycast, above, vec3_of(0.01f, -1, 0.02f), 31));
    }
    raycast_finish(&raycast);
    pose_finish(&pose);
    scene_destroy(scene);
}

// The fraction of the sun-facing vertices of a mesh that are lit; ray origins are offset along the
// normal.
static double sunlit_fraction(const struct scene *scene, const struct scene_pose *pose,
                              const char *name)
{
    struct raycast raycast;
    CHECK(raycast_init(&raycast, test_host(), pose));
    const struct mesh *mesh = mesh_named(scene, name);
    vec3s towards = glms_vec3_negate(pose_light(pose, 0).direction);
    int lit = 0, facing = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (glms_vec3_dot(mesh->normals[v], towards) <= 0) continue;
        vec3s from = glms_vec3_muladds(mesh->normals[v], 0.01f, mesh->positions[v]);
        lit += !raycast_blocked(&raycast, from, towards, INFINITY);
        facing++;
    }
    raycast_finish(&raycast);
    CHECK(facing > 0);
    return (double)lit / facing;
}

TEST(the_planter_is_shaded_and_its_drape_sunlit)
{
    struct scene *scene = load("@planter");
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0));
    // Partly: the arch is lower than the drape, and folds shade each other.
    CHECK(sunlit_fraction(scene, &pose, "drape") > 0.2);
    CHECK(sunlit_fraction(scene, &pose, "planter") == 0 &&
          sunlit_fraction(scene, &pose, "plant") == 0);
    CHECK(mesh_named(scene, "drape")->bounds.max.x < mesh_named(scene, "plant")->bounds.min.x);
    pose_finish(&pose);
    scene_destroy(scene);
}

TEST(plain_and_textured_planters_have_the_same_geometry)
{
    struct scene *plain = load("@planter:textures=false"), *painted = load("@planter");
    CHECK(plain->image_count == 0 && painted->image_count > 0);
    CHECK(scene_triangle_count(plain) == scene_triangle_count(painted));
    scene_destroy(plain);
    scene_destroy(painted);
}

TEST(the_floor_camera_sees_only_shaded_floor)
{
    struct scene *scene = load("@planter");
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0));
    CHECK_STRING(scene->cameras[1].name, "floor");
    struct world_camera camera = pose_camera(&pose, 1);
    vec3s towards = glms_vec3_negate(pose_light(&pose, 0).direction);
    struct raycast raycast;
    CHECK(raycast_init(&raycast, test_host(), &pose));
    float half = camera.eye.y * tanf(0.5f * camera.vertical_fov_rad);
    for (int i = 0; i < 1000; i++) {
        vec2s u = r2_sequence((uint32_t)i); // aspect ratio 4:3
        vec3s at = vec3_of(camera.eye.x + half * 4.0f / 3.0f * (2 * u.x - 1), 0.01f,
                           camera.eye.z + half * (2 * u.y - 1));
        vec3s to_camera = glms_vec3_sub(camera.eye, at);
        CHECK(!raycast_blocked(&raycast, at, to_camera, 1.0f));
        CHECK(raycast_blocked(&raycast, at, towards, INFINITY));
    }
    raycast_finish(&raycast);
    pose_finish(&pose);
    scene_destroy(scene);
}
