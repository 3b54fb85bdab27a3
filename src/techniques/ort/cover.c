#include "techniques/ort/cover.h"

#include "core/host.h"

bool ort_cover_init(struct ort_cover *cover, struct host *host, uint32_t width, uint32_t height)
{
    *cover = (struct ort_cover){
        .host = host, .width = width, .height = height, .runs = (width + ORT_RUN - 1) / ORT_RUN
    };
    cover->sums =
        host_alloc(host, ((size_t)cover->runs + 1) * ((size_t)height + 1), sizeof *cover->sums);
    return cover->sums;
}

void ort_cover_finish(struct ort_cover *cover)
{
    if (!cover->host) return;
    host_free(cover->host, cover->sums);
    *cover = (struct ort_cover){ 0 };
}

// Texels of a run that are not zero.
static uint32_t count_run(const uint8_t *mask, uint32_t length)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < length; i++) count += mask[i] != 0;
    return count;
}

uint64_t ort_cover_set(struct ort_cover *cover, const uint8_t *mask)
{
    const size_t stride = (size_t)cover->runs + 1;
    uint64_t occupied = 0;
    for (uint32_t y = 0; y < cover->height; y++) {
        const uint8_t *row = mask + (size_t)y * cover->width;
        const uint32_t *above = cover->sums + y * stride;
        uint32_t *sums = cover->sums + (y + 1) * stride;
        uint32_t sum = 0;
        for (uint32_t x = 0; x < cover->runs; x++) {
            const uint32_t rest = cover->width - x * ORT_RUN;
            const uint32_t texels = count_run(row + x * ORT_RUN, rest < ORT_RUN ? rest : ORT_RUN);
            occupied += texels;
            sum += texels > 0;
            sums[x + 1] = above[x + 1] + sum;
        }
    }
    return occupied;
}

// The first or last line of a box along an axis.
static struct ort_box line_of(const struct ort_box *box, int axis, bool last)
{
    struct ort_box line = *box;
    if (last)
        line.from[axis] = box->to[axis] - 1;
    else
        line.to[axis] = box->from[axis] + 1;
    return line;
}

bool ort_cover_crop(const struct ort_cover *cover, struct ort_box *box)
{
    if (ort_cover_count(cover, box) == 0) return false;
    for (int axis = ORT_X; axis <= ORT_Y; axis++)
        for (int last = 0; last <= 1; last++) {
            struct ort_box line = line_of(box, axis, last);
            while (ort_cover_count(cover, &line) == 0) {
                if (last)
                    box->to[axis]--;
                else
                    box->from[axis]++;
                line = line_of(box, axis, last);
            }
        }
    return true;
}
