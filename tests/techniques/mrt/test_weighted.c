// Projection of direct light in blocks whose walls objects hide in part.
#include "framework/test.h"

#include "techniques/mrt/objects/clutter_operators.h"

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
