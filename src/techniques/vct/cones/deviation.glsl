// Standard deviations of the sum of colours of a pixel, for the filter by variance (denoise.comp).
// Declare `set`, `frame`, the samplers `depth`, `normal` and `now`, total() and position() first.
#ifndef AG_VCT_DEVIATION_GLSL
#define AG_VCT_DEVIATION_GLSL

const float FIRST_DEVIATION = 0.3; // of a frame without history or neighbours, over its light
const float DEVIATION_FRAMES = 16.0;

// Deviation of a frame without a history, from the blocks around on its surface (after Schied et
// al. 2017, sec. 4.2): from second differences along four lines, which are zero where light has a
// gradient. The largest is left out: it may be an edge of a shadow. Of noise alone the others are
// half of the mean: too small a deviation leaves noise for a frame, too large a one blurs edges.
float spatial_deviation(ivec2 pixel, vec3 here, vec3 n, float distance_m, float level)
{
    // Mean square of a difference over the variance: 6 less the correlation of near blocks, which
    // interpolation makes.
    const float SQUARE = 5.0;
    float squares = 0.0, largest = 0.0, count = 0.0;
    float pixel_m = 2.0 / float(frame.width) *
                    mix(length(frame.origin_x), distance_m * length(frame.ray_x), frame.viewer.w);
    for (int i = 0; i < 4; i++) {
        ivec2 step = set.block * ivec2(i == 0 ? 0 : 1, i == 1 ? 0 : i == 3 ? -1 : 1);
        float second = -2.0 * level;
        bool same = true; // surface
        for (int side = -1; side <= 1; side += 2) {
            ivec2 at = pixel + side * step;
            ivec2 inside = clamp(at, ivec2(0), ivec2(frame.width, frame.height) - 1);
            float z = texelFetch(depth, inside, 0).r;
            vec3 there = octahedral_decode(texelFetch(normal, inside, 0).rg);
            same = same && at == inside && z > 0.0 && dot(n, there) > HISTORY_LEAST_COSINE &&
                   abs(dot(n, position(inside, z) - here)) < HISTORY_TOLERANCE_PX * pixel_m;
            second += total(texelFetch(now, inside, 0).rgb);
        }
        float square = same ? second * second : 0.0;
        squares += square;
        largest = max(largest, square);
        count += same ? 1.0 : 0.0;
    }
    float variance = (squares - largest) / (max(count - 1.0, 1.0) * SQUARE);
    return count > 1.0 ? sqrt(variance) : FIRST_DEVIATION * level;
}

// Deviation of one frame: a moving mean of squares, of at most 16 frames. Two frames differ by
// twice the variance, a frame and the mean of w by 1 + 1/w of it.
float deviation_after(float before, float old, float w, float now, float added)
{
    if (w <= 0.0) return FIRST_DEVIATION * now;
    float square = (now - old) * (now - old) * w / (w + 1.0);
    float share = added / (min(w, DEVIATION_FRAMES) + added);
    return sqrt(mix(before * before, square, share));
}

#endif
