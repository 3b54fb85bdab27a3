// Radiosity of emissive surfaces.
#include "emission.h"

#include <string.h>

// Points farther than this from every block, in its edges, light nothing.
static const float BEYOND = 0.25f;

// Area of texel `local` of a tile: the wall's derivatives along s and t at its centre.
static float texel_area(const struct mrt_emission *e, const struct mrt_tile *tile, int local)
{
    int n = e->atlas->resolution;
    float s = ((float)(local % n) + 0.5f) / (float)n, t = ((float)(local / n) + 0.5f) / (float)n;
    mat3s frame = cube_from_face(tile->face);
    mat3s j =
        mrt_warp_jacobian(e->map->blocks[tile->block].corner, cube_face_point(tile->face, s, t));
    vec3s u = glms_mat3_mulv(j, frame.col[0]), v = glms_mat3_mulv(j, frame.col[1]);
    return glms_vec3_norm(glms_vec3_cross(u, v)) / (float)(n * n);
}

bool mrt_emission_init(struct mrt_emission *out, struct host *host, const struct mrt_block_map *map,
                       const struct mrt_atlas *atlas)
{
    *out =
        (struct mrt_emission){ .host = host, .map = map, .atlas = atlas, .texels = atlas->texels };
    out->area_m2 = host_alloc(host, (size_t)atlas->texels, sizeof *out->area_m2);
    out->radiosity = host_alloc(host, (size_t)atlas->texels, sizeof *out->radiosity);
    if (!out->area_m2 || !out->radiosity) return false;
    int in_tile = atlas->resolution * atlas->resolution;
    for (int i = 0; i < atlas->texels; i++)
        out->area_m2[i] = texel_area(out, &atlas->tiles[i / in_tile], i % in_tile);
    return true;
}

void mrt_emission_finish(struct mrt_emission *emission)
{
    if (!emission->host) return;
    host_free(emission->host, emission->area_m2);
    host_free(emission->host, emission->radiosity);
    *emission = (struct mrt_emission){ 0 };
}

static int texel_of(const struct mrt_atlas *atlas, int block, const struct mrt_wall_point *point)
{
    int n = atlas->resolution;
    int x = (int)(point->s * (float)n), y = (int)(point->t * (float)n);
    if (x >= n) x = n - 1;
    if (y >= n) y = n - 1;
    const int tile = atlas->tile_of_face[CUBE_FACES * block + point->face];
    return atlas->tiles[tile].first_texel + y * n + x;
}

void mrt_emission_update(struct mrt_emission *emission, const struct frame_view *view)
{
    memset(emission->radiosity, 0, (size_t)emission->texels * sizeof *emission->radiosity);
    const float unscaled = 1.0f / view->constants->radiance_scale;
    for (int i = 0; i < view->emitter_count; i++) {
        const struct frame_emitter *point = &view->emitters[i];
        struct mrt_wall_point wall;
        int block =
            mrt_block_of_surface(emission->map, point->position, point->normal, BEYOND, &wall);
        if (block < 0) continue;
        int texel = texel_of(emission->atlas, block, &wall);
        emission->radiosity[texel] = glms_vec3_muladds(
            point->flux, unscaled / emission->area_m2[texel], emission->radiosity[texel]);
    }
    emission->valid = true;
}
