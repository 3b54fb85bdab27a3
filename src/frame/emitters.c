// Virtual point lights on emissive triangles. Radiance is computed once per scene; areas and points
// whenever an emissive instance moves.
#include "frame/emitters.h"

#include "frame/emission_map.h"

#include "scene/mesh_parts.h"

#include "core/rng.h"
#include "core/sampling.h"

#include <math.h>
#include <string.h>

static const float BLEND_CUTOFF = 0.5f; // blended materials are drawn as masks
// Upper limit of subdivisions of a triangle's edge when its maps are averaged.
enum { MAX_STRATA = 32 };

// Maps of an emissive material; unused ones have no levels.
struct emission_maps {
    struct emission_map color, mask;
    float cutoff; // of the mask
};

struct emitter_triangle {
    vec3s radiance; // mean, cd/m²
    float area_m2;
    float part_extent; // diagonal of the bounds of its connected part, in the mesh's unit
};

struct emitter_instance {
    int instance;
    const struct mesh *mesh;
    const struct material *material;
    const struct emission_maps *maps;
    uint64_t revision; // of instance, mesh or material, the newest
    size_t first;      // index of its first triangle
    bool areas_valid;  // for world_from_mesh
    mat4s world_from_mesh;
    float scale; // largest one of world_from_mesh along an axis
};

static size_t triangle_count(const struct mesh *mesh)
{
    return mesh->index_count / 3;
}

// ---- Radiance, once per scene -------------------------------------------------------------------

static bool is_emissive(const struct material *m)
{
    return m->emissive.x > 0.0f || m->emissive.y > 0.0f || m->emissive.z > 0.0f;
}

// Alpha cutoff of the base-colour map's texels; negative: not masked.
static float texel_cutoff(const struct material *m)
{
    if (m->alpha_mode == ALPHA_OPAQUE) return -1.0f;
    float cutoff = m->alpha_mode == ALPHA_BLEND ? BLEND_CUTOFF : m->alpha_cutoff;
    if (cutoff <= 0.0f) return -1.0f;
    return m->base_color.w > 0.0f ? cutoff / m->base_color.w : INFINITY;
}

static bool make_maps(struct emitters *e, const struct material *m, struct emission_maps *maps)
{
    float cutoff = texel_cutoff(m);
    maps->cutoff = cutoff;
    if (m->emissive_map.image >= 0 && maps->color.level_count == 0 &&
        !emission_map_init_color(&maps->color, e->host, e->scene, &m->emissive_map)) {
        return false;
    }
    return m->base_color_map.image < 0 || cutoff < 0.0f || maps->mask.level_count > 0 ||
           emission_map_init_mask(&maps->mask, e->host, e->scene, &m->base_color_map, cutoff);
}

// Colour maps depend on images alone, masks also on the cutoff.
static void keep_maps(const struct scene *scene, struct emission_maps *from, int count,
                      struct emission_maps *to)
{
    for (int m = 0; m < count; m++) {
        const struct material *material = &scene->materials[m];
        to[m].color = from[m].color;
        to[m].color.use = &material->emissive_map;
        from[m].color = (struct emission_map){ 0 };
        if (from[m].cutoff != texel_cutoff(material)) continue;
        to[m].mask = from[m].mask;
        to[m].mask.use = &material->base_color_map;
        from[m].mask = (struct emission_map){ 0 };
    }
}

// A triangle in texture space; area 1 is the whole image.
struct map_triangle {
    vec2s corner, edges[2];
    float area;
};

static struct map_triangle map_triangle_of(const struct emission_map *map, const struct mesh *mesh,
                                           const uint32_t index[3])
{
    vec2s p[3];
    for (int i = 0; i < 3; i++) p[i] = emission_map_uv(map, mesh->uv[0], mesh->uv[1], index[i]);
    struct map_triangle t = { .corner = p[0],
                              .edges = { glms_vec2_sub(p[1], p[0]), glms_vec2_sub(p[2], p[0]) } };
    t.area = 0.5f * fabsf(glms_vec2_cross(t.edges[0], t.edges[1]));
    return t;
}

