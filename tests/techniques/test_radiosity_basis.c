// The low-rank form of a matrix of transfer.
#include "framework/test.h"

#include "techniques/radiosity/lowrank/basis.h"

#include "core/rng.h"

#include <math.h>

enum { SOURCES = 24, TEXELS = 20, ROWS = RADIOSITY_COMPONENTS * TEXELS, RANK = 5 };

struct sample {
    struct radiosity_tree tree;
    struct matrix_f64 a;
    uint32_t nodes[SOURCES];
    uint32_t number[2 * SOURCES];
};

static double random_of(uint32_t seed)
{
    return (double)rng_unit(pcg_hash(seed));
}

// RANK products: its rank without the means is one more at most.
static void open_sample(struct sample *s)
{
    struct radiosity_place places[SOURCES];
    uint32_t order[SOURCES];
    *s = (struct sample){ .nodes = { 0 } };
    for (uint32_t i = 0; i < SOURCES; i++) {
        places[i] =
            (struct radiosity_place){ vec3_of((float)random_of(i), (float)random_of(100 + i), 0.0f),
                                      vec3_of(0, 0, 1) };
        s->nodes[i] = i;
    }
    CHECK(radiosity_tree_init(&s->tree, test_host(), places, SOURCES, order));
    CHECK(matrix_f64_init(test_host(), &s->a, ROWS, SOURCES));
    for (uint32_t r = 0; r < ROWS; r++)
        for (uint32_t i = 0; i < SOURCES; i++)
            for (uint32_t k = 0; k < RANK; k++)
                s->a.at[r * SOURCES + i] +=
                    random_of(1000 * (k + 1) + r) * random_of(20000 * (k + 1) + i);
}

static void close_sample(struct sample *s)
{
    radiosity_tree_finish(&s->tree);
    matrix_f64_finish(test_host(), &s->a);
}

static void find(struct sample *s, float energy, uint32_t most, struct radiosity_basis *out)
{
    const struct radiosity_operator of = { &s->a, s->nodes, &s->tree, s->number };
    const struct radiosity_basis_how how = { energy, most, 7 };
    CHECK(radiosity_basis_init(out, test_host(), &of, &how));
    for (size_t n = 0; n < 2 * SOURCES; n++) CHECK(s->number[n] == 0);
}

// Of A B, for light B of the sources; returns the largest difference over the largest value.
static double error_of(const struct sample *s, const struct radiosity_basis *basis,
                       const double light[SOURCES])
{
    double worst = 0.0, largest = 0.0;
    for (size_t r = 0; r < ROWS; r++) {
        double exact = 0.0, found = 0.0;
        for (size_t i = 0; i < SOURCES; i++) {
            exact += s->a.at[r * SOURCES + i] * light[i];
            for (size_t k = 0; k < basis->count; k++)
                found += basis->u.at[r * basis->u.stride + k] *
                         basis->v.at[k * basis->v.stride + i] * light[i];
        }
        worst = fmax(worst, fabs(found - exact));
        largest = fmax(largest, fabs(exact));
    }
    return worst / largest;
}

TEST(basis_of_all_energy_is_the_matrix)
{
    struct sample s;
    struct radiosity_basis basis;
    double light[SOURCES];
    open_sample(&s);
    find(&s, 1.0f, 16, &basis);
    for (uint32_t i = 0; i < SOURCES; i++) light[i] = random_of(777 + i);
    CHECK(basis.count > RANK && error_of(&s, &basis, light) < 1e-9);
    radiosity_basis_finish(&basis, test_host());
    close_sample(&s);
}

TEST(basis_has_uniform_light_exactly_with_any_number_of_modes)
{
    struct sample s;
    double light[SOURCES], patch[SOURCES] = { 0 }, last = HUGE_VAL;
    open_sample(&s);
    for (uint32_t i = 0; i < SOURCES; i++) light[i] = 3.0;
    for (uint32_t i = 0; i < SOURCES / 3; i++) patch[i] = 1.0;
    for (uint32_t most = 1; most <= RANK + 2; most++) {
        struct radiosity_basis basis;
        find(&s, 1.0f, most, &basis);
        const double of_patch = error_of(&s, &basis, patch);
        print_message("%u modes: error of a patch %.2g\n", (unsigned)basis.count, of_patch);
        CHECK(basis.count <= most && error_of(&s, &basis, light) < 1e-12);
        if (most == 1) CHECK(of_patch > 0.01);
        last = of_patch;
        radiosity_basis_finish(&basis, test_host());
    }
    CHECK(last < 1e-9);
    close_sample(&s);
}

TEST(less_energy_takes_fewer_modes)
{
    struct sample s;
    struct radiosity_basis much, little;
    open_sample(&s);
    find(&s, 0.9999f, 16, &much);
    find(&s, 0.5f, 16, &little);
    CHECK(little.count > 1 && little.count < much.count);
    radiosity_basis_finish(&much, test_host());
    radiosity_basis_finish(&little, test_host());
    close_sample(&s);
}
