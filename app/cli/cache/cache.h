// Cache of references and bakes between runs, in $AFTERGLOW_CACHE, $XDG_CACHE_HOME/afterglow or
// ~/.cache/afterglow. Without such a folder nothing is cached. Both kinds share one size limit; the
// least recently used files go first.
#pragma once

#include "cache_root.h"
#include "cli/files/whole_file.h"

enum cache_kind { CACHE_REFERENCE, CACHE_BAKE };
enum { CACHE_KINDS = CACHE_BAKE + 1 };

// The folder of a kind, created. False: no cache; why (may be NULL) states the reason.
enum { CACHE_WHY_SIZE = 512 };
bool cache_folder(enum cache_kind kind, char out[PATH_SIZE], char why[CACHE_WHY_SIZE]);
// Path of the cached file for `key` (letters, digits, blanks), in that folder.
bool cache_file(enum cache_kind kind, const char *key, char out[PATH_SIZE],
                char why[CACHE_WHY_SIZE]);
// The remedy for a cache that is not there, in messages.
#define CACHE_REMEDY "set AFTERGLOW_CACHE to a folder that can be written"
// Marks a file as recently used.
void cache_touch(const char *path);
// Removes the least recently used files, except `path`, until the cache of which it is a file is
// within its size limit.
void cache_trim(const char *path);

struct cache_entry {
    enum cache_kind kind;
    bool left_over; // a temporary file of a writer that was ended
    char path[PATH_SIZE];
    long long bytes;
    long long used_s, used_ns; // since 1970
};
const char *cache_entry_kind(const struct cache_entry *entry); // "reference", "bake", "left-over"
long long cache_limit(void);                                   // bytes
// All files of a cache but those that are being written, the least recently used first; the caller
// frees *out. -1: out of memory.
int cache_list(const char *root, struct cache_entry **out);
// False: it is still there.
bool cache_remove(const struct cache_entry *entry);
