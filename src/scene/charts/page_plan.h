// The page of each chart, and its place there.
#pragma once

#include "scene/charts/charts.h"

struct page_spot {
    uint32_t page, x, y;
};

struct page_plan {
    struct host *host;
    struct page_spot *spots; // [charts]
    uint32_t page_count;
};
// The charts are in an atlas. Fails as charts_set_pages does. page_plan_finish accepts zero.
bool page_plan_init(struct page_plan *out, const struct charts *charts, const struct scene *scene,
                    uint32_t side);
void page_plan_finish(struct page_plan *plan);
