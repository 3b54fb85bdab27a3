#include "techniques/kept_bake.h"

#include "framework/test.h"

#include <unistd.h>

bool kept_bake_run(struct bake *bake)
{
    char key[HASH128_TEXT];
    bake_key(bake, key);
    const char *path = test_bake_path(key);
    if (access(path, R_OK) == 0) return bake_load(bake, path);
    return bake_run(bake, &(struct bake_run_options){ .threads = 0 }) &&
           bake_save(bake, path, false);
}
