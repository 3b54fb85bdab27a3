// Where light is shown: places of the light map and of triangles in it.
#include "techniques/radiosity/radiosity_state.h"

struct pair {
    uint32_t x, y;
};

// Places that show no texel are not in the table.
bool radiosity_upload_owners(struct radiosity *s, const uint32_t *shown)
{
    const size_t places = charts_place_count(&s->map.charts);
    struct pair *owners = host_alloc(s->host, light_map_table_room(places), sizeof *owners);
    for (size_t i = 0; owners && i < places; i++) {
        const uint32_t texel = chart_texel_of_place(&s->map.charts, i);
        if (texel == CHART_NONE) continue;
        owners[s->owner_places++] =
            (struct pair){ light_map_place_word(&s->map.charts, i), shown[texel] };
    }
    return light_map_table_upload(s->host, s->gpu, "owners", GPU_RG32U, owners, s->owner_places,
                                  &s->tables.owners);
}

bool radiosity_upload_triangles(struct radiosity *s)
{
    const struct radiosity_map *map = &s->map;
    const size_t count = map->charts.triangle_0[s->instances];
    struct light_map_triangle *triangles = host_alloc(s->host, count, sizeof *triangles);
    uint32_t *first = host_alloc(s->host, (size_t)s->instances + 1, sizeof *first);
    if (triangles)
        light_map_fill_triangles(&map->charts, map->charts.chart_triangle, count, triangles);
    for (uint32_t i = 0; first && i <= s->instances; i++)
        first[i] = (uint32_t)map->charts.triangle_0[i];
    s->tables.surfaces.count = s->instances;
    const bool ok = radiosity_buffer_upload(s, "triangles", triangles, count * sizeof *triangles,
                                            &s->tables.surfaces.triangles);
    return radiosity_buffer_upload(s, "first_triangles", first,
                                   ((size_t)s->instances + 1) * sizeof *first,
                                   &s->tables.surfaces.first) &&
           ok;
}
