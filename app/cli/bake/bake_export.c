#include "bake_export.h"
#include "cli/technique_names.h"
#include "cli/files/interrupt.h"
#include "cli/files/json.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static const char MARK[] = "index.json";
static const char BIN[] = "bin-", EXR[] = ".exr";

// ---- checks

// "bin-000.exr", or of more digits.
static bool is_bin(const char *name)
{
    if (strncmp(name, BIN, sizeof BIN - 1) != 0) return false;
    const char *at = name + sizeof BIN - 1;
    while (isdigit((unsigned char)*at)) at++;
    return at - name > (long)sizeof BIN - 1 && strcmp(at, EXR) == 0;
}

static bool is_ours(const char *name)
{
    return strcmp(name, MARK) == 0 || is_bin(name);
}

static bool exports(const struct ag_technique_info *info)
{
    return info->exports_bake;
}

static bool can_export(const char *technique)
{
    struct ag_technique_info info;
    for (int i = 0; ag_technique_get(i, &info); i++)
        if (strcmp(info.name, technique) == 0) return info.exports_bake;
    return false;
}

// A spec without a technique that bakes is refused where the bake is created.
static enum status check_technique(const struct session *session, const char *gi)
{
    const char *name = NULL;
    char list[SPEC_SIZE];
    const enum ag_result result = ag_bake_technique(session->context, gi, 0, &name);
    if (result != AG_OK) return fail_library(session->context, result);
    if (!name || can_export(name)) return DONE;
    technique_names(exports, list, sizeof list);
    return wrong_usage("cannot use --export with --gi %s: %s has no data for other programs; "
                       "techniques that have: %s",
                       gi, name, list);
}

enum status bake_export_begin(struct bake_export *e, const struct session *session,
                              const char *path, const char *gi)
{
    *e = (struct bake_export){ .path = path };
    if (!path) return DONE;
    const enum status status = check_technique(session, gi);
    return status == DONE ? folder_plan(&e->folder, path, MARK, is_ours) : status;
}

// ---- the folder

static long long bytes_of(const struct bake_export *e, const char *name)
{
    char path[PATH_SIZE];
    struct stat info;
    return folder_file(&e->folder, name, path) && stat(path, &info) == 0 ? (long long)info.st_size
                                                                         : 0;
}

static void read_facts(struct bake_export *e)
{
    char path[PATH_SIZE];
    if (!folder_file(&e->folder, MARK, path)) return;
    json_t *index = json_load_file(path, 0, NULL);
    const json_t *files = json_object_get(index, "files");
    json_int_t bytes = bytes_of(e, MARK);
    size_t i;
    const json_t *file;
    json_array_foreach(files, i, file) bytes += bytes_of(e, json_string_value(file));
    e->facts = json_pack("{s:o, s:i, s:I, s:O}", "output", json_text(e->folder.shown), "bins",
                         (int)json_array_size(files), "bytes", bytes, "occupancy",
                         json_object_get(index, "occupancy"));
    json_decref(index);
}

static void describe(const struct bake_export *e)
{
    const json_t *occupancy = json_object_get(e->facts, "occupancy");
    const int bins = (int)json_integer_value(json_object_get(e->facts, "bins"));
    note("exported %d %s, %.1f MB, filled by pieces to %.1f %%, by weights to %.1f %%; written: %s",
         bins, bins == 1 ? "bin" : "bins",
         json_number_value(json_object_get(e->facts, "bytes")) * 1e-6,
         100.0 * json_number_value(json_object_get(occupancy, "pieces")),
         100.0 * json_number_value(json_object_get(occupancy, "weights")), e->folder.shown);
}

enum status bake_export_write(struct bake_export *e, const struct baking *baking)
{
    if (!e->path) return DONE;
    enum status status = folder_begin(&e->folder);
    if (status != DONE) return status;
    interrupt_hold();
    const enum ag_result result = ag_bake_export(baking->bake, e->folder.beside.path);
    if (result == AG_OK) read_facts(e);
    interrupt_release();
    if (result != AG_OK) {
        fail_library(baking->session->context, result);
        return FAILED; // the command line was checked
    }
    status = folder_commit(&e->folder, MARK);
    if (status == DONE) describe(e);
    return status;
}

void bake_export_end(struct bake_export *e)
{
    folder_abort(&e->folder);
    json_decref(e->facts);
    *e = (struct bake_export){ 0 };
}
