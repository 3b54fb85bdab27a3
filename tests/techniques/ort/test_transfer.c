// With all offsets present the offset form (equation 9) is the sum over all texels (equation 3).
#include "techniques/ort/bake_fixture.h"

#include "bake/plan.h"
#include "core/half.h"
#include "techniques/ort/bake/transfer.h"

#include <math.h>
#include <stdlib.h>

enum { LIGHTS = 3 };

// Sums of a stage beside that of the maps, from the same inputs.
struct sums {
    float *light[LIGHTS];       // [texels][3], first-order
    double *by_texels[LIGHTS];  // [texels][3], equation 3
    double *by_offsets[LIGHTS]; // equation 9, before weights are halves
    float *weight;              // [texels][offsets][3], equation 10
};

static void find_transfer(const struct ort_transfer *transfer, const struct ort_receiver *to,
                          uint32_t from, float area, float out[3])
{
    float single[3], multiple[3];
    ort_transfer_single(transfer, to, from, single);
    ort_transfer_multiple(transfer, to, from, multiple);
    for (int c = 0; c < 3; c++) out[c] = (single[c] + multiple[c]) * area;
}

static void add_light(const struct sums *s, double *const sums[LIGHTS], size_t to, size_t from,
                      const float weight[3])
{
    for (int l = 0; l < LIGHTS; l++)
        for (size_t c = 0; c < 3; c++)
            sums[l][3 * to + c] += (double)weight[c] * (double)s->light[l][3 * from + c];
}

// Σ R(t, t′) A(t′) E₀(t′)
static void sum_texels(const struct ort_transfer *transfer, const struct ort_receiver *to,
                       const struct sums *s)
{
    const struct ort_map *map = &transfer->texels.scene->map;
    for (uint32_t from = 0; from < map->texel_count; from++) {
        float weight[3];
        find_transfer(transfer, to, from, ort_texel_area(&transfer->texels, from), weight);
        add_light(s, s->by_texels, to->texel, from, weight);
    }
}

// Σ R(t, t + Δt) TVA(t, Δt) E₀(t + Δt)
static void sum_offsets(const struct bake_task *task, const struct ort_transfer *transfer,
                        const struct ort_receiver *to, const struct sums *s)
{
    const struct ort_map *map = &transfer->texels.scene->map;
    const struct tensor *offsets = bake_task_input(task, ORT_OFFSETS);
    const float *areas = bake_task_input(task, ORT_AREAS)->data;
    const size_t count = offsets->shape[1];
    const int32_t *offset = (const int32_t *)offsets->data + 2 * map->group_of[to->texel] * count;
    const struct ort_place place = ort_place_of(map, to->texel);
    for (size_t k = 0; k < count; k++) {
        const uint32_t from = ort_texel_at(map, place, offset[2 * k], offset[2 * k + 1]);
        float *weight = s->weight + 3 * (to->texel * count + k);
        if (from == CHART_NONE) continue;
        find_transfer(transfer, to, from, areas[k * map->texel_count + to->texel], weight);
        add_light(s, s->by_offsets, to->texel, from, weight);
    }
}

static bool run(const struct bake_task *task)
{
    const struct ort_scene *scene = task->job;
    const struct sums *s = task->argument;
    struct ort_transfer transfer;
    struct ort_receiver receiver;
    if (!ort_transfer_init(&transfer, task) ||
        !ort_receiver_init(&receiver, task->host, transfer.patch_count))
        return false;
    for (uint32_t i = 0; i < scene->map.texel_count; i++) {
        if (!ort_receive(&transfer, i, &receiver)) continue;
        sum_texels(&transfer, &receiver, s);
        sum_offsets(task, &transfer, &receiver, s);
    }
    ort_receiver_finish(&receiver, task->host);
    return true;
}

// ---- checks

