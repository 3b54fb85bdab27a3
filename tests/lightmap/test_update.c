// Updates of light maps: which texels a change reaches, and how far the others are from a full
// bake.
#include "lightmap/lightmap_fixture.h"

#include "lightmap/update/update.h"
#include "lightmap/write.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SAMPLES = 256 };

static bool make_charts(const struct scene_pose *statics, const void *options, struct host *host,
                        const struct charts_search *begin, struct charts *out)
{
    (void)options;
    (void)begin;
    return charts_init(out, host, statics,
                       &(struct charts_options){ .texels_per_m = 4.0f, .max_texels = 1 << 20 });
}

// ---- a closed hall, 12 m long, with a wall in its middle and a crate

static int add_material(struct scene *scene, float albedo, float emission)
{
    struct material m = material_default();
    m.base_color = vec4_of(vec3_of(albedo, albedo, albedo), 1);
    m.emissive = vec3_of(emission, emission, emission);
    m.metallic = 0;
    m.specular = 0;
    return scene_add_material(scene, &m);
}

static int add_box(struct scene *scene, int material, vec3s centre, vec3s size, bool inside)
{
    struct fixture_box box = fixture_box(size, inside);
    const struct mesh mesh = { .positions = box.at,
                               .vertex_count = 24,
                               .indices = box.indices,
                               .index_count = 36,
                               .material = material };
    struct node node = node_default();
    node.translation = centre;
    const struct instance instance = { .node = scene_add_node(scene, &node),
                                       .mesh = scene_add_mesh(scene, &mesh),
                                       .skin = -1 };
    return scene_add_instance(scene, &instance);
}

struct hall {
    vec3s crate; // centre; below the floor: there is none
    float albedo, emission;
    float candela;       // of a light at the crate's end
    float other_candela; // of one at the other end; 0: there is none
    float sky, length;
};
static const struct hall HALL = {
    { { -4.5f, 0.5f, 0.4f } }, 0.7f, 0.0f, 300.0f, 0.0f, 0.0f, 12.0f
};

static void add_light(struct scene *scene, float x, float candela)
{
    const int node =
        scene_add_node_looking(scene, "light", vec3_of(x, 2.5f, -0.3f), vec3_of(0, -1, 0));
    const struct light light = { .name = "light",
                                 .type = LIGHT_POINT,
                                 .node = node,
                                 .intensity = vec3_of(candela, candela, candela) };
    CHECK(scene_add_light(scene, &light) >= 0);
}

static struct scene *create_hall(const struct hall *hall)
{
    struct scene *scene = scene_create(test_host(), "hall");
    const int grey = add_material(scene, 0.5f, 0.0f);
    const int crate = add_material(scene, hall->albedo, hall->emission);
    scene->environment.sky = vec3_of(hall->sky, hall->sky, hall->sky);
    // The wall in the middle has a door: the halves share some light.
    add_box(scene, grey, vec3_of(0, 1.5f, 0), vec3_of(hall->length, 3, 4), true);
    add_box(scene, grey, vec3_of(0, 1.5f, -0.5f), vec3_of(0.2f, hall->length / 4, 3), false);
    if (hall->crate.y > 0.0f) add_box(scene, crate, hall->crate, vec3_of(1, 1, 1), false);
    add_light(scene, -4.0f, hall->candela);
    if (hall->other_candela > 0.0f) add_light(scene, 4.0f, hall->other_candela);
    return scene;
}

// ---- bakes

struct baked {
    struct scene *scene;
    struct scene_pose pose;
    struct bake *bake;
    struct lightmap map;
    struct lightmap_change change;
};

static struct bake *create_bake(void)
{
    const struct bake_identity identity = {
        .technique = LIGHTMAP_NAME, .version = 1, .options = "", .program = "test"
    };
    return bake_create(test_host(), &identity);
}

static void begin(struct baked *b, const struct hall *hall)
{
    *b = (struct baked){ .scene = create_hall(hall) };
    CHECK(pose_init(&b->pose, b->scene, -1, 0));
    b->bake = create_bake();
}

static void end(struct baked *b, int threads)
{
    struct charts charts;
    CHECK(bake_run(b->bake, &(struct bake_run_options){ .threads = threads }));
    CHECK(make_charts(&b->pose, NULL, test_host(), NULL, &charts));
    CHECK(lightmap_init(&b->map, &charts, b->scene));
    CHECK(lightmap_set_paths(&b->map, bake_tensors(b->bake), true, false));
}