static vec3s map_mean(const struct emission_map *map, const struct map_triangle *t, vec2s at,
                      float share)
{
    vec2s uv = glms_vec2_add(t->corner, glms_vec2_add(glms_vec2_scale(t->edges[0], at.x),
                                                      glms_vec2_scale(t->edges[1], at.y)));
    return emission_map_mean(map, uv, t->area * share);
}

// Emission of one triangle: a factor, an emissive map, an alpha mask.
struct emission {
    const struct emission_maps *maps;
    vec3s factor; // cd/m²
    struct map_triangle color, mask;
};

static struct emission emission_of(const struct emitter_instance *it, size_t triangle)
{
    const uint32_t *index = &it->mesh->indices[3 * triangle];
    struct emission e = { .maps = it->maps,
                          .factor = glms_vec3_maxv(it->material->emissive, vec3_of(0, 0, 0)) };
    // A mask without a map keeps or discards the whole surface.
    if (it->material->base_color_map.image < 0 && texel_cutoff(it->material) > 1.0f)
        e.factor = vec3_of(0, 0, 0);
    if (e.maps->color.level_count) e.color = map_triangle_of(&e.maps->color, it->mesh, index);
    if (e.maps->mask.level_count) e.mask = map_triangle_of(&e.maps->mask, it->mesh, index);
    return e;
}

static bool is_mapped(const struct emission *e)
{
    return e->maps->color.level_count > 0 || e->maps->mask.level_count > 0;
}

// Mean radiance around the barycentric coordinates `at`, over a share of the triangle's area.
static vec3s radiance_at(const struct emission *e, vec2s at, float share)
{
    vec3s l = e->factor;
    if (e->maps->color.level_count)
        l = glms_vec3_mul(l, map_mean(&e->maps->color, &e->color, at, share));
    if (e->maps->mask.level_count)
        l = glms_vec3_mul(l, map_mean(&e->maps->mask, &e->mask, at, share));
    return l;
}

// Subdivisions of an edge for footprints a third of a finest-level texel wide.
static int strata_of(const struct emission *e)
{
    const struct emission_level *color = &e->maps->color.levels[0];
    const struct emission_level *mask = &e->maps->mask.levels[0];
    float texels = fmaxf(e->color.area * (float)color->width * (float)color->height,
                         e->mask.area * (float)mask->width * (float)mask->height);
    return (int)fminf(fmaxf(ceilf(3.0f * sqrtf(texels)), 1.0f), (float)MAX_STRATA);
}

// Mean over n² equal subtriangles, sampled at their centroids.
static vec3s mean_radiance(const struct emission *e)
{
    if (!is_mapped(e)) return e->factor;
    int n = strata_of(e);
    float step = 1.0f / (float)n, share = step * step;
    vec3s sum = vec3_of(0, 0, 0);
    for (int j = 0; j < n; j++) {
        for (int i = 0; i + j < n; i++) {
            vec2s at = { { ((float)i + 1.0f / 3.0f) * step, ((float)j + 1.0f / 3.0f) * step } };
            sum = glms_vec3_add(sum, radiance_at(e, at, share));
            if (i + j + 1 >= n) continue;
            at = glms_vec2_adds(at, step / 3.0f); // the other half of the parallelogram
            sum = glms_vec3_add(sum, radiance_at(e, at, share));
        }
    }
    return glms_vec3_scale(sum, share);
}

static struct box3 triangle_bounds(const struct mesh *mesh, size_t triangle)
{
    struct box3 box = box3_empty();
    for (size_t i = 0; i < 3; i++)
        box = box3_add_point(box, mesh->positions[mesh->indices[3 * triangle + i]]);
    return box;
}

