// The importers that import_file chooses from. Internal to src/scene/import.
#pragma once

#include "scene/import/import_context.h"

// Each fills import->scene from the bytes of the file.
bool import_gltf(struct import *import, const struct file_bytes *bytes);
bool import_ply(struct import *import, const struct file_bytes *bytes);
bool import_program(struct import *import, const struct file_bytes *bytes); // OBJ, FBX, X