static void finish(struct baked *b)
{
    lightmap_finish(&b->map);
    bake_destroy(b->bake);
    pose_finish(&b->pose);
    scene_destroy(b->scene);
}

static void bake_all(struct baked *b, const struct hall *hall)
{
    begin(b, hall);
    const struct lightmap_bake how = { .pose = &b->pose,
                                       .samples = SAMPLES,
                                       .charts = make_charts };
    CHECK(lightmap_add_stages(bake_plan_of(b->bake), &how, NULL));
    end(b, 0);
}

static const float *rows_of(const struct baked *b, const char *name)
{
    return tensors_find(bake_tensors(b->bake), name)->data;
}

// A folder with the map of a hall.
static const char *write_folder(const struct hall *hall, const char *name)
{
    static char folder[512];
    struct baked b;
    struct lightmap_record record;
    snprintf(folder, sizeof folder, "%s", test_path(name));
    mkdir(folder, 0700);
    bake_all(&b, hall);
    CHECK(lightmap_record_init(&record, test_host(), &b.pose, &b.map.charts,
                               rows_of(&b, LIGHTMAP_REST)));
    record.options = host_strdup(test_host(), "");
    const struct lightmap_facts facts = {
        .samples = SAMPLES, .punctual = true, .gi = "test", .record = &record
    };
    CHECK(lightmap_write(&b.map, b.scene, &facts, LIGHTMAP_EXR, folder));
    lightmap_record_finish(&record);
    finish(&b);
    return folder;
}

static bool plan_update(struct baked *b, const struct hall *hall, const char *folder)
{
    struct lightmap_record record;
    struct charts charts;
    char path[600];
    begin(b, hall);
    snprintf(path, sizeof path, "%s/" LIGHTMAP_RECORD_FILE, folder);
    CHECK(make_charts(&b->pose, NULL, test_host(), NULL, &charts));
    CHECK(lightmap_record_read(&record, test_host(), path));
    const struct lightmap_bake how = { .pose = &b->pose, .samples = SAMPLES };
    const struct lightmap_update update = {
        .how = &how, .folder = folder, .was = &record, .charts = &charts
    };
    return lightmap_add_update_stages(bake_plan_of(b->bake), &update, &b->change);
}

static void bake_update(struct baked *b, const struct hall *hall, const char *folder)
{
    CHECK(plan_update(b, hall, folder));
    end(b, 0);
}

static double share_again(const struct baked *b)
{
    const struct tensor *again = tensors_find(bake_tensors(b->bake), LIGHTMAP_AGAIN);
    const uint8_t *marks = again->data;
    size_t count = 0;
    for (size_t i = 0; i < again->bytes; i++) count += marks[i];
    return (double)count / (double)again->bytes;
}

// ---- against a full bake

struct differences {
    double energy;    // of the update over that of the full bake
    double block;     // largest difference of a block of texels, lux
    double root_mean; // of texels, lux
};

enum { BLOCK = 16 }; // consecutive texels are beside each other

static struct differences compare(const struct baked *a, const struct baked *b)
{
    const float *x = rows_of(a, LIGHTMAP_REST), *y = rows_of(b, LIGHTMAP_REST);
    const uint32_t rows = a->map.charts.side_texel_count;
    struct differences d = { 0 };
    double sums[2] = { 0 }, block = 0.0, squares = 0.0;
    for (uint32_t i = 0; i < rows; i++) {
        const double one = (double)x[LIGHTMAP_COLUMNS * i + 1],
                     other = (double)y[LIGHTMAP_COLUMNS * i + 1];
        sums[0] += one;
        sums[1] += other;
        squares += (one - other) * (one - other);
        block += (one - other) / BLOCK;
        if ((i + 1) % BLOCK != 0) continue;
        d.block = fmax(d.block, fabs(block));
        block = 0.0;
    }
    d.energy = sums[0] / sums[1];
    d.root_mean = sqrt(squares / rows);
    return d;
}

static struct bake *bake_with_seed(const struct baked *of, uint64_t seed)
{
    const struct bake_identity identity = {
        .technique = LIGHTMAP_NAME, .version = 1, .options = "", .program = "test", .seed = seed
    };
    const struct lightmap_bake how = { .pose = &of->pose,
                                       .samples = SAMPLES,
                                       .charts = make_charts };
    struct bake *bake = bake_create(test_host(), &identity);
    CHECK(bake && lightmap_add_stages(bake_plan_of(bake), &how, NULL));
    CHECK(bake_run(bake, &(struct bake_run_options){ 0 }));
    return bake;
}

