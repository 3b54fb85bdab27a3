// The HTML page of compare: one file with report, images and scripts.
#pragma once

#include "cli/files/json.h"

// Writes folder/report.html for the document of compare (docs/cli.md), completely or not at all.
// Images named under "images", of the reference and of each method, must be PNG files in
// `folder`. The page needs no network and no other file.
enum status report_page_write(const char *folder, const json_t *report);
