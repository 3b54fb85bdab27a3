// Bake files and keys: what is used, and what is refused.
#include "bake/bake_sample.h"

#include "core/files/file.h"
#include "framework/test.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *write_sample(bool record_seconds)
{
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    const char *path = test_path("file.safetensors");
    CHECK(bake_run(bake, &(struct bake_run_options){ 0 }));
    CHECK(bake_save(bake, path, record_seconds));
    bake_destroy(bake);
    return path;
}

static bool loads(const char *path, const struct bake_identity *identity, const char *scene)
{
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, identity);
    if (scene)
        bake_plan_depends(bake_plan_of(bake), hash128_add_text((struct hash128){ 0 }, scene));
    test_forget_messages();
    const bool ok = bake_load(bake, path);
    CHECK(ok == bake_is_complete(bake) && sample.runs == 0);
    if (ok) CHECK(bake_run(bake, &(struct bake_run_options){ 0 }) && sample.runs == 0);
    bake_destroy(bake);
    return ok;
}

TEST(bake_file_loads_and_saves_to_the_same_bytes)
{
    struct bake_sample sample = bake_sample_default();
    const char *path = write_sample(false), *copy = test_path("copy.safetensors");
    struct bake *bake = bake_sample_create(&sample, NULL);
    CHECK(bake_load(bake, path) && bake_tensors(bake)->count == 4 && isnan(bake_seconds(bake)));
    CHECK(bake_save(bake, copy, false));
    bake_destroy(bake);
    struct file_bytes a = bake_sample_bytes(path), b = bake_sample_bytes(copy);
    CHECK(a.size == b.size && memcmp(a.data, b.data, a.size) == 0);
    file_bytes_finish(test_host(), &a);
    file_bytes_finish(test_host(), &b);
}

TEST(bake_file_keeps_the_seconds_where_asked_to)
{
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    CHECK(bake_load(bake, write_sample(true)));
    CHECK(bake_seconds(bake) >= 0.0 && bake_seconds(bake) < 60.0);
    for (int i = 0; i < bake_stage_count(bake); i++) {
        const double seconds = bake_stage_info(bake, i).seconds;
        CHECK(seconds >= 0.0 && seconds < 60.0);
    }
    CHECK(bake_load(bake, write_sample(false)));
    CHECK(isnan(bake_seconds(bake)) && isnan(bake_stage_info(bake, 0).seconds));
    bake_destroy(bake);
}

TEST(bake_file_of_another_identity_is_refused_with_the_difference)
{
    const char *path = write_sample(false);
    struct bake_identity other = bake_sample_identity();
    CHECK(loads(path, &other, NULL));
    other.seed = 99; // as good a bake
    CHECK(loads(path, &other, NULL));
    other.program = "9.9.9";
    CHECK(loads(path, &other, NULL));
    other.technique = "dnrt";
    CHECK(!loads(path, &other, NULL));
    CHECK(strstr(test_last_message(), "its technique is sample, not dnrt"));
    other = bake_sample_identity();
    other.version = 4;
    CHECK(!loads(path, &other, NULL));
    CHECK(strstr(test_last_message(), "its bake version is 3, not 4"));
    other = bake_sample_identity();
    other.options = "rows=24,modes=3";
    CHECK(!loads(path, &other, NULL));
    CHECK(strstr(test_last_message(), "it has other options: rows is 23, not 24"));
    other.options = "modes=3,rows=23";
    CHECK(!loads(path, &other, NULL));
    CHECK(strstr(test_last_message(), "its list of options is wrong"));
    CHECK(!loads(path, NULL, "another scene"));
    CHECK(strstr(test_last_message(), "it is of another scene"));
}

static void write_bytes(const char *path, const void *bytes, size_t size)
{
    struct file_writer writer;
    CHECK(file_begin(&writer, test_host(), path));
    fwrite(bytes, 1, size, writer.stream);
    CHECK(file_commit(&writer));
}

TEST(bake_file_cut_at_any_length_or_with_any_changed_byte_is_refused)
{
    struct file_bytes bytes = bake_sample_bytes(write_sample(true));
    const char *path = test_path("damaged.safetensors");
    for (size_t size = 0; size < bytes.size; size++) {
        write_bytes(path, bytes.data, size);
        CHECK(!loads(path, NULL, NULL) && strstr(test_last_message(), path));
    }
    for (size_t i = 0; i < bytes.size; i++) {
        bytes.data[i] = (uint8_t)(bytes.data[i] ^ 1);
        write_bytes(path, bytes.data, bytes.size);
        bytes.data[i] = (uint8_t)(bytes.data[i] ^ 1);
        if (loads(path, NULL, NULL)) fail_msg("byte %zu was changed and the file loaded", i);
    }
    file_bytes_finish(test_host(), &bytes);
}

