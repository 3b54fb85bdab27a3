// The images that fragment shaders of the G-buffer write. Formats: frame.h.
#ifndef AG_GBUFFER_TARGETS_GLSL
#define AG_GBUFFER_TARGETS_GLSL

layout(location = 0) out vec2 out_normal;
layout(location = 1) out vec4 out_albedo;
layout(location = 2) out vec2 out_material;
layout(location = 3) out vec4 out_emissive;
#ifdef GBUFFER_DIELECTRIC
layout(location = 4) out vec4 out_dielectric; // see FRAME_DIELECTRIC
#define MOTION_LOCATION 5
#else
#define MOTION_LOCATION 4
#endif
#ifdef GBUFFER_MOTION
layout(location = MOTION_LOCATION) out vec4 out_motion; // see FRAME_MOTION
#define ID_LOCATION (MOTION_LOCATION + 1)
#else
#define ID_LOCATION MOTION_LOCATION
#endif
#ifdef GBUFFER_ID
layout(location = ID_LOCATION) out uvec2 out_id; // see FRAME_ID
#endif

#endif
