#!/bin/sh
# versions.sh LIBRARY INCLUDE CC CXX: programs link only with a library of their headers' minor version, as C and C++; they can
# ask for versions in #if, and find the library's functions with dlsym.
set -eu
library=$1 include=$2 cc=$3 cxx=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat >"$work/create.c" <<'END_C'
#include <afterglow/afterglow.h>
#if AG_VERSION_MAJOR * 10000 + AG_VERSION_MINOR * 100 + AG_VERSION_PATCH != AG_VERSION || AG_VERSION < 100
#error "AG_VERSION"
#endif
#ifdef __cplusplus
static ag_bake_estimate no_function_hides_it;
#endif
int main(void)
{
    struct ag_context *context = NULL;
#ifdef __cplusplus
    if (no_function_hides_it.charts) return 2;
#endif
    if (ag_version() != AG_VERSION || ag_context_create(NULL, &context) != AG_OK) return 1;
    ag_context_destroy(context);
    return 0;
}
END_C
cat >"$work/load.c" <<'END_C'
#include <afterglow/afterglow.h>
#include <dlfcn.h>
int main(int argc, char **argv)
{
    void *library = argc > 1 ? dlopen(argv[1], RTLD_NOW) : NULL;
    enum ag_result (*create)(const struct ag_context_desc *, struct ag_context **) = NULL;
    void (*destroy)(struct ag_context *) = NULL;
    struct ag_context *context = NULL;
    if (!library) return 2;
    *(void **)&create = dlsym(library, AG_CONTEXT_CREATE_SYMBOL);
    *(void **)&destroy = dlsym(library, "ag_context_destroy");
    if (!create || !destroy || create(NULL, &context) != AG_OK) return 1;
    destroy(context);
    return 0;
}
END_C
rpath=-Wl,-rpath,$(dirname "$library")
"$cc" -Wall -Werror -I "$include" "$work/create.c" "$library" "$rpath" -o "$work/c"
"$cxx" -x c++ -std=c++17 -Wall -Werror -I "$include" "$work/create.c" -x none "$library" "$rpath" -o "$work/cxx"
"$cc" -Wall -Werror -I "$include" "$work/load.c" -ldl -o "$work/load"
"$work/c"
"$work/cxx"
"$work/load" "$library"

# Headers of the next minor version.
cp -r "$include" "$work/next"
minor=$(sed -n 's/^#define AG_VERSION_MINOR //p' "$include/afterglow/types.h")
sed -i "s/^#define AG_VERSION_MINOR .*/#define AG_VERSION_MINOR $((minor + 1))/" "$work/next/afterglow/types.h"
for compiler in "$cc" "$cxx -x c++"; do
    # shellcheck disable=SC2086 # a list of words
    $compiler -I "$work/next" -c "$work/create.c" -o "$work/next.o"
    ! "$cc" "$work/next.o" "$library" -o "$work/next.out" 2>"$work/message" ||
        { echo "$compiler: linked with another version"; exit 1; }
    grep -q "undefined reference.*ag_context_create_[0-9]*_$((minor + 1))" "$work/message" || { cat "$work/message"; exit 1; }
done
