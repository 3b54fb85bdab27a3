// Session files: what the user changed and looks at, as JSON. They are written completely or not
// at all, and read likewise: a file that is wrong changes nothing.
//
//   afterglow_session   1, the version of the format
//   scene, options      of the command line that opens the scene
//   camera              {"name": NAME} of the scene, null: its first; or {"eye": [m], "yaw",
//   "pitch": radians,
//                       "fov_deg", "distance": m, "speed": m/s}
//   time_s              of the animation
//   exposure_ev         null: automatic
//   metering            of automatic exposure: mean or highlights
//   tonemap             the tone curve
//   layer, debug_view   shown; debug_view null: none
//   scale, split_at, side_by_side, difference, budget_ms   as in the panels
//   gi                  the method
//   compare             null, "reference", or the second method
//   lights              those that were changed, added or removed: "index", "type": sun, point or
//   spot,
//                       "on", "position": m, "direction", "intensity": lux or cd,
//                       "inner_rad", "outer_rad", "removed"
//   sky                 cd/m², if it was changed
//   environment         if it was changed: "source": scene, none or file, "file": .hdr or .exr,
//                       "strength", "rotation": about +y, radians
//   instances           those that were moved: "index", "world_from_mesh": 4×4, column-major
//   materials           those that were changed: "index" and factors as in glTF, "emissive": cd/m²
//   paint               dabs of the brush in their order: "position", "radius": m, "normal",
//                       "lux": irradiance
//   path                "keys": eye, yaw, pitch, fov_deg; "seconds" from key to key; "fps"
//
// A member that is left out keeps its value.
#pragma once

#include <stdbool.h>
#include <stddef.h>

struct viewer;

// The scene that a session file belongs to; false: it is no session file.
bool session_file_scene(const char *path, char *out, size_t size);
// False, with a message, if the file cannot be written.
bool session_file_write(struct viewer *v, const char *path);
// False, with a message that names the file and what is wrong with it.
bool session_file_read(struct viewer *v, const char *path);
