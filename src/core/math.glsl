#ifndef AG_CORE_MATH_GLSL
#define AG_CORE_MATH_GLSL

const float PI = 3.14159265, INV_PI = 0.31830988618;

#endif
