// Projection of direct light in blocks whose walls objects hide in part.
#include "framework/test.h"

#include "techniques/mrt/level/projection.h"
#include "techniques/mrt/objects/delta.h"

#include <math.h>

// Modes are cosines along a row of texels: orthonormal, so that T_d→b is the transposed of L_imp.
enum { TEXELS = 64, MODES = 4 };

struct projection {
    struct matrix_f32 l_imp, t_db;
    float share[TEXELS];
};

static void open_projection(struct projection *p, int hidden_from, int hidden_to)
{
    assert_true(matrix_f32_init(test_host(), &p->l_imp, TEXELS, MODES) &&
                matrix_f32_init(test_host(), &p->t_db, MODES, TEXELS));
    for (int t = 0; t < TEXELS; t++) {
        p->share[t] = t >= hidden_from && t < hidden_to ? 0.0f : 1.0f;
        for (int m = 0; m < MODES; m++) {
            const double norm = sqrt((m == 0 ? 1.0 : 2.0) / TEXELS);
            const double value = norm * cos(GLM_PI * (t + 0.5) * m / TEXELS);
            p->l_imp.at[t * MODES + m] = p->t_db.at[m * TEXELS + t] = (float)value;
        }
    }
    CHECK(mrt_weigh_projection(test_host(), &p->l_imp, p->share, &p->t_db));
}

static void close_projection(struct projection *p)
{
    matrix_f32_finish(test_host(), &p->l_imp);
    matrix_f32_finish(test_host(), &p->t_db);
}

static double coefficient(const struct projection *p, int mode, const double light[TEXELS])
{
    double sum = 0.0;
    for (int t = 0; t < TEXELS; t++) sum += (double)p->t_db.at[mode * TEXELS + t] * light[t];
    return sum;
}

TEST(without_hidden_texels_nothing_changes)
{
    struct projection p;
    open_projection(&p, 0, 0);
    for (int i = 0; i < MODES * TEXELS; i++)
        CHECK_NEAR(p.t_db.at[i], p.l_imp.at[i % TEXELS * MODES + i / TEXELS], 1e-6);
    close_projection(&p);
}

// However bright they are, as below a ceiling light.
TEST(light_of_hidden_texels_has_no_part_in_the_others)
{
    static const double modes[MODES] = { 5, -1, 2, 0.5 };
    struct projection p;
    open_projection(&p, 20, 28);
    double light[TEXELS] = { 0 };
    for (int t = 0; t < TEXELS; t++) {
        for (int m = 0; m < MODES; m++) light[t] += modes[m] * (double)p.l_imp.at[t * MODES + m];
        if (p.share[t] == 0.0f) light[t] = 1e6;
    }
    for (int m = 0; m < MODES; m++) CHECK_NEAR(coefficient(&p, m, light), modes[m], 0.05 * 5);
    close_projection(&p);
}

TEST(where_all_is_hidden_there_is_no_light)
{
    const double one[TEXELS] = { [3] = 1.0 };
    struct projection p;
    open_projection(&p, 0, TEXELS);
    for (int m = 0; m < MODES; m++) CHECK(coefficient(&p, m, one) == 0.0);
    close_projection(&p);
}

// ---- fitted to the light of a block

enum { EDGE = 4, OF_CUBE = 6 * EDGE * EDGE, FACE = EDGE * EDGE, FITTED = 2 };

// In a box of 4 x 1 x 1 every texel has the mean of all walls by their areas: F. The modes are
// constant and linear along it, and T_d→b fits them to texels without regard to their areas.
static void open_fit(struct matrix_f32 *f, struct matrix_f32 *l_imp, struct matrix_f32 *t_db)
{
    const struct mrt_shape cube = mrt_cube(EDGE, 0);
    float square = 0.0f;
    assert_true(matrix_f32_init(test_host(), f, OF_CUBE, OF_CUBE) &&
                matrix_f32_init(test_host(), l_imp, OF_CUBE, FITTED) &&
                matrix_f32_init(test_host(), t_db, FITTED, OF_CUBE));
    for (int t = 0; t < OF_CUBE; t++) {
        const float x = mrt_shape_texel(&cube, t).position.x;
        l_imp->at[t * FITTED] = 1.0f;
        l_imp->at[t * FITTED + 1] = x;
        square += x * x;
        for (int to = 0; to < OF_CUBE; to++)
            f->at[to * OF_CUBE + t] = (t / FACE < 2 ? 1.0f : 4.0f) / (18.0f * FACE);
    }
    for (int t = 0; t < OF_CUBE; t++) {
        t_db->at[t] = 1.0f / OF_CUBE;
        t_db->at[OF_CUBE + t] = l_imp->at[t * FITTED + 1] / square;
    }
}

// Mean irradiance of light on one face.
static double lit_by(const struct matrix_f32 *t_db, const struct matrix_f32 *u_b, int face)
{
    double sum = 0.0;
    for (int m = 0; m < FITTED; m++) {
        double b = 0.0;
        for (int t = face * FACE; t < (face + 1) * FACE; t++)
            b += (double)t_db->at[m * OF_CUBE + t];
        sum += b * (double)u_b->at[m];
    }
    return sum;
}

TEST(fitted_light_has_the_energy_of_walls_of_unequal_areas)
{
    struct matrix_f32 f, l_imp, t_db, u_b;
    const struct mrt_projection projection = {
        mrt_cube(EDGE, 0), mrt_cube(EDGE, 0), glms_mat3_identity(), &f, &u_b, &l_imp
    };
    struct mrt_projection of = projection;
    of.block_from_cell.m00 = 4.0f;
    open_fit(&f, &l_imp, &t_db);
    assert_true(matrix_f32_init(test_host(), &u_b, OF_CUBE, FITTED) &&
                matrix_f32_multiply(test_host(), 1.0f, &f, NOT_TRANSPOSED, &l_imp, NOT_TRANSPOSED,
                                    0.0f, &u_b));
    CHECK_NEAR(lit_by(&t_db, &u_b, 0), 1.0 / 6.0, 1e-3);
    CHECK(mrt_fit_projection(test_host(), &of, &t_db));
    // The damping is a hundredth.
    for (int face = 0; face < 6; face++)
        CHECK_NEAR(lit_by(&t_db, &u_b, face), (face < 2 ? 1.0 : 4.0) / 18.0, 0.02 / 6.0);
    matrix_f32_finish(test_host(), &f);
    matrix_f32_finish(test_host(), &l_imp);
    matrix_f32_finish(test_host(), &t_db);
    matrix_f32_finish(test_host(), &u_b);
}