static bool fill_part_extents(struct emitters *e, const struct mesh *mesh,
                              struct emitter_triangle *out)
{
    const size_t triangles = triangle_count(mesh);
    uint32_t *part = host_alloc(e->host, triangles, sizeof *part);
    const int parts = part ? mesh_parts(e->host, mesh, part) : -1;
    struct box3 *bounds = parts < 0 ? NULL : host_alloc(e->host, (size_t)parts, sizeof *bounds);
    for (int i = 0; bounds && i < parts; i++) bounds[i] = box3_empty();
    for (size_t t = 0; bounds && t < triangles; t++)
        bounds[part[t]] = box3_union(bounds[part[t]], triangle_bounds(mesh, t));
    for (size_t t = 0; bounds && t < triangles; t++)
        out[t].part_extent = glms_vec3_norm(box3_size(bounds[part[t]]));
    const bool done = bounds != NULL;
    host_free(e->host, bounds);
    host_free(e->host, part);
    return done;
}

// Radiance and connected parts.
static bool fill_triangles(struct emitters *e, const struct emitter_instance *it)
{
    struct emitter_triangle *out = &e->triangles[it->first];
    for (const struct emitter_instance *other = e->instances; other < it; other++) {
        if (other->mesh != it->mesh) continue;
        memcpy(out, &e->triangles[other->first], triangle_count(it->mesh) * sizeof *out);
        return true;
    }
    for (size_t t = 0; t < triangle_count(it->mesh); t++) {
        struct emission emission = emission_of(it, t);
        out[t].radiance = mean_radiance(&emission);
    }
    return fill_part_extents(e, it->mesh, out);
}

// From instance `from` on: the index of the first one with emission, or their number.
static int next_emissive(const struct scene *scene, int from)
{
    for (; from < scene->instance_count; from++) {
        const struct mesh *mesh = scene_mesh_of(scene, from);
        if (mesh->index_count > 0 && is_emissive(&scene->materials[mesh->material])) break;
    }
    return from;
}

static uint64_t newest_of(const struct scene *scene, int instance)
{
    const struct mesh *mesh = scene_mesh_of(scene, instance);
    uint64_t newest = scene->instances[instance].added;
    if (mesh->revision > newest) newest = mesh->revision;
    const uint64_t material = scene->materials[mesh->material].revision;
    return material > newest ? material : newest;
}

static bool list_instances(struct emitters *e)
{
    const struct scene *scene = e->scene;
    size_t triangles = 0;
    for (int i = next_emissive(scene, 0); i < scene->instance_count;
         i = next_emissive(scene, i + 1)) {
        const struct mesh *mesh = scene_mesh_of(scene, i);
        const struct material *material = &scene->materials[mesh->material];
        if (!make_maps(e, material, &e->maps[mesh->material])) return false;
        e->instances[e->instance_count++] = (struct emitter_instance){
            .instance = i,
            .mesh = mesh,
            .material = material,
            .maps = &e->maps[mesh->material],
            .revision = newest_of(scene, i),
            .first = triangles,
        };
        if (!size_add(triangles, triangle_count(mesh), &triangles))
            return host_fail(e->host, FAIL_MEMORY, "scene %s: too many emissive triangles",
                             scene->name);
    }
    e->triangles = host_alloc(e->host, triangles, sizeof *e->triangles);
    if (!e->triangles) return false;
    for (int i = 0; i < e->instance_count; i++)
        if (!fill_triangles(e, &e->instances[i])) return false;
    return true;
}

// maps: [map_count] of an earlier state of the scene, moved where they are still valid.
static bool init(struct emitters *out, struct host *host, const struct scene *scene,
                 struct emission_maps *maps, int map_count)
{
    *out = (struct emitters){ .host = host,
                              .scene = scene,
                              .map_count = scene->material_count,
                              .revision = scene->revisions.newest };
    out->maps = host_alloc(host, (size_t)scene->material_count, sizeof *out->maps);
    if (out->maps) keep_maps(scene, maps, map_count, out->maps);
    out->instances = host_alloc(host, (size_t)scene->instance_count, sizeof *out->instances);
    if (!out->maps || !out->instances || !list_instances(out)) return false;
    size_t capacity = out->instance_count ? EMITTERS_MAX : 1; // a storage block is never empty
    out->points = host_alloc(host, capacity, sizeof *out->points);
    out->scaled = host_alloc(host, capacity, sizeof *out->scaled);
    out->origins = host_alloc(host, capacity, sizeof *out->origins);
    return out->points && out->scaled && out->origins;
}

