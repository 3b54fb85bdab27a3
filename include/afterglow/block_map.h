/// Block maps: the connected blocks that stand for a scene in modular radiance transfer (mrt, drt).
/// docs/block-maps.md describes them as JSON files, which the option `blocks` reads.
#ifndef AFTERGLOW_BLOCK_MAP_H
#define AFTERGLOW_BLOCK_MAP_H

#include <afterglow/scene.h>

AG_BEGIN

struct ag_block_map;
/// The block map that the technique of a GI spec makes for the scene at a moment (animation and
/// time as in ag_scene_camera): read from the file of its option `blocks` or from the scene's
/// nodes, or found in its free space, with the walls that drt opens for clutter. The caller
/// destroys it; the scene is not needed any more.
///
/// AG_ERROR_ARGUMENT: no technique of the spec has a block map (mrt and drt have), or an argument
/// is wrong; AG_ERROR_FORMAT or AG_ERROR_UNSUPPORTED: the map of the file or of the nodes is wrong,
/// as the message says. Thread: the context's.
AG_API enum ag_result ag_block_map_create(struct ag_scene *scene, const char *gi, int animation,
                                          double time_s, struct ag_block_map **out);
/// The map of a text, as the option `blocks` reads a file of it. AG_ERROR_FORMAT: it is wrong; the
/// message names the block. A renderer also checks that the scene has what `clutter` and `walls`
/// name. AG_ERROR_UNSUPPORTED: the library was built without techniques that have block maps.
/// Thread: the context's.
AG_API enum ag_result ag_block_map_parse(struct ag_context *context, const char *json,
                                         struct ag_block_map **out);
/// Accepts NULL. Thread: the context's.
AG_API void ag_block_map_destroy(struct ag_block_map *map);
/// The map as a file of docs/block-maps.md: JSON, UTF-8, lengths in metres; owned by the map, to
/// be written unchanged. A scene without surfaces has a map without blocks, which no file may
/// state. NULL for NULL. Thread: any.
AG_API const char *ag_block_map_json(const struct ag_block_map *map);

AG_END

#endif
