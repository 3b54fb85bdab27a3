// The GLSL twin of sh.h, bands 0 to 2: real, orthonormal, no Condon–Shortley sign, in the order
// Y00, y, z, x, xy, yz, 3z² − 1, xz, x² − y². sh4_… works on bands 0 and 1 in a vec4, sh9_… on
// bands 0 to 2 in an array of floats, or of RGB triples, sh25_… on bands 0 to 4. Directions are
// unit vectors; coefficients have the unit of the function.
//
// Sources: Ramamoorthi & Hanrahan 2001 (irradiance), Sloan 2008 (zonal harmonics).
#ifndef CORE_SH_GLSL
#define CORE_SH_GLSL

const float SH_Y0 = 0.28209479;       // √(1/4π)
const float SH_Y1 = 0.48860251;       // √(3/4π)
const float SH_Y2_XY = 1.09254843;    // √(15/4π): xy, yz, xz
const float SH_Y2_ZZ = 0.31539157;    // √(5/16π): 3z² − 1
const float SH_Y2_XX_YY = 0.54627422; // √(15/16π): x² − y²

// Weights of the bands in the convolution with the clamped cosine.
const float SH_COSINE_0 = 3.14159265; // π
const float SH_COSINE_1 = 2.09439510; // 2π/3
const float SH_COSINE_2 = 0.78539816; // π/4

// ---- bands 0 and 1

vec4 sh4_eval(vec3 direction)
{
    return vec4(SH_Y0, SH_Y1 * direction.y, SH_Y1 * direction.z, SH_Y1 * direction.x);
}

float sh4_dot(vec4 coefficients, vec3 direction)
{
    return dot(coefficients, sh4_eval(direction));
}

// Irradiance coefficients of radiance coefficients.
vec4 sh4_irradiance(vec4 radiance)
{
    return radiance * vec4(SH_COSINE_0, SH_COSINE_1, SH_COSINE_1, SH_COSINE_1);
}

// Coefficients of ω ↦ max(0, ω · direction).
vec4 sh4_clamped_cosine(vec3 direction)
{
    return sh4_irradiance(sh4_eval(direction));
}

// ---- bands 0 to 2

void sh9_eval(vec3 direction, out float basis[9])
{
    float x = direction.x, y = direction.y, z = direction.z;
    basis[0] = SH_Y0;
    basis[1] = SH_Y1 * y;
    basis[2] = SH_Y1 * z;
    basis[3] = SH_Y1 * x;
    basis[4] = SH_Y2_XY * x * y;
    basis[5] = SH_Y2_XY * y * z;
    basis[6] = SH_Y2_ZZ * (3.0 * z * z - 1.0);
    basis[7] = SH_Y2_XY * x * z;
    basis[8] = SH_Y2_XX_YY * (x * x - y * y);
}

float sh9_dot(float coefficients[9], vec3 direction)
{
    float basis[9];
    sh9_eval(direction, basis);
    float sum = 0.0;
    for (int i = 0; i < 9; i++) sum += coefficients[i] * basis[i];
    return sum;
}

vec3 sh9_dot(vec3 coefficients[9], vec3 direction)
{
    float basis[9];
    sh9_eval(direction, basis);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 9; i++) sum += coefficients[i] * basis[i];
    return sum;
}

// The weight of coefficient i in the convolution with the clamped cosine.
float sh9_cosine_weight(int i)
{
    return i == 0 ? SH_COSINE_0 : (i < 4 ? SH_COSINE_1 : SH_COSINE_2);
}

void sh9_irradiance(float radiance[9], out float irradiance[9])
{
    for (int i = 0; i < 9; i++) irradiance[i] = sh9_cosine_weight(i) * radiance[i];
}

void sh9_irradiance(vec3 radiance[9], out vec3 irradiance[9])
{
    for (int i = 0; i < 9; i++) irradiance[i] = sh9_cosine_weight(i) * radiance[i];
}

void sh9_clamped_cosine(vec3 direction, out float lobe[9])
{
    float basis[9];
    sh9_eval(direction, basis);
    sh9_irradiance(basis, lobe);
}

// ---- bands 0 to 4

void sh25_eval(vec3 direction, out float basis[25])
{
    float x = direction.x, y = direction.y, z = direction.z;
    float xx = x * x, yy = y * y, zz = z * z;
    float low[9];
    sh9_eval(direction, low);
    for (int i = 0; i < 9; i++) basis[i] = low[i];
    basis[9] = 0.59004359 * y * (3.0 * xx - yy);   // √(35/32π)
    basis[10] = 2.89061144 * x * y * z;            // √(105/4π)
    basis[11] = 0.45704580 * y * (5.0 * zz - 1.0); // √(21/32π)
    basis[12] = 0.37317633 * z * (5.0 * zz - 3.0); // √(7/16π)
    basis[13] = 0.45704580 * x * (5.0 * zz - 1.0);
    basis[14] = 1.44530572 * z * (xx - yy); // √(105/16π)
    basis[15] = 0.59004359 * x * (xx - 3.0 * yy);
    basis[16] = 2.50334294 * x * y * (xx - yy);               // ¾ √(35/π)
    basis[17] = 1.77013077 * y * z * (3.0 * xx - yy);         // ¾ √(35/2π)
    basis[18] = 0.94617470 * x * y * (7.0 * zz - 1.0);        // ¾ √(5/π)
    basis[19] = 0.66904654 * y * z * (7.0 * zz - 3.0);        // ¾ √(5/2π)
    basis[20] = 0.10578555 * (zz * (35.0 * zz - 30.0) + 3.0); // 3/16 √(1/π)
    basis[21] = 0.66904654 * x * z * (7.0 * zz - 3.0);
    basis[22] = 0.47308735 * (xx - yy) * (7.0 * zz - 1.0); // ⅜ √(5/π)
    basis[23] = 1.77013077 * x * z * (xx - 3.0 * yy);
    basis[24] = 0.62583574 * (xx * (xx - 3.0 * yy) - yy * (3.0 * xx - yy)); // 3/16 √(35/π)
}

#endif
