// Points of the triangle that FRAME_ID names.
#ifndef AG_LIGHT_MAP_TRIANGLE_GLSL
#define AG_LIGHT_MAP_TRIANGLE_GLSL

const uint LIGHT_MAP_NO_TRIANGLE = ~0u;

// Among the `count` triangles of its instance. ids: of FRAME_ID.
uint light_map_triangle_of(uvec2 ids, uint count)
{
    return ids.y - 1u < count ? ids.y - 1u : LIGHT_MAP_NO_TRIANGLE;
}

// Weights of the second and third corner of the point of the triangle's plane nearest to p, moved
// into the triangle.
vec2 triangle_weights(vec3 a, vec3 b, vec3 c, vec3 p)
{
    vec3 u = b - a, v = c - a, w = p - a;
    float uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v);
    float area2 = uu * vv - uv * uv;
    if (!(area2 > 0.0)) return vec2(0.0);
    vec2 at = max(vec2(vv * wu - uv * wv, uu * wv - uv * wu) / area2, vec2(0.0));
    return at / max(at.x + at.y, 1.0);
}

// The three points around, of a grid of n steps along an edge, and their weights: with 1 step the
// corners. Points are those with weights i/n and j/n, i + j ≤ n, row j after row j − 1 (mesh
// colours, Yuksel, Keyser & House 2010).
void triangle_points(uint n, vec2 at, out uint points[3], out vec3 weights)
{
    vec2 scaled = at * float(n);
    uint j = min(uint(scaled.y), n - 1u), i = min(uint(scaled.x), n - 1u - j);
    vec2 part = scaled - vec2(i, j);
    uint row = j * (2u * n + 3u - j) / 2u, above = row + n + 1u - j;
    bool upper = part.x + part.y > 1.0 && i + j + 2u <= n;
    points = uint[3](upper ? above + i + 1u : row + i, row + i + 1u, above + i);
    weights = upper ? vec3(part.x + part.y - 1.0, 1.0 - part.y, 1.0 - part.x)
                    : vec3(1.0 - part.x - part.y, part);
}

#endif
