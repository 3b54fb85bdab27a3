// The block map of a scene as a file: afterglow info --blocks.
#pragma once

#include "session.h"

// Writes the map of --gi, or of mrt, to the file of --blocks, if that is given.
enum status info_write_blocks(struct session *session);
