// The directional distribution of a cell's light with three bands and 26 neighbours: never
// negative, and with the flux φ, J = ∫ I ω dω and the diagonal of P = ∫ I ω ωᵀ dω. Include after
// core/sh.glsl and lpv_light.glsl.
//
// It is a product of distributions of ω_x, ω_y and ω_z, each with its mean μ and mean square s.
// Along an axis the light of a sphere, a hemisphere or a cone is uniform (Archimedes): |ω_a| is
// uniform over [c, 1] where s > 1/3. Below, its mean is between that of a uniform distribution over
// [0, d], as around a beam, and that of light across the axis with a hemisphere, as beside a lit
// wall. Both signs share |ω_a|, which holds light that meets its own reflection. Where |μ| is
// larger than the mean of |ω_a|, there is one sign.
#ifndef AG_LPV_PRODUCT_GLSL
#define AG_LPV_PRODUCT_GLSL

// Along one axis, of unit flux. Of light that moves in a step, which is a share |ω|: the means of
// |ω| and of ω².
struct lpv_axis {
    vec3 mean, square, size; // means of ω, ω², |ω|
    vec3 moved_mean, moved_square;
    vec3 over_across; // over the mean square along the other axes
};

const float LPV_LEAST_SIZE = 1e-4, LPV_LEAST_ACROSS = 1e-3;

lpv_axis lpv_axis_of(vec3 mean, vec3 square)
{
    lpv_axis axis;
    axis.mean = clamp(mean, vec3(-1.0), vec3(1.0));
    axis.square = clamp(square, axis.mean * axis.mean, vec3(1.0));
    bvec3 is_cone = greaterThan(axis.square, vec3(1.0 / 3.0));
    vec3 root = sqrt(mix(3.0 * axis.square, 12.0 * axis.square - 3.0, is_cone));
    axis.size = max(0.25 * (1.0 + root) * mix(root, vec3(1.0), is_cone), abs(axis.mean));
    vec3 size = max(axis.size, vec3(LPV_LEAST_SIZE)),
         across = max(1.0 - axis.square, vec3(LPV_LEAST_ACROSS)),
         reciprocal = 1.0 / (size * across);
    axis.moved_mean = axis.square * across * reciprocal;
    axis.over_across = size * reciprocal;
    // The value of an interval is the least; a mixture has more.
    vec3 interval = 3.0 * axis.square - 2.0 * axis.size * axis.size;
    axis.moved_square =
        mix(max(interval, 1.125 * axis.moved_mean * axis.moved_mean), interval, is_cone);
    return axis;
}

// Light that moves by `offset` cells in a step, −1, 0 or 1: its flux and moments. Light of the
// direction ω moves by ω cells on the average.
struct lpv_moved {
    vec3 flux, mean, square;
    vec3 across; // what the squares along the other axes gain in sum, over their sum
};

lpv_moved lpv_moved_by(lpv_axis axis, int offset)
{
    lpv_moved moved;
    if (offset == 0) {
        moved.flux = 1.0 - axis.size;
        moved.mean = axis.mean * (1.0 - axis.moved_mean);
        moved.square = axis.square - axis.size * axis.moved_square;
    } else {
        moved.flux = 0.5 * (axis.size + float(offset) * axis.mean);
        moved.mean = float(offset) * axis.moved_mean * moved.flux;
        moved.square = axis.moved_square * moved.flux;
    }
    moved.across = (axis.square * moved.flux - moved.square) * axis.over_across;
    return moved;
}

struct lpv_product {
    vec3 flux;
    lpv_axis axes[3];
    vec3 covariance[3]; // of the other two axes, of unit flux
};

vec3 lpv_flux_of(lpv_light light)
{
    return light.mean / SH_Y0;
}

// P_aa of the flux `flux`.
vec3 lpv_square_of(lpv_light light, int a)
{
    return 2.0 / (SH_Y2_XY * SH_Y2_XY) * light.square[a];
}

lpv_product lpv_product_of(lpv_light light)
{
    lpv_product product;
    product.flux = max(lpv_flux_of(light), vec3(0.0));
    vec3 over_flux = 1.0 / max(product.flux, vec3(1e-15));
    for (int a = 0; a < 3; a++)
        product.axes[a] = lpv_axis_of(over_flux / SH_Y1 * light.along[a],
                                      1.0 / 3.0 + over_flux * lpv_square_of(light, a));
    for (int a = 0; a < 3; a++)
        product.covariance[a] = over_flux / SH_Y2_XY * light.product[a] -
                                product.axes[(a + 1) % 3].mean * product.axes[(a + 2) % 3].mean;
    return product;
}

// Irradiance of unit path: the flux across a side with the normal −n.
vec3 lpv_product_irradiance(lpv_light light, vec3 n)
{
    vec3 flux = max(lpv_flux_of(light), vec3(0.0)), over_flux = 1.0 / max(flux, vec3(1e-15));
    vec3 mean = vec3(0.0), square = vec3(0.0), products = n.yzx * n.zxy;
    for (int a = 0; a < 3; a++) {
        mean -= n[a] / SH_Y1 * light.along[a];
        square +=
            n[a] * n[a] * lpv_square_of(light, a) + 2.0 / SH_Y2_XY * products[a] * light.product[a];
    }
    return flux *
           lpv_moved_by(lpv_axis_of(over_flux * mean, 1.0 / 3.0 + over_flux * square), 1).flux;
}

#endif
