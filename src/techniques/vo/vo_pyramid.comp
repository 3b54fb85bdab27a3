// A level of the pyramid of depth moments (Loos 2015, sec. 6.3.2): mean and variance of the depth
// buffer's value. The source of level 0 is the depth buffer. Variances are stored instead of second
// moments, whose difference from the squared mean is mostly rounding error.
#version 460
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 8, local_size_y = 8) in;

// Mean and variance; the variance of the depth buffer reads 0.
layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1, rg32f) uniform writeonly image2D target;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), last = textureSize(source, 0) - 1;
    if (any(greaterThanEqual(at, imageSize(target)))) return;
    vec2 child[4];
    vec2 mean = vec2(0.0);
    for (int i = 0; i < 4; i++) {
        child[i] = texelFetch(source, min(2 * at + ivec2(i & 1, i >> 1), last), 0).rg;
        mean += 0.25 * child[i];
    }
    float variance = mean.y;
    for (int i = 0; i < 4; i++) variance += 0.25 * (child[i].x - mean.x) * (child[i].x - mean.x);
    imageStore(target, at, vec4(mean.x, variance, 0.0, 0.0));
}
