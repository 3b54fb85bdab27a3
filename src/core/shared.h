// Type names for structs shared by C and GLSL: cglm's and stdint's in C, the built-in types in
// GLSL. Shared structs are in X_shared.h files, use scalar block layout (equal to C's layout for
// these types) and assert their size in C.
#ifndef AG_CORE_SHARED_H
#define AG_CORE_SHARED_H

#ifdef AG_GLSL
#define vec2s           vec2
#define vec3s           vec3
#define vec4s           vec4
#define mat4s           mat4
#define int32_t         int
#define uint32_t        uint
#define AG_STRUCT(name) name // the type of a member that is a shared struct itself
#else
#include "core/vec.h"

#include <stdint.h>

#define AG_STRUCT(name) struct name
#endif

#endif