TEST(bake_file_of_another_kind_is_refused)
{
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    const char *path = test_path("part");
    CHECK(bake_run(bake, &(struct bake_run_options){ .shard = 0, .shard_count = 2 }));
    CHECK(bake_save_partial(bake, path) && !loads(path, NULL, NULL));
    CHECK(strstr(test_last_message(), "its kind is partial, not bake"));
    CHECK(!bake_merge(bake, write_sample(false)));
    CHECK(strstr(test_last_message(), "its kind is bake, not partial"));
    bake_destroy(bake);
}

TEST(bake_part_says_what_it_is_a_part_of)
{
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    struct bake_origin origin;
    const char *path = test_path("origin");
    CHECK(bake_run(bake, &(struct bake_run_options){ .shard = 0, .shard_count = 2 }));
    CHECK(bake_save_partial(bake, path) && bake_partial_origin(test_host(), path, &origin));
    CHECK_STRING(origin.gi, "sample:rows=23");
    CHECK_STRING(origin.scene_name, "@sample");
    CHECK(origin.seed == 5);
    bake_origin_finish(test_host(), &origin);
    bake_destroy(bake);
    CHECK(!bake_partial_origin(test_host(), write_sample(false), &origin) && !origin.gi);
}

static void write_part(const char *path, float scale)
{
    struct bake_sample sample = bake_sample_default();
    struct bake_identity identity = bake_sample_identity();
    identity.scene_scale = scale;
    struct bake *bake = bake_sample_create(&sample, &identity);
    CHECK(bake_run(bake, &(struct bake_run_options){ .shard = 0, .shard_count = 2 }));
    CHECK(bake_save_partial(bake, path));
    bake_destroy(bake);
}

static float scale_of_part(const char *path)
{
    struct bake_origin origin;
    CHECK(bake_partial_origin(test_host(), path, &origin));
    const float scale = origin.scene_scale;
    bake_origin_finish(test_host(), &origin);
    return scale;
}

TEST(bake_part_states_its_scale)
{
    const char *path = test_path("scaled");
    write_part(path, 0.7f);
    CHECK(scale_of_part(path) == 0.7f);
    write_part(path, 1.0f);
    CHECK(scale_of_part(path) == 1.0f);
}

TEST(bake_files_have_decimal_points_in_every_locale)
{
    const char *point = test_path("point"), *comma = test_path("comma");
    test_use_decimal_comma(); // may skip the test: before anything to free
    write_part(comma, 0.7f);
    setlocale(LC_ALL, "C");
    write_part(point, 0.7f);
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, NULL);
    test_use_decimal_comma();
    const float of_point = scale_of_part(point);
    const bool loaded = bake_load(bake, write_sample(true));
    const double in_comma = bake_seconds(bake), stage_in_comma = bake_stage_info(bake, 0).seconds;
    setlocale(LC_ALL, "C");
    CHECK(of_point == 0.7f && scale_of_part(comma) == 0.7f);
    CHECK(loaded && bake_load(bake, test_path("file.safetensors")));
    CHECK(bake_seconds(bake) == in_comma && bake_stage_info(bake, 0).seconds == stage_in_comma);
    bake_destroy(bake);
}

TEST(bake_file_names_its_technique)
{
    char name[32];
    CHECK(bake_file_technique(test_host(), write_sample(false), name, sizeof name));
    CHECK_STRING(name, "sample");
}

static struct hash128 key_of(const struct bake_identity *identity, const char *scene)
{
    struct bake_sample sample = bake_sample_default();
    struct bake *bake = bake_sample_create(&sample, identity);
    char text[HASH128_TEXT];
    unsigned long long high = 0, low = 0;
    bake_plan_depends(bake_plan_of(bake), hash128_add_text((struct hash128){ 0 }, scene));
    bake_key(bake, text);
    CHECK(sscanf(text, "%16llx%16llx", &high, &low) == 2);
    bake_destroy(bake);
    return (struct hash128){ high, low };
}

TEST(bake_key_depends_on_the_identity_alone)
{
    const struct bake_identity plain = bake_sample_identity();
    struct bake_identity others[5] = { plain, plain, plain, plain, plain };
    const struct hash128 key = key_of(&plain, "a");
    others[0].technique = "other";
    others[1].version++;
    others[2].options = "";
    others[3].seed++;
    for (int i = 0; i < 4; i++) CHECK(key_of(&others[i], "a").low != key.low);
    CHECK(key_of(&plain, "b").low != key.low);
    others[4].program = "other";
    CHECK(key_of(&others[4], "a").low == key.low && key_of(&others[4], "a").high == key.high);
}
