// Rows of the EXR files go up: the first one is the lowest, as three.js reads them.
#include "probe_files.h"
#include "cli/files/interrupt.h"
#include "cli/files/json.h"

#include <math.h>
#include <string.h>

enum { COEFFICIENTS = 9, VALUES = 3 * COEFFICIENTS, ATLAS_PARTS = 7, ATLAS_CHANNELS = 4 };

struct files {
    struct ag_context *context;
    const struct ag_probes *probes;
    struct ag_probes_visibility visibility;
    const struct folder *folder;
    int columns; // tiles in a row of the visibility
};

static size_t probe_count(const struct ag_probes *probes)
{
    return (size_t)probes->counts[0] * (size_t)probes->counts[1] * (size_t)probes->counts[2];
}

// ---- images

static float *row_from_below(const struct ag_image *image, int row)
{
    return image->pixels +
           (size_t)(image->height - 1 - row) * (size_t)image->width * (size_t)image->channels;
}

static enum status write_image(const struct files *f, const char *name, struct ag_image *image)
{
    const struct ag_image_layer layer = { "color", image };
    char path[PATH_SIZE];
    if (!folder_file(f->folder, name, path)) return fail("cannot write %s: too long", name);
    interrupt_hold();
    const enum ag_result result = ag_image_write_exr(f->context, path, &layer, 1, NULL, 0);
    interrupt_release();
    if (result == AG_OK) return DONE;
    fail_library(f->context, result);
    return FAILED;
}

static enum status create_image(const struct files *f, int width, int height, int channels,
                                struct ag_image **out)
{
    const enum ag_result result = ag_image_create(f->context, width, height, channels, out);
    if (result == AG_OK) return DONE;
    fail_library(f->context, result);
    return FAILED;
}

// Irradiance over π, 2π/3 and π/4: the radiance whose irradiance it is, band by band.
static float atlas_value(const float *coefficients, int value)
{
    static const float band[] = { 1.0f, 2.0f / 3.0f, 0.25f };
    const int i = value / 3;
    if (value >= VALUES) return 0.0f;
    return coefficients[value] / ((float)M_PI * band[i == 0 ? 0 : i < 4 ? 1 : 2]);
}

// A slice along z of a part: four values of each probe, x fastest.
static void fill_slice(const struct ag_probes *probes, int part, int z, float *row)
{
    const size_t layer = (size_t)probes->counts[0] * (size_t)probes->counts[1];
    for (size_t i = 0; i < layer; i++)
        for (int c = 0; c < ATLAS_CHANNELS; c++)
            row[ATLAS_CHANNELS * i + (size_t)c] = atlas_value(
                probes->coefficients + VALUES * ((size_t)z * layer + i), ATLAS_CHANNELS * part + c);
}

// The 3D texture of three.js' LightProbeGrid, a row for each slice: seven parts, each with its
// first and last slice repeated.
static enum status write_atlas(const struct files *f)
{
    const int *counts = f->probes->counts, depth = counts[2] + 2;
    struct ag_image *image = NULL;
    enum status status =
        create_image(f, counts[0] * counts[1], ATLAS_PARTS * depth, ATLAS_CHANNELS, &image);
    for (int slice = 0; status == DONE && slice < ATLAS_PARTS * depth; slice++) {
        const int z = slice % depth - 1, last = counts[2] - 1;
        fill_slice(f->probes, slice / depth,
                   z < 0      ? 0
                   : z > last ? last
                              : z,
                   row_from_below(image, slice));
    }
    if (status == DONE) status = write_image(f, PROBES_ATLAS, image);
    ag_image_destroy(f->context, image);
    return status;
}

static void fill_tile(const struct files *f, size_t probe, struct ag_image *image)
{
    const int side = f->visibility.tile_side;
    const float *depths =
        f->visibility.depths + 2 * (size_t)side * (size_t)side * probe; // [row][column][2]
    const int left = (int)(probe % (size_t)f->columns) * side,
              low = (int)(probe / (size_t)f->columns) * side;
    for (int i = 0; i < side * side; i++)
        memcpy(row_from_below(image, low + i / side) + 3 * (left + i % side), depths + 2 * i,
               2 * sizeof *depths);
}

static enum status write_visibility(struct files *f)
{
    const size_t count = probe_count(f->probes);
    const int side = f->visibility.tile_side;
    struct ag_image *image = NULL;
    if (f->visibility.kind != AG_PROBES_VISIBILITY_DEPTHS) return DONE;
    f->columns = (int)ceil(sqrt((double)count));
    const int rows = (int)((count + (size_t)f->columns - 1) / (size_t)f->columns);
    enum status status = create_image(f, side * f->columns, side * rows, 3, &image);
    for (size_t i = 0; status == DONE && i < count; i++) fill_tile(f, i, image);
    if (status == DONE) status = write_image(f, PROBES_VISIBILITY, image);
    ag_image_destroy(f->context, image);
    return status;
}

// ---- the document

static json_t *numbers(const float *values, size_t count)
{
    json_t *out = json_array();
    for (size_t i = 0; i < count; i++) json_array_append_new(out, json_double((double)values[i]));
    return out;
}

static json_t *visibility_json(const struct files *f)
{
    static const char *const kinds[] = { "none", "depths", "walls" };
    const struct ag_probes_visibility *v = &f->visibility;
    const size_t count = probe_count(f->probes);
    json_t *out = json_pack("{s:s}", "kind", kinds[v->kind]);
    if (v->kind == AG_PROBES_VISIBILITY_DEPTHS) {
        json_object_set_new(out, "file", json_string(PROBES_VISIBILITY));
        json_object_set_new(out, "tile_side", json_integer(v->tile_side));
        json_object_set_new(out, "columns", json_integer(f->columns));
        json_object_set_new(out, "offsets", numbers(v->offsets, 4 * count));
    } else if (v->kind == AG_PROBES_VISIBILITY_WALLS) {
        json_object_set_new(out, "walls", numbers(v->walls, 6 * count));
    }
    return out;
}

static json_t *document(const struct files *f, const char *gi)
{
    const struct ag_probes *p = f->probes;
    return json_pack("{s:i, s:s, s:s, s:s, s:o, s:{s:o, s:o, s:[i, i, i]}, s:s, s:o, s:o}",
                     "afterglow_probes", 1, "quantity", "irradiance", "unit", "lx", "light",
                     "indirect, and direct of emissive surfaces and the sky", "gi", json_text(gi),
                     "grid", "first", numbers(p->first, 3), "spacing",
                     json_double((double)p->spacing), "counts", p->counts[0], p->counts[1],
                     p->counts[2], "atlas", PROBES_ATLAS, "visibility", visibility_json(f),
                     "coefficients", numbers(p->coefficients, VALUES * probe_count(p)));
}

enum status probe_files_write(struct ag_context *context, const struct ag_probes *probes,
                              const char *gi, const struct folder *folder)
{
    struct files f = { .context = context, .probes = probes, .folder = folder };
    char path[PATH_SIZE];
    ag_probes_get_visibility(probes, &f.visibility);
    enum status status = write_atlas(&f);
    if (status == DONE) status = write_visibility(&f);
    if (status != DONE) return status;
    if (!folder_file(folder, PROBES_JSON, path)) return fail("cannot write %s: too long", path);
    json_t *json = document(&f, gi);
    status = json_write_compact(json, path);
    json_decref(json);
    return status;
}
