// Objects in shaders. Include after dnrt_shared.h.
#ifndef AG_DNRT_OBJECT_GLSL
#define AG_DNRT_OBJECT_GLSL

// By a unit quaternion.
vec3 dnrt_rotate(vec3 v, vec3 axis, float w)
{
    return v + 2.0 * cross(axis, cross(axis, v) + w * v);
}

vec3 dnrt_world_from_object(dnrt_gpu_object object, vec3 v)
{
    vec3 axis = vec3(object.rotation[0], object.rotation[1], object.rotation[2]);
    return dnrt_rotate(v, axis, object.rotation[3]);
}

vec3 dnrt_object_from_world(dnrt_gpu_object object, vec3 v)
{
    vec3 axis = vec3(object.rotation[0], object.rotation[1], object.rotation[2]);
    return dnrt_rotate(v, -axis, object.rotation[3]);
}

// First texel of the object's volume among all.
uvec3 dnrt_slot(dnrt_gpu_object object)
{
    return (uvec3(object.slot) >> uvec3(0, 10, 20)) & 1023u;
}

#endif
