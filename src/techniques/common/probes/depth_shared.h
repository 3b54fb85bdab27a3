// Layout of the distances that probes see: common/probes/lookup.glsl.
#ifndef AG_PROBES_DEPTH_SHARED_H
#define AG_PROBES_DEPTH_SHARED_H

#define PROBE_DEPTH_SIDE 8
#define PROBE_DEPTH_TILE (PROBE_DEPTH_SIDE + 2)
// Spacings over distances, least and most: a cell's diagonal is √3.
#define PROBE_FAR  0.3f
#define PROBE_NEAR 32.0f

#endif