// Texels that are baked again have the bytes of a full bake, and direct light everywhere.
static void check_bytes(const struct baked *update, const struct baked *full)
{
    const struct tensor *again = tensors_find(bake_tensors(update->bake), LIGHTMAP_AGAIN);
    const uint8_t *marks = again->data;
    const float *x = rows_of(update, LIGHTMAP_REST), *y = rows_of(full, LIGHTMAP_REST);
    const size_t rows = update->map.charts.side_texel_count;
    for (size_t i = 0; i < rows; i++)
        if (marks[i])
            CHECK(memcmp(x + LIGHTMAP_COLUMNS * i, y + LIGHTMAP_COLUMNS * i,
                         LIGHTMAP_COLUMNS * sizeof *x) == 0);
    CHECK(memcmp(rows_of(update, LIGHTMAP_PUNCTUAL), rows_of(full, LIGHTMAP_PUNCTUAL),
                 rows * 3 * sizeof(float)) == 0);
}

// The map of HALL is updated for `hall`; returns the share of texels that are baked again.
static double check_update(const struct hall *hall, const char *name)
{
    struct baked update, full;
    bake_update(&update, hall, write_folder(&HALL, name));
    bake_all(&full, hall);
    struct baked other = full;
    other.bake = bake_with_seed(&full, 7);
    const struct differences d = compare(&update, &full), noise = compare(&other, &full);
    const double share = share_again(&update);
    print_message("%s: %.1f %% again, energy %.4f (seeds %.4f), blocks %.3f (%.3f) lx, "
                  "texels %.3f (%.3f) lx\n",
                  name, 100.0 * share, d.energy, noise.energy, d.block, noise.block, d.root_mean,
                  noise.root_mean);
    check_bytes(&update, &full);
    CHECK_NEAR(d.energy, 1.0, 0.01);
    CHECK(d.block < noise.block);
    CHECK(d.root_mean < 0.7 * noise.root_mean);
    bake_destroy(other.bake);
    finish(&update);
    finish(&full);
    return share;
}

TEST(moved_crate_is_baked_again_with_what_its_light_reaches)
{
    struct hall hall = HALL;
    hall.crate = vec3_of(-3.2f, 0.5f, -0.6f);
    const double share = check_update(&hall, "update-moved");
    CHECK(share > 0.01 && share < 0.6);
}

TEST(removed_crate_leaves_no_shadow)
{
    struct hall hall = HALL;
    hall.crate.y = -1.0f;
    const double share = check_update(&hall, "update-removed");
    CHECK(share > 0.01 && share < 0.6);
}

TEST(added_crate_beyond_the_wall_reaches_its_room_alone)
{
    struct hall with = HALL, without = HALL;
    with.crate = vec3_of(4.8f, 0.5f, -0.9f);
    without.crate.y = -1.0f;
    struct baked update, full;
    bake_update(&update, &with, write_folder(&without, "update-added"));
    bake_all(&full, &with);
    check_bytes(&update, &full);
    CHECK(update.change.instances == 1 && !update.change.lights);
    const uint8_t *marks = tensors_find(bake_tensors(update.bake), LIGHTMAP_AGAIN)->data;
    size_t here = 0, there = 0, wrong = 0;
    for (uint32_t i = 0; i < update.map.charts.texel_count; i++) {
        const float x = update.map.charts.texels[i].position.x;
        here += x > 0.2f && marks[i];
        wrong += x < -0.2f && marks[i];
        there += x < -0.2f;
    }
    print_message("%zu texels in its room, %zu of %zu in the other\n", here, wrong, there);
    CHECK(here > 100 && wrong * 20 < there);
    finish(&update);
    finish(&full);
}

TEST(changed_material_is_seen_by_its_surroundings)
{
    struct hall hall = HALL;
    hall.albedo = 0.1f;
    const double share = check_update(&hall, "update-material");
    CHECK(share > 0.005 && share < 0.7);
}

TEST(crate_that_begins_to_glow_lights_its_room)
{
    struct hall hall = HALL;
    hall.emission = 50.0f;
    const double share = check_update(&hall, "update-emissive");
    CHECK(share > 0.1);
}

