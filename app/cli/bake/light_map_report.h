// The report on a light map: figures as JSON, and a page with images of the atlas.
#pragma once

#include "baking.h"
#include "cli/files/folder.h"

#include <jansson.h>

#define LIGHT_MAP_PAGE "report.html"

// A finished light map.
struct light_map_run {
    const struct session *session;
    const struct ag_lightmap *lightmap; // with a report
    struct ag_bake *bakes[MAX_BAKES];   // those it was made with
    int bake_count;
    const char *gi;
    double seconds; // of the command until then
};
// Adds to the members that --json prints: quality, stages, seconds, threads, scene, origin.
enum status light_map_report_add(const struct light_map_run *run, json_t *document);
// Writes the page of that document into the temporary folder.
enum status light_map_page_write(const struct light_map_run *run, const json_t *document,
                                 const struct folder *folder);

// ---- light_map_images.c

struct page;
// Writes the images into the temporary folder and adds them to the page.
enum status light_map_images_write(const struct light_map_run *run, bool noise,
                                   const struct folder *folder, struct page *page);
// The page has them.
void light_map_images_remove(const struct page *page, const struct folder *folder);
// Their colours, for legends.
json_t *light_map_colours(void);
