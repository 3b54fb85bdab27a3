// HTML pages of reports: one file with data, images, style and scripts, which needs no network and
// no other file.
#pragma once

#include "cli/files/json.h"

// A template is an embedded file in which {{name}} is replaced: by {{images}}, a member of `data`,
// or another embedded file. page_finish accepts zero.
struct page {
    const char *template; // its name
    const char *folder;   // of the images
    const json_t *data;
    json_t *images; // unique file names, as keys
};
// Adds a PNG file of the folder, once; NULL: none. Fails where it is none, or not in the folder.
enum status page_add_image(struct page *page, const char *name);
// Completely or not at all.
enum status page_write(const struct page *page, const char *path);
void page_finish(struct page *page);