bool emitters_init(struct emitters *out, struct host *host, const struct scene *scene)
{
    return init(out, host, scene, NULL, 0);
}

// Whether the list has exactly the emissive instances of the scene, unchanged.
static bool is_current(const struct emitters *e)
{
    const struct scene *scene = e->scene;
    int at = next_emissive(scene, 0);
    for (int i = 0; i < e->instance_count; i++, at = next_emissive(scene, at + 1)) {
        if (at >= scene->instance_count || e->instances[i].instance != at ||
            e->instances[i].revision != newest_of(scene, at))
            return false;
    }
    return at >= scene->instance_count;
}

// The arrays of the scene may be elsewhere.
static void refer(struct emitters *e)
{
    for (int i = 0; i < e->instance_count; i++) {
        struct emitter_instance *it = &e->instances[i];
        it->mesh = scene_mesh_of(e->scene, it->instance);
        it->material = &e->scene->materials[it->mesh->material];
    }
}

bool emitters_follow(struct emitters *e)
{
    struct emitters made;
    if (e->revision == e->scene->revisions.newest) return true;
    if (is_current(e)) {
        refer(e);
        e->revision = e->scene->revisions.newest;
        return true;
    }
    const bool ok = init(&made, e->host, e->scene, e->maps, e->map_count);
    if (ok) {
        emitters_finish(e);
        *e = made;
    } else {
        emitters_finish(&made);
    }
    return ok;
}

void emitters_finish(struct emitters *e)
{
    if (!e->host) return;
    for (int m = 0; e->maps && m < e->map_count; m++) {
        emission_map_finish(&e->maps[m].color, e->host);
        emission_map_finish(&e->maps[m].mask, e->host);
    }
    host_free(e->host, e->maps);
    host_free(e->host, e->instances);
    host_free(e->host, e->triangles);
    host_free(e->host, e->points);
    host_free(e->host, e->scaled);
    host_free(e->host, e->origins);
    *e = (struct emitters){ 0 };
}

// ---- Areas, after movement ----------------------------------------------------------------------

// A triangle in world space.
struct world_triangle {
    vec3s corner, edges[2];
    vec3s normal;  // unit, front side
    float area_m2; // 0: degenerate
};

static struct world_triangle world_triangle_of(const struct emitter_instance *it,
                                               const struct scene_pose *pose, size_t triangle,
                                               bool mirrored)
{
    const uint32_t *index = &it->mesh->indices[3 * triangle];
    const vec3s *deformed = pose->deformed[it->instance].positions;
    vec3s p[3];
    for (int i = 0; i < 3; i++)
        p[i] = deformed ? deformed[index[i]]
                        : mat4_point(it->world_from_mesh, it->mesh->positions[index[i]]);
    struct world_triangle t = { .corner = p[0],
                                .edges = { glms_vec3_sub(p[1], p[0]), glms_vec3_sub(p[2], p[0]) } };
    vec3s cross = glms_vec3_cross(t.edges[0], t.edges[1]);
    float length = glms_vec3_norm(cross);
    if (!(length > 0.0f) || !isfinite(length)) return t;
    t.area_m2 = 0.5f * length;
    t.normal = glms_vec3_scale(cross, (mirrored ? -1.0f : 1.0f) / length);
    return t;
}

static float largest_scale(const mat4s *m)
{
    float most = 0.0f;
    for (int axis = 0; axis < 3; axis++) most = fmaxf(most, glms_vec3_norm(vec3_xyz(m->col[axis])));
    return most;
}