TEST(dim_light_in_the_other_room_does_not_bake_the_first_one_again)
{
    struct hall hall = HALL;
    hall.other_candela = 30.0f;
    const double share = check_update(&hall, "update-light");
    CHECK(share > 0.1 && share < 0.8);
}

// But for texels below the wall and the crate, which are black.
TEST(light_of_twice_the_strength_bakes_all_again)
{
    struct hall hall = HALL;
    hall.candela *= 2.0f;
    CHECK(check_update(&hall, "update-twice") > 0.95);
}

TEST(scene_without_a_change_keeps_all_bytes)
{
    struct baked update, full;
    bake_update(&update, &HALL, write_folder(&HALL, "update-same"));
    bake_all(&full, &HALL);
    assert_int_equal(update.change.instances, 0);
    CHECK(share_again(&update) == 0.0);
    check_bytes(&update, &full);
    CHECK(memcmp(rows_of(&update, LIGHTMAP_REST), rows_of(&full, LIGHTMAP_REST),
                 update.map.charts.side_texel_count * LIGHTMAP_COLUMNS * sizeof(float)) == 0);
    finish(&update);
    finish(&full);
}

TEST(update_is_the_same_for_any_number_of_threads)
{
    struct hall hall = HALL;
    struct baked one, all;
    hall.crate.x += 0.7f;
    const char *folder = write_folder(&HALL, "update-threads");
    CHECK(plan_update(&one, &hall, folder));
    end(&one, 1);
    bake_update(&all, &hall, folder);
    const struct tensors *x = bake_tensors(one.bake), *y = bake_tensors(all.bake);
    assert_int_equal(x->count, 3);
    for (size_t i = 0; i < x->count; i++)
        CHECK(memcmp(x->at[i].data, y->at[i].data, x->at[i].bytes) == 0);
    finish(&one);
    finish(&all);
}

static bool stop_in_the_middle(void *user, const struct bake_progress *progress)
{
    bool *stopped = user;
    *stopped |= progress->done > 0.3;
    return !*stopped;
}

TEST(interrupted_update_continues_to_the_same_bytes)
{
    struct hall hall = HALL;
    struct baked first, second, whole;
    char checkpoint[600];
    bool stopped = false;
    hall.crate.x += 0.7f;
    const char *folder = write_folder(&HALL, "update-stopped");
    snprintf(checkpoint, sizeof checkpoint, "%s.checkpoint", folder);
    CHECK(plan_update(&first, &hall, folder));
    CHECK(!bake_run(first.bake, &(struct bake_run_options){ .checkpoint = checkpoint,
                                                            .progress = stop_in_the_middle,
                                                            .user = &stopped,
                                                            .threads = 1 }));
    CHECK(stopped && test_host()->failure == FAIL_CANCELLED);
    CHECK(access(checkpoint, F_OK) == 0);
    CHECK(plan_update(&second, &hall, folder));
    CHECK(bake_run(second.bake, &(struct bake_run_options){ .checkpoint = checkpoint }));
    bake_update(&whole, &hall, folder);
    const struct tensors *x = bake_tensors(second.bake), *y = bake_tensors(whole.bake);
    for (size_t i = 0; i < y->count; i++)
        CHECK(memcmp(x->at[i].data, y->at[i].data, y->at[i].bytes) == 0);
    finish(&first);
    finish(&second);
    finish(&whole);
}

// ---- the search for charts

TEST(search_for_charts_begins_where_that_of_the_record_ended)
{
    const struct charts_wish wish = { .technique = "test", .texels = 4096 };
    struct scene *scene = scene_load(test_host(), "@atrium");
    struct scene_pose pose;
    struct charts all, again;
    struct lightmap_record written, record;
    char path[512];
    snprintf(path, sizeof path, "%s", test_path("search.safetensors"));
    CHECK(pose_init(&pose, scene, -1, 0));
    CHECK(charts_init_wanted(&all, test_host(), &pose, &wish));
    CHECK(all.search.surface_texels > 0 && all.search.surface_texels < wish.texels);
    CHECK(lightmap_record_init(&written, test_host(), &pose, &all, NULL));
    written.options = host_strdup(test_host(), "");
    written.rest = host_alloc(test_host(), written.row_count, LIGHTMAP_COLUMNS * sizeof(float));
    CHECK(lightmap_record_write(&written, path) &&
          lightmap_record_read(&record, test_host(), path));
    struct charts_wish next = wish;
    next.begin = &record.search;
    CHECK(charts_init_wanted(&again, test_host(), &pose, &next));
    CHECK(again.search.surface_texels == all.search.surface_texels &&
          again.search.across == all.search.across);
    assert_int_equal(again.texel_count, all.texel_count);
    for (uint32_t i = 0; i < all.texel_count; i++)
        CHECK(memcmp(&again.texels[i].position, &all.texels[i].position, sizeof(vec3s)) == 0);
    lightmap_record_finish(&written);
    lightmap_record_finish(&record);
    charts_finish(&again);
    charts_finish(&all);
    pose_finish(&pose);
    scene_destroy(scene);
}

