// Visibility of probes, by which lookups leave out those behind walls: common/probes/lookup.glsl.
#ifndef AG_PROBES_DEPTH_SHARED_H
#define AG_PROBES_DEPTH_SHARED_H

#define PROBE_DEPTH_SIDE 8                      // cells of the map
#define PROBE_DEPTH_TILE (PROBE_DEPTH_SIDE + 1) // points at their corners
// Spacings over distances, least and most: a cell's diagonal is √3.
#define PROBE_FAR  0.3f
#define PROBE_NEAR 32.0f

#define PROBE_OCCLUDED 1e-5f // weight of probes behind walls, which counts if all are
#define PROBE_SPREAD   0.01f // least deviation, over the depth
// The largest error of interpolated depths at the edges of a room, over the depth. A point that is
// behind by twice of that is hidden, whatever the deviation.
#define PROBE_ERROR 0.2f

// As enum ag_probes_visibility_kind.
#define PROBE_VISIBILITY_NONE   0
#define PROBE_VISIBILITY_DEPTHS 1
#define PROBE_VISIBILITY_WALLS  2

#endif
