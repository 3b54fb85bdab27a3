// Generated normals and tangents.
#include "framework/test.h"

#include "scene/mesh_geometry.h"

#include <math.h>

static struct arena arena;

// A square in the plane z = 0, facing +z. The image is upright: u to the right, v down.
static struct mesh square(bool mirrored)
{
    static vec3s positions[4] = {
        { { 0, 0, 0 } }, { { 1, 0, 0 } }, { { 1, 1, 0 } }, { { 0, 1, 0 } }
    };
    static vec3s normals[4] = {
        { { 0, 0, 1 } }, { { 0, 0, 1 } }, { { 0, 0, 1 } }, { { 0, 0, 1 } }
    };
    static vec2s straight_uv[4] = { { { 0, 1 } }, { { 1, 1 } }, { { 1, 0 } }, { { 0, 0 } } };
    static vec2s mirrored_uv[4] = { { { 1, 1 } }, { { 0, 1 } }, { { 0, 0 } }, { { 1, 0 } } };
    static uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    return (struct mesh){ .vertex_count = 4,
                          .index_count = 6,
                          .positions = positions,
                          .normals = normals,
                          .uv = { mirrored ? mirrored_uv : straight_uv },
                          .indices = indices };
}

TEST(tangents_follow_u_and_the_bitangent_points_up_in_the_image)
{
    arena_init(&arena, test_host());
    struct texture_use map = texture_use_none();
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        struct mesh mesh = square(mirrored);
        CHECK(mesh_make_tangents(&arena, &mesh, &map) && mesh.tangents);
        CHECK(mesh.vertex_count == 4);
        for (uint32_t v = 0; v < 4; v++) {
            vec3s t = vec3_xyz(mesh.tangents[v]);
            CHECK_NEAR(t.x, mirrored ? -1.0 : 1.0, 1e-6);
            vec3s bitangent =
                glms_vec3_scale(glms_vec3_cross(mesh.normals[v], t), mesh.tangents[v].w);
            CHECK_NEAR(bitangent.y, 1.0, 1e-6); // against v
        }
    }
    arena_finish(&arena);
}

TEST(a_rotated_map_rotates_its_tangents)
{
    arena_init(&arena, test_host());
    struct texture_use map = texture_use_none();
    map.uv_rotation_rad = 0.5f;
    struct mesh mesh = square(false);
    CHECK(mesh_make_tangents(&arena, &mesh, &map));
    // Texture coordinates rotated counter-clockwise by 0.5 rad rotate the u axis clockwise.
    CHECK_NEAR(mesh.tangents[0].x, cosf(0.5f), 1e-6);
    CHECK_NEAR(mesh.tangents[0].y, -sinf(0.5f), 1e-6);
    arena_finish(&arena);
}

TEST(vertices_between_mirrored_and_unmirrored_triangles_are_duplicated)
{
    arena_init(&arena, test_host());
    // Two triangles share the edge 0-1; u increases away from it on both sides.
    vec3s positions[4] = { { { 0, 0, 0 } }, { { 0, 1, 0 } }, { { 1, 0, 0 } }, { { -1, 0, 0 } } };
    vec3s normals[4];
    vec2s uv[4] = { { { 0, 1 } }, { { 0, 0 } }, { { 1, 1 } }, { { 1, 1 } } };
    uint32_t indices[6] = { 0, 2, 1, 0, 1, 3 };
    for (int v = 0; v < 4; v++) normals[v] = vec3_of(0, 0, 1);
    struct mesh mesh = { .vertex_count = 4,
                         .index_count = 6,
                         .positions = positions,
                         .normals = normals,
                         .uv = { uv },
                         .indices = indices };
    struct texture_use map = texture_use_none();
    CHECK(mesh_make_tangents(&arena, &mesh, &map));
    CHECK(mesh.vertex_count == 6);
    for (uint32_t i = 0; i < 6; i++) {
        vec4s t = mesh.tangents[mesh.indices[i]];
        CHECK_NEAR(t.x, i < 3 ? 1.0 : -1.0, 1e-6);
        CHECK_NEAR(t.w, i < 3 ? 1.0 : -1.0, 0.0);
        CHECK_NEAR(mesh.positions[mesh.indices[i]].x, positions[indices[i]].x, 0.0);
    }
    arena_finish(&arena);
}

