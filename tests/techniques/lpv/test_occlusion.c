// Light behind a wall between emitter and receiver.
#include "techniques/lpv/mesh_fixture.h"

#include <math.h>

enum { SIZE = 64, WIDTH = 16, PIXELS = WIDTH * WIDTH };

static const float ROOM = 8, WALL = 4.13f; // m; not on a face between cells

// No wall, or a wall of `height` with a reflective shadow map of its own.
static void set_wall(struct rsm_fixture *rsm, float height)
{
    const float texel = ROOM / SIZE;
    rsm_fixture_set_face(rsm, 1, vec3_of(0, 0, WALL), vec3_of(ROOM, 0, 0), vec3_of(0, ROOM, 0),
                         vec3_of(0, 0, 1e-3f),
                         vec3_of(texel * texel, texel * texel, texel * texel));
    rsm->faces[1].type = FRAME_LIGHT_SUN;
    rsm->faces[1].light = 1;
    rsm->faces[1].direction = vec3_of(0, 0, 1);
    rsm->faces[1].tan_half = ROOM / 2;
    for (uint32_t y = 0; y < SIZE; y++)
        for (uint32_t x = 0; x < SIZE; x++) {
            const bool is_wall = ((float)y + 0.5f) * texel < height;
            *rsm_fixture_texel(rsm, 1, x, y) =
                (struct rsm_fixture_texel){ .depth = is_wall ? 1.0f : 0.0f,
                                            .normal = vec3_of(0, 0, -1) };
        }
}

// Mean irradiance of the wall z = ROOM in lumen/m² when the wall z = 0 of a black room emits
// 1 lumen/m² and a wall of `height` stands between them.
static double irradiance_behind(struct gpu *gpu, const char *gi, float height)
{
    struct rsm_fixture rsm;
    struct mesh_fixture meshes;
    rsm_fixture_init(&rsm, gpu, WIDTH, WIDTH, SIZE, 2);
    rsm.view.bounds = (struct box3){ vec3_of(0, 0, 0), vec3_of(ROOM, ROOM, ROOM) };
    const float lumen = ROOM * ROOM / (SIZE * SIZE);
    rsm_fixture_set_face(&rsm, 0, vec3_of(0, 0, 0), vec3_of(ROOM, 0, 0), vec3_of(0, ROOM, 0),
                         vec3_of(0, 0, 1e-3f), vec3_of(lumen, lumen, lumen));
    rsm_fixture_fill_face(&rsm, 0,
                          (struct rsm_fixture_texel){ .depth = 1,
                                                      .normal = vec3_of(0, 0, 1),
                                                      .reflectance = { 255, 255, 255 } });
    set_wall(&rsm, height);
    rsm_fixture_show_wall(&rsm, vec3_of(0.02f, 0.02f, ROOM - 0.01f), vec3_of(ROOM - 0.04f, 0, 0),
                          vec3_of(0, ROOM - 0.04f, 0), vec3_of(0, 0, -1));
    rsm.constants.camera_position = vec3_of(ROOM / 2, ROOM / 2, ROOM / 2);
    rsm_fixture_upload(&rsm);
    mesh_fixture_init(&meshes, &rsm);
    if (height > 0)
        // Beyond the room, through the grid's margin.
        mesh_fixture_add_wall(&meshes, vec3_of(-1, -1, WALL), vec3_of(ROOM + 2, 0, 0),
                              vec3_of(0, height < ROOM ? height + 1 : ROOM + 2, 0));
    mesh_fixture_place(&meshes);
    struct lpv *lpv = lpv_fixture_create(gpu, gi);
    mesh_fixture_render(&meshes, lpv);
    float got[PIXELS * 3];
    double sum = 0.0;
    rsm_fixture_read_irradiance(&rsm, got);
    for (int i = 0; i < PIXELS; i++) sum += (double)got[3 * i] / PIXELS;
    lpv_fixture_destroy(lpv);
    mesh_fixture_finish(&meshes);
    rsm_fixture_finish(&rsm);
    return sum;
}

// A wall of the room's height occludes all light; without the geometry volume none.
TEST_GPU(lpv_is_dark_behind_a_wall)
{
    const char *with[] = { "lpv:dim=24,geometry=scene", "lpv:dim=24,geometry=maps,occlusion=1.5",
                           "holpv:dim=24,geometry=scene", "holpv:dim=24,geometry=maps" };
    const char *without[] = { "lpv:dim=24,geometry=off", "lpv:dim=24,geometry=off",
                              "holpv:dim=24,geometry=off", "holpv:dim=24,geometry=off" };
    for (int i = 0; i < 4; i++) {
        const double open = irradiance_behind(gpu, with[i], 0),
                     leak = irradiance_behind(gpu, with[i], ROOM),
                     off = irradiance_behind(gpu, without[i], ROOM);
        print_message("%-28s behind the wall %.4f lm/m², without the wall %.4f (%.1f %%); "
                      "geometry=off: %.4f\n",
                      with[i], leak, open, 100.0 * leak / open, off);
        CHECK(open > 0.05); // the form factor of facing walls of a cube is 0.2
        CHECK(leak < 0.1 * open);
        CHECK(off > 0.9 * irradiance_behind(gpu, without[i], 0));
    }
}

// Half a wall occludes some of the light.
TEST_GPU(lpv_is_dim_behind_half_a_wall)
{
    const char *with[] = { "lpv:dim=24", "lpv:dim=24,geometry=maps", "holpv:dim=24",
                           "holpv:dim=24,geometry=maps" };
    for (int i = 0; i < 4; i++) {
        const double open = irradiance_behind(gpu, with[i], 0),
                     half = irradiance_behind(gpu, with[i], ROOM / 2);
        print_message("%-28s behind half a wall %.1f %%\n", with[i], 100.0 * half / open);
        CHECK(half > 0.2 * open && half < 0.8 * open);
    }
}
