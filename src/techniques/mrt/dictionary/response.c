// Decomposition of the response to lightfields.
#include "response.h"

static const double NEGLIGIBLE = 1e-6;

static void fill(const struct linalg_svd *svd, struct mrt_response *out)
{
    for (size_t m = 0; m < out->u_r.columns && m < svd->count; m++) {
        double sigma = svd->sigma[m];
        if (sigma <= NEGLIGIBLE * svd->sigma[0]) break;
        for (size_t r = 0; r < out->u_r.rows; r++)
            out->u_r.at[r * out->u_r.stride + m] = (float)svd->u.at[r * svd->u.stride + m];
        for (size_t c = 0; c < out->t_r.columns; c++) {
            double v = svd->vt.at[m * svd->vt.stride + c];
            out->t_r.at[m * out->t_r.stride + c] = (float)(sigma * v);
            out->lift.at[c * out->lift.stride + m] = (float)(v / sigma);
        }
    }
}

bool mrt_response_init(struct host *host, const struct matrix_f32 *g, int k_r,
                       struct mrt_response *out)
{
    struct matrix_f64 wide = { 0 };
    struct linalg_svd svd = { 0 };
    size_t modes = (size_t)k_r;
    *out = (struct mrt_response){ 0 };
    bool ok = matrix_f64_from_f32(host, g, &wide) &&
              linalg_svd(host, "the response to lightfields", &wide, &svd) &&
              matrix_f32_init(host, &out->u_r, g->rows, modes) &&
              matrix_f32_init(host, &out->t_r, modes, g->columns) &&
              matrix_f32_init(host, &out->lift, g->columns, modes);
    if (ok)
        fill(&svd, out);
    else
        mrt_response_finish(host, out);
    linalg_svd_finish(host, &svd);
    matrix_f64_finish(host, &wide);
    return ok;
}

void mrt_response_finish(struct host *host, struct mrt_response *response)
{
    matrix_f32_finish(host, &response->u_r);
    matrix_f32_finish(host, &response->t_r);
    matrix_f32_finish(host, &response->lift);
}
