#version 460
// total += sum of all words.
layout(local_size_x = 8) in;
layout(set = 0, binding = 0, std430) readonly buffer Words
{
    uint words[];
};
layout(set = 0, binding = 1, std430) buffer Total
{
    uint total;
};

void main()
{
    if (gl_GlobalInvocationID.x > 0) return;
    uint sum = 0;
    for (uint i = 0; i < uint(words.length()); i++) sum += words[i];
    total += sum;
}
