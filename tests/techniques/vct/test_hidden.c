// Surfaces that hide others on one face of a voxel: the outermost ones count, each in proportion to
// the area that it shows.
#include "techniques/vct/vct_fixture.h"

#include <math.h>

enum { UP = 2, DOWN = 3 }; // faces

struct layers {
    bool moving, double_sided;
    const char *options;
};

static vec3s red(void)
{
    return vec3_of(0.8f, 0, 0);
}

static vec3s green(void)
{
    return vec3_of(0, 0.8f, 0);
}

static int matte(struct frame_fixture *s, vec3s color, bool double_sided)
{
    struct material m = material_default();
    m.base_color = vec4_of(color, 1);
    m.metallic = 0;
    m.specular = 0;
    m.double_sided = double_sided;
    return fixture_material(s, &m);
}

static int add_sheet(struct frame_fixture *s, float height, float end, int material)
{
    return fixture_quad(s, vec3_of(0.5f, height, 0.5f), vec3_of(0.5f, height, 11.5f),
                        vec3_of(end, height, 11.5f), vec3_of(end, height, 0.5f), material);
}

static void move_slightly(struct frame_fixture *s, int instance)
{
    mat4s *world = &s->pose.world_from_node[s->scene->instances[instance].node];
    *world = glms_translate(*world, vec3_of(0, 0, 0.125f));
}

// Voxels of 1 m. In the layer from 5 to 6 m a red sheet, slightly above it a green one that ends at
// x = 6.5.
static void check_layers(struct gpu *gpu, const struct layers *layers)
{
    struct vct_fixture fixture;
    struct frame_fixture *s = &fixture.frame_fixture;
    vct_fixture_init(&fixture, gpu);
    fixture_box(s, vec3_of(0, 0, 0), vec3_of(12, 12, 12), true, matte(s, red(), false));
    const int sheets[2] = {
        add_sheet(s, 5.4f, 11.5f, matte(s, red(), layers->double_sided)),
        add_sheet(s, 5.5f, 6.5f, matte(s, green(), layers->double_sided)),
    };
    fixture_look(s, vec3_of(1, 10, 11), vec3_of(6, 5, 6));
    vct_fixture_open(&fixture, layers->options);
    fixture_render(s);
    for (int i = 0; i < 2 && layers->moving; i++) move_slightly(s, sheets[i]);
    if (layers->moving) fixture_render(s);
    const struct vct_grid *grid = &fixture.vct->clipmap.levels[0].grid;
    const struct vct_level_voxels *voxels = &fixture.vct->voxels.levels[0];
    CHECK(grid->cell_m == 1.0f && grid->origin_m.x == 0.0f);
    const struct vct_voxel_set *set = layers->moving ? &voxels->dynamic_set : &voxels->static_set;
    const vec3s above[3] = { green(), glms_vec3_lerp(red(), green(), 0.5f), red() };
    for (int i = 0; i < 3; i++) {
        vec3s color;
        CHECK(vct_fixture_reflectance(&fixture, set, (int[3]){ 5 + i, 5, 6 }, UP, &color));
        CHECK_NEAR(glms_vec3_distance(color, above[i]), 0, 0.003);
        const bool below =
            vct_fixture_reflectance(&fixture, set, (int[3]){ 5 + i, 5, 6 }, DOWN, &color);
        CHECK(below == layers->double_sided);
        if (below) CHECK_NEAR(glms_vec3_distance(color, red()), 0, 0.003);
    }
    vct_fixture_finish(&fixture);
}

TEST_GPU(a_hidden_sheet_does_not_count)
{
    check_layers(gpu, &(struct layers){ false, false, "resolution=16" });
    check_layers(gpu, &(struct layers){ false, true, "resolution=16" });
}

TEST_GPU(a_hidden_moving_sheet_does_not_count)
{
    check_layers(gpu, &(struct layers){ true, true, "resolution=16" });
}

TEST_GPU(a_hidden_rasterized_sheet_does_not_count)
{
    check_layers(gpu, &(struct layers){ false, true, "resolution=16,voxels=raster" });
}