TEST(equal_vertices_share_their_tangent_also_when_duplicated_in_the_file)
{
    arena_init(&arena, test_host());
    // A bent strip with smooth normals; the direction of u differs between the two triangles.
    vec3s p[4] = { { { 0, 0, 0 } }, { { 1, 0, 0 } }, { { 1, 1, 0 } }, { { 0, 1, 0.5f } } };
    vec2s t[4] = { { { 0, 1 } }, { { 1, 0.8f } }, { { 1, 0 } }, { { 0.2f, 0 } } };
    uint32_t shared[6] = { 0, 1, 2, 0, 2, 3 }, apart[6] = { 0, 1, 2, 3, 4, 5 };
    vec3s normals[6], positions[6];
    vec2s uv[6];
    for (int i = 0; i < 6; i++) {
        normals[i] = glms_vec3_normalize(vec3_of(0.1f, 0.2f, 1));
        positions[i] = p[shared[i]];
        uv[i] = t[shared[i]];
    }
    struct mesh a = { .vertex_count = 4,
                      .index_count = 6,
                      .positions = p,
                      .normals = normals,
                      .uv = { t },
                      .indices = shared };
    struct mesh b = { .vertex_count = 6,
                      .index_count = 6,
                      .positions = positions,
                      .normals = normals,
                      .uv = { uv },
                      .indices = apart };
    struct texture_use map = texture_use_none();
    CHECK(mesh_make_tangents(&arena, &a, &map) && mesh_make_tangents(&arena, &b, &map));
    for (int i = 0; i < 6; i++) {
        vec4s want = a.tangents[a.indices[i]], got = b.tangents[b.indices[i]];
        for (int k = 0; k < 4; k++) CHECK_NEAR(got.raw[k], want.raw[k], 0.0);
        CHECK_NEAR(glms_vec3_dot(vec3_xyz(got), normals[0]), 0.0, 1e-6);
        CHECK_NEAR(glms_vec3_norm(vec3_xyz(got)), 1.0, 1e-6);
    }
    arena_finish(&arena);
}

TEST(degenerate_triangles_get_unit_normals_and_tangents)
{
    arena_init(&arena, test_host());
    vec3s positions[3] = { { { 1, 1, 1 } }, { { 1, 1, 1 } }, { { 2, 2, 2 } } };
    vec2s uv[3] = { { { 0, 0 } } };
    uint32_t indices[3] = { 0, 1, 2 };
    struct mesh mesh = { .vertex_count = 3,
                         .index_count = 3,
                         .positions = positions,
                         .uv = { uv },
                         .indices = indices };
    struct texture_use map = texture_use_none();
    CHECK(mesh_make_normals(&arena, &mesh) && mesh_make_tangents(&arena, &mesh, &map));
    for (int v = 0; v < 3; v++) {
        CHECK_NEAR(glms_vec3_norm(mesh.normals[v]), 1.0, 1e-6);
        CHECK_NEAR(glms_vec3_norm(vec3_xyz(mesh.tangents[v])), 1.0, 1e-6);
    }
    arena_finish(&arena);
}

TEST(a_mesh_without_the_texture_coordinates_of_its_map_has_no_tangents)
{
    arena_init(&arena, test_host());
    struct mesh mesh = square(false);
    struct texture_use map = texture_use_none();
    map.uv_set = 1;
    CHECK(mesh_make_tangents(&arena, &mesh, &map) && !mesh.tangents);
    arena_finish(&arena);
}