static void check_sums(size_t texels, const struct sums *s)
{
    for (int l = 0; l < LIGHTS; l++) {
        double most = 0.0, worst = 0.0;
        for (size_t i = 0; i < 3 * texels; i++) {
            most = fmax(most, s->by_texels[l][i]);
            worst = fmax(worst, fabs(s->by_texels[l][i] - s->by_offsets[l][i]));
        }
        print_message("light %d: equation 9 is equation 3 within %.2g of the largest\n", l,
                      worst / most);
        CHECK(most > 0.01 && worst <= 1e-5 * most);
    }
}

// A half float has 11 bits; below 2⁻¹⁴ it is a multiple of 2⁻²⁴.
static void check_halves(size_t count, const uint16_t *half, const struct sums *s)
{
    double worst = 0.0;
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        const double weight = (double)(ORT_MAP_SCALE * s->weight[i]);
        const double rounding = fmax(weight * 0x1p-11, 0x1p-25);
        worst = fmax(worst, fabs(weight - (double)float_from_half(half[i])) / rounding);
        used += half[i] != 0;
    }
    print_message("%zu of %zu weights are used, within %.4f of the rounding of halves\n", used,
                  count, worst);
    CHECK(used > count / 100 && worst <= 1.0 + 1e-3); // products round differently, too
}

static void init_sums(struct sums *s, const struct ort_fixture *f, size_t offsets)
{
    const size_t n = f->map.texel_count;
    for (uint32_t l = 0; l < LIGHTS; l++) {
        s->light[l] = ort_texel_floats(f);
        ort_random_light(f, l % 2 ? ORT_SPOTS : ORT_SMOOTH, l, s->light[l]);
        s->by_texels[l] = calloc(3 * n, sizeof(double));
        s->by_offsets[l] = calloc(3 * n, sizeof(double));
        assert_true(s->by_texels[l] && s->by_offsets[l]);
    }
    s->weight = calloc(3 * n * offsets, sizeof *s->weight);
    assert_non_null(s->weight);
}

static void finish_sums(struct sums *s)
{
    for (int l = 0; l < LIGHTS; l++) {
        free(s->light[l]);
        free(s->by_texels[l]);
        free(s->by_offsets[l]);
    }
    free(s->weight);
}

static struct ort_baked bake_with_sums(const struct ort_fixture *f, const struct sums *s)
{
    struct ort_baked baked = { .bake = ort_fixture_plan(f, "offsets=4096,rows=paper", 0) };
    const struct bake_stage stage = {
        .name = "sums", .wave = 4, .task_count = 1, .run = run, .argument = s
    };
    CHECK(bake_plan_add(bake_plan_of(baked.bake), &stage));
    CHECK(bake_run(baked.bake, &(struct bake_run_options){ 0 }));
    baked.tensors = bake_tensors(baked.bake);
    return baked;
}

static void check_transfer(void (*scene)(struct ort_fixture *), const char *options)
{
    struct ort_fixture f;
    struct sums s;
    scene(&f);
    ort_fixture_open(&f, options);
    const size_t offsets = (2 * (size_t)f.map.width - 1) * (2 * (size_t)f.map.height - 1);
    print_message("%u texels, %zu offsets\n", f.map.texel_count, offsets);
    CHECK(offsets <= 4096);
    init_sums(&s, &f, offsets);
    struct ort_baked baked = bake_with_sums(&f, &s);
    CHECK(tensors_find(baked.tensors, ORT_OFFSETS)->shape[1] == offsets);
    check_sums(f.map.texel_count, &s);
    check_halves(3 * f.map.texel_count * offsets, tensors_find(baked.tensors, ORT_MAPS)->data, &s);
    finish_sums(&s);
    ort_baked_finish(&baked);
    ort_fixture_close(&f);
}

TEST(all_offsets_of_two_squares_give_the_sum_over_all_texels)
{
    check_transfer(ort_fixture_facing, "texels=400");
}

TEST(all_offsets_of_a_box_in_a_box_give_the_sum_over_all_texels)
{
    check_transfer(ort_fixture_boxes, "texels=240");
}
