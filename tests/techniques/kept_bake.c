#include "techniques/kept_bake.h"

#include "framework/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

bool kept_bake_run(struct bake *bake)
{
    char key[HASH128_TEXT], path[600];
    const char *folder = getenv("AFTERGLOW_TEST_BAKES");
    bake_key(bake, key);
    if (folder && folder[0])
        snprintf(path, sizeof path, "%s/%s", folder, key);
    else
        snprintf(path, sizeof path, "%s", test_path(key));
    if (access(path, R_OK) == 0) return bake_load(bake, path);
    return bake_run(bake, &(struct bake_run_options){ .threads = 0 }) &&
           bake_save(bake, path, false);
}
