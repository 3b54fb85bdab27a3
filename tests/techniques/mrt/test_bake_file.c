// Files and reports of a small dictionary: damaged files are refused, and the report of a file is
// that of the run that made it.
#include "framework/test.h"
#include "techniques/mrt/mrt_bake_fixture.h"

#include "core/files/file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static struct mrt_dictionary_options tiny_options(void)
{
    struct mrt_dictionary_options options = mrt_fixture_options();
    options.texels = options.modes = options.response_modes = 4;
    options.rays = 256;
    options.prior_modes = 8;
    options.block_probes = options.lightfield_supersampling = options.lightfield_rounds = 1;
    options.lightfield_positions = 4;
    options.lightfield_directions = 6;
    options.lightfield_modes = 16;
    return options;
}

static const char *write_tiny(const struct mrt_dictionary_options *options, bool record_seconds)
{
    struct bake *bake = mrt_fixture_bake(options, 0, false);
    const char *path = test_path("tiny.safetensors");
    CHECK(bake_save(bake, path, record_seconds));
    bake_destroy(bake);
    return path;
}

// Loads into a bake that has not run.
static bool loads(struct bake *bake, const char *path)
{
    test_forget_messages();
    return bake_load(bake, path);
}

TEST(dictionary_file_cut_at_any_length_is_refused)
{
    const struct mrt_dictionary_options options = tiny_options();
    const char *path = write_tiny(&options, true);
    struct bake *bake = mrt_fixture_plan(&options, 1);
    struct file_bytes bytes;
    CHECK(file_read(test_host(), path, 1 << 20, &bytes) && loads(bake, path));
    bake_destroy(bake);
    bake = mrt_fixture_plan(&options, 1);
    for (size_t size = bytes.size; size-- > 0;) {
        CHECK(truncate(path, (off_t)size) == 0);
        CHECK(!loads(bake, path) && strstr(test_last_message(), path));
    }
    CHECK(!bake_is_complete(bake));
    print_message("%zu lengths\n", bytes.size);
    file_bytes_finish(test_host(), &bytes);
    bake_destroy(bake);
}

static void put_byte(FILE *file, size_t at, uint8_t byte)
{
    CHECK(fseek(file, (long)at, SEEK_SET) == 0 && fputc(byte, file) != EOF && fflush(file) == 0);
}

// Every byte of the header, every seventh one of the arrays.
TEST(dictionary_file_with_any_changed_byte_is_refused)
{
    enum { LENGTH = 8, STEP = 7 };
    const struct mrt_dictionary_options options = tiny_options();
    const char *path = write_tiny(&options, true);
    struct bake *bake = mrt_fixture_plan(&options, 1);
    struct file_bytes bytes;
    CHECK(file_read(test_host(), path, 1 << 20, &bytes));
    FILE *file = fopen(path, "r+b");
    CHECK(file != NULL);
    const size_t arrays = LENGTH + (size_t)bytes.data[0] + 256 * (size_t)bytes.data[1];
    for (size_t i = 0; i < bytes.size; i += i < arrays ? 1 : STEP) {
        put_byte(file, i, bytes.data[i] ^ (uint8_t)(1u << i % 8));
        if (loads(bake, path)) fail_msg("byte %zu was changed and the file loaded", i);
        put_byte(file, i, bytes.data[i]);
    }
    CHECK(arrays < bytes.size && loads(bake, path));
    fclose(file);
    file_bytes_finish(test_host(), &bytes);
    bake_destroy(bake);
}

TEST(dictionary_file_of_another_version_or_shape_is_refused)
{
    struct mrt_dictionary_options options = tiny_options();
    const char *path = write_tiny(&options, false);
    struct bake *bake = mrt_fixture_plan(&options, 2);
    CHECK(!loads(bake, path) && strstr(test_last_message(), "its bake version is 1, not 2"));
    bake_destroy(bake);
    options.maze = MRT_MAZE_3D; // more cubes, in a file that claims the same options
    bake = mrt_fixture_plan(&options, 1);
    CHECK(!loads(bake, path) && strstr(test_last_message(), "it lacks the tensor"));
    bake_destroy(bake);
}

TEST(dictionary_with_a_value_that_is_not_finite_is_refused)
{
    const struct mrt_dictionary_options options = tiny_options();
    struct bake *bake = mrt_fixture_bake(&options, 0, false);
    const struct tensors *saved = bake_tensors(bake);
    struct tensor *changed = host_alloc(test_host(), saved->count, sizeof *changed);
    struct mrt_dictionary dictionary;
    memcpy(changed, saved->at, saved->count * sizeof *changed);
    const struct tensors set = { .at = changed, .count = saved->count };
    CHECK(mrt_dictionary_init(test_host(), &set, &options, &dictionary));
    mrt_dictionary_finish(test_host(), &dictionary);
    for (size_t i = 0; i < saved->count; i++) {
        // The report alone reads these.
        if (strstr(changed[i].name, "sigma") || strstr(changed[i].name, "checks")) continue;
        float *values = host_alloc(test_host(), 1, changed[i].bytes);
        memcpy(values, saved->at[i].data, changed[i].bytes);
        values[changed[i].bytes / sizeof *values - 1] = NAN;
        changed[i].data = values;
        CHECK(!mrt_dictionary_init(test_host(), &set, &options, &dictionary));
        CHECK(strstr(test_last_message(), changed[i].name));
        changed[i].data = saved->at[i].data;
        host_free(test_host(), values);
    }
    host_free(test_host(), changed);
    bake_destroy(bake);
}

// ---- reports

// Replaces the times, which a file without them does not state.
static void forget_seconds(char *text)
{
    for (char *at = text; (at = strstr(at, "\"seconds\": {")) != NULL;) {
        char *end = strchr(at, '}');
        CHECK(end != NULL);
        memmove(at + 1, end, strlen(end) + 1);
    }
}

TEST(dictionary_report_of_a_file_is_that_of_the_run)
{
    for (int maze = MRT_MAZE_2D; maze <= MRT_TUNNEL; maze += MRT_TUNNEL) {
        struct mrt_dictionary_options options = tiny_options();
        options.maze = maze;
        struct bake *run = mrt_fixture_bake(&options, 0, false);
        struct bake *file = mrt_fixture_plan(&options, 1);
        const char *path = test_path("reported.safetensors");
        CHECK(bake_save(run, path, false) && bake_load(file, path));
        char *of_run = mrt_fixture_report(run, &options),
             *of_file = mrt_fixture_report(file, &options);
        CHECK(strstr(of_file, "\"lights\": null"));
        CHECK(strstr(of_run, maze == MRT_TUNNEL ? "\"name\": \"tube/2\"" : "\"name\": \"cube/5\""));
        CHECK(strstr(of_run, "\"orthonormality\"") && !strstr(of_run, "\"F\""));
        forget_seconds(of_run);
        forget_seconds(of_file);
        CHECK_STRING(of_run, of_file);
        host_free(test_host(), of_run);
        host_free(test_host(), of_file);
        bake_destroy(run);
        bake_destroy(file);
    }
}
