#include "info_blocks.h"

#include "cli/files/whole_file.h"

#define BLOCK_MAP_GI "mrt"

static enum status put_text(FILE *file, const void *text)
{
    fputs(text, file);
    return DONE;
}

enum status info_write_blocks(struct session *session)
{
    const struct arguments *a = session->arguments;
    struct ag_block_map *map = NULL;
    if (!a->blocks) return DONE;
    const enum ag_result result = ag_block_map_create(
        session->scene, a->has_gi ? a->gi : BLOCK_MAP_GI, session->animation, a->time_s, &map);
    const enum status status = result == AG_OK
                                   ? whole_file_write(a->blocks, put_text, ag_block_map_json(map))
                                   : fail_library(session->context, result);
    ag_block_map_destroy(map);
    return status;
}