// False if no emissive instance moved. Deformed instances always count as moved.
static bool update_areas(struct emitters *e, const struct scene_pose *pose)
{
    bool changed = false;
    for (int i = 0; i < e->instance_count; i++) {
        struct emitter_instance *it = &e->instances[i];
        mat4s world_from_mesh = pose_world_from_instance(pose, it->instance);
        if (it->areas_valid && !pose->deformed[it->instance].positions &&
            memcmp(&it->world_from_mesh, &world_from_mesh, sizeof world_from_mesh) == 0) {
            continue;
        }
        it->areas_valid = changed = true;
        it->world_from_mesh = world_from_mesh;
        it->scale = largest_scale(&world_from_mesh);
        struct emitter_triangle *triangles = &e->triangles[it->first];
        for (size_t t = 0; t < triangle_count(it->mesh); t++)
            triangles[t].area_m2 = world_triangle_of(it, pose, t, false).area_m2;
    }
    return changed;
}

// ---- Points -------------------------------------------------------------------------------------

struct flux {
    double channel[3];
};

static struct flux flux_of(const struct emitter_triangle *t)
{
    struct flux f;
    for (int c = 0; c < 3; c++)
        f.channel[c] = GLM_PI * (double)t->radiance.raw[c] * (double)t->area_m2;
    return f;
}

static double power(const struct flux *f)
{
    return (f->channel[0] + f->channel[1] + f->channel[2]) / 3.0;
}

static double root_flux_area(const struct emitter_triangle *t, const struct flux *f)
{
    return sqrt(power(f) * (double)t->area_m2);
}

// Progress of the point allocation over all sides of all triangles.
struct allocation {
    double total_power, total_root_flux_area;
    double expected; // points for the sides so far
    int placed;
    struct flux carried; // lumen of sides that got no point
    double carried_m2;   // their area
};

static void measure(const struct emitters *e, struct allocation *a)
{
    for (int i = 0; i < e->instance_count; i++) {
        const struct emitter_instance *it = &e->instances[i];
        double sides = it->material->double_sided ? 2.0 : 1.0;
        for (size_t t = 0; t < triangle_count(it->mesh); t++) {
            struct flux f = flux_of(&e->triangles[it->first + t]);
            a->total_power += sides * power(&f);
            a->total_root_flux_area += sides * root_flux_area(&e->triangles[it->first + t], &f);
        }
    }
}

// R2 sequence (Roberts 2018) that starts at the centroid, folded at the diagonal.
static vec2s r2_in_triangle(uint32_t i)
{
    vec2s first = r2_sequence(0), at = r2_sequence(i);
    for (int axis = 0; axis < 2; axis++) {
        float x = at.raw[axis] - first.raw[axis] + 1.0f / 3.0f;
        at.raw[axis] = x - floorf(x);
    }
    return at.x + at.y > 1.0f ? (vec2s){ { 1.0f - at.x, 1.0f - at.y } } : at;
}

// Places `count` points on one side; they share `flux` in proportion to the radiance around each.
static void place_on_side(struct frame_emitter *out, int count, const struct world_triangle *side,
                          const struct emission *emission, const struct flux *flux)
{
    struct flux sum = { { 0 } };
    for (int i = 0; i < count; i++) {
        vec2s at = r2_in_triangle((uint32_t)i);
        out[i].position =
            glms_vec3_add(side->corner, glms_vec3_add(glms_vec3_scale(side->edges[0], at.x),
                                                      glms_vec3_scale(side->edges[1], at.y)));
        out[i].normal = side->normal;
        out[i].flux = radiance_at(emission, at, 1.0f / (float)count);
        for (int c = 0; c < 3; c++) sum.channel[c] += (double)out[i].flux.raw[c];
    }
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < count; i++) {
            double share = sum.channel[c] > 0.0 ? (double)out[i].flux.raw[c] / sum.channel[c]
                                                : 1.0 / (double)count;
            out[i].flux.raw[c] = (float)(flux->channel[c] * share);
        }
    }
}

