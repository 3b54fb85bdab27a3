// The page of compare: one file that holds the report, its images and all that shows them.
#pragma once

#include "json.h"

// Writes folder/report.html from the document of compare (docs/cli.md), whole or not at all. The
// images that it names under "images", of the reference and of each method, are PNG files in
// `folder`; any of them may be missing from the document, but none that is named from the folder.
// The page needs no network and no other file.
enum status report_page_write(const char *folder, const json_t *report);