// ---- folders that cannot be updated

TEST(other_sky_is_refused_in_one_sentence)
{
    struct hall hall = HALL;
    struct baked b;
    const char *folder = write_folder(&HALL, "update-sky");
    hall.sky = 10.0f;
    CHECK(!plan_update(&b, &hall, folder));
    CHECK(strstr(test_last_message(), "the sky or the environment has changed"));
    finish(&b);
}

TEST(folder_of_another_scene_is_refused_in_one_sentence)
{
    struct hall hall = HALL;
    struct baked b;
    const char *folder = write_folder(&HALL, "update-other");
    hall.crate.x += 1.0f;
    hall.length = 11.0f;
    CHECK(!plan_update(&b, &hall, folder));
    CHECK(strstr(test_last_message(), "no surface of the scene is in it"));
    finish(&b);
}

// The copy is read only where shapes or materials of the earlier scene are needed.
TEST(damaged_copy_of_the_scene_is_refused_where_it_is_needed)
{
    struct hall hall = HALL;
    struct baked b;
    const char *folder = write_folder(&HALL, "update-copy");
    char path[600];
    snprintf(path, sizeof path, "%s/" LIGHTMAP_SCENE_FILE, folder);
    CHECK(truncate(path, 1000) == 0);
    hall.crate.x += 0.5f;
    CHECK(!plan_update(&b, &hall, folder));
    CHECK(strstr(test_last_message(), LIGHTMAP_SCENE_FILE));
    finish(&b);
    hall = HALL;
    hall.other_candela = 20.0f;
    CHECK(plan_update(&b, &hall, folder));
    finish(&b);
}

TEST(copy_of_another_scene_is_refused)
{
    struct hall hall = HALL, other = HALL;
    struct baked b;
    char from[600], path[600];
    other.crate = vec3_of(3, 0.5f, 0);
    snprintf(from, sizeof from, "%s/" LIGHTMAP_SCENE_FILE, write_folder(&other, "update-from"));
    const char *folder = write_folder(&HALL, "update-mixed");
    snprintf(path, sizeof path, "%s/" LIGHTMAP_SCENE_FILE, folder);
    CHECK(rename(from, path) == 0);
    hall.crate.x += 0.5f;
    CHECK(!plan_update(&b, &hall, folder));
    CHECK(strstr(test_last_message(), "it is not of the bake beside it"));
    finish(&b);
}

static void flip_byte(const char *path, long at)
{
    FILE *file = fopen(path, "r+b");
    assert_non_null(file);
    CHECK(fseek(file, at, at < 0 ? SEEK_END : SEEK_SET) == 0);
    const int byte = fgetc(file);
    CHECK(fseek(file, -1, SEEK_CUR) == 0 && fputc(byte ^ 0x10, file) != EOF);
    fclose(file);
}

TEST(damaged_records_are_refused_in_one_sentence)
{
    char path[600];
    struct lightmap_record record;
    snprintf(path, sizeof path, "%s/" LIGHTMAP_RECORD_FILE, write_folder(&HALL, "update-damaged"));
    for (long at = -1; at > -4000; at -= 997) {
        flip_byte(path, at);
        CHECK(!lightmap_record_read(&record, test_host(), path));
        CHECK(strstr(test_last_message(), "cannot use") && record.host == NULL);
        flip_byte(path, at);
    }
    CHECK(lightmap_record_read(&record, test_host(), path));
    lightmap_record_finish(&record);
    CHECK(truncate(path, 5000) == 0);
    CHECK(!lightmap_record_read(&record, test_host(), path));
}