static void place_on_triangle(struct emitters *e, struct allocation *a,
                              const struct scene_pose *pose, const struct emitter_instance *it,
                              size_t t, bool back, bool mirrored)
{
    const struct emitter_triangle *triangle = &e->triangles[it->first + t];
    struct flux f = flux_of(triangle);
    if (!(power(&f) > 0.0)) return;
    double share = 0.5 * power(&f) / a->total_power +
                   0.5 * root_flux_area(triangle, &f) / a->total_root_flux_area;
    a->expected += share * EMITTERS_MAX;
    for (int c = 0; c < 3; c++) a->carried.channel[c] += f.channel[c];
    a->carried_m2 += (double)triangle->area_m2;
    int until = (int)fmin(floor(a->expected + 0.5), EMITTERS_MAX);
    if (until <= a->placed) return;
    struct world_triangle side = world_triangle_of(it, pose, t, mirrored != back);
    struct emission emission = emission_of(it, t);
    place_on_side(&e->points[a->placed], until - a->placed, &side, &emission, &a->carried);
    for (int i = a->placed; i < until; i++)
        e->origins[i] = (struct frame_emitter_origin){
            .instance = it->instance,
            .back = back,
            .area_m2 = (float)(a->carried_m2 / (double)(until - a->placed)),
            .part_extent_m = triangle->part_extent * it->scale,
        };
    a->placed = until;
    a->carried = (struct flux){ { 0 } };
    a->carried_m2 = 0.0;
}

// All front sides, then all back sides: with alternating sides, rounding would favour one of them.
static void place_points(struct emitters *e, const struct scene_pose *pose)
{
    struct allocation a = { 0 };
    measure(e, &a);
    e->count = 0;
    e->flux = vec3_of(0, 0, 0);
    if (!(a.total_power > 0.0) || !isfinite(a.total_power)) return;
    for (int back = 0; back < 2; back++) {
        for (int i = 0; i < e->instance_count; i++) {
            const struct emitter_instance *it = &e->instances[i];
            if (back && !it->material->double_sided) continue;
            bool mirrored = pose_is_mirrored(pose, it->instance);
            for (size_t t = 0; t < triangle_count(it->mesh); t++)
                place_on_triangle(e, &a, pose, it, t, back != 0, mirrored);
        }
    }
    e->count = a.placed;
    double total[3] = { 0 };
    for (int i = 0; i < e->count; i++)
        for (int c = 0; c < 3; c++) total[c] += (double)e->points[i].flux.raw[c];
    for (int c = 0; c < 3; c++) {
        // Rounding may leave sides after the last point.
        e->points[e->count - 1].flux.raw[c] += (float)a.carried.channel[c];
        e->flux.raw[c] = (float)(total[c] + a.carried.channel[c]);
    }
}

void emitters_update(struct emitters *e, const struct scene_pose *pose)
{
    if (update_areas(e, pose)) place_points(e, pose);
}

void emitters_scale(struct emitters *e, float radiance_scale)
{
    for (int i = 0; i < e->count; i++) {
        e->scaled[i] = e->points[i];
        e->scaled[i].flux = glms_vec3_scale(e->points[i].flux, radiance_scale);
    }
}

// ---- Irradiance ---------------------------------------------------------------------------------

static double distance_to_exit(struct box3 box, vec3s from, vec3s direction)
{
    double least = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        double d = (double)direction.raw[axis];
        if (d == 0.0) continue;
        double wall = (double)(d > 0.0 ? box.max.raw[axis] : box.min.raw[axis]);
        least = fmin(least, fmax((wall - (double)from.raw[axis]) / d, 0.0));
    }
    return isfinite(least) ? least : 0.0;
}

vec3s emitters_irradiance(const struct emitters *e, struct box3 bounds)
{
    vec3s none = vec3_of(0, 0, 0);
    if (e->count == 0 || box3_is_empty(bounds)) return none;
    vec3s size = box3_size(bounds);
    double volume = (double)size.x * (double)size.y * (double)size.z;
    if (!(volume > 0.0) || !isfinite(volume)) return none;
    double sum[3] = { 0 };
    for (int i = 0; i < e->count; i++) {
        const struct frame_emitter *p = &e->points[i];
        double path_m = 2.0 / 3.0 * distance_to_exit(bounds, p->position, p->normal);
        for (int c = 0; c < 3; c++) sum[c] += (double)p->flux.raw[c] * path_m;
    }
    return vec3_of((float)(sum[0] / (4.0 * volume)), (float)(sum[1] / (4.0 * volume)),
                   (float)(sum[2] / (4.0 * volume)));
}
