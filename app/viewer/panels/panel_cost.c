// Milliseconds by pass over time, and bytes by owner.
#include "panel.h"
#include "viewer/operations.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const uint32_t colors[] = { 0x4e79a7ff, 0xf28e2bff, 0xe15759ff, 0x76b7b2ff, 0x59a14fff,
                                   0xedc948ff, 0xb07aa1ff, 0xff9da7ff, 0x9c755fff, 0xbab0acff };

static float most_ms(const struct times *times)
{
    float most = 1.0f;
    for (int i = 0; i < VIEWER_HISTORY; i++)
        if (times->frame_ms[i] > most) most = times->frame_ms[i];
    return most;
}

// Stacked columns, the newest at the right. unit: pixels per unit of the interface.
static void plot(const struct times *times, float budget_ms, float unit)
{
    const struct ui_area area = ui_area(180.0f * unit);
    const float most = 1.1f * fmaxf(most_ms(times), budget_ms);
    const float column = area.width / (float)VIEWER_HISTORY, each_ms = area.height / most;
    char text[64];
    ui_area_box(area.x, area.y, area.x + area.width, area.y + area.height, 0x18181aff);
    for (int i = 0; i < times->frames; i++) {
        const int at = (times->newest - i + VIEWER_HISTORY) % VIEWER_HISTORY;
        const float right = area.x + area.width - (float)i * column;
        float y = area.y + area.height;
        for (int k = 0; k < times->count; k++) {
            const float ms = times->ms[k][at];
            if (ms <= 0) continue;
            ui_area_box(right - column, y - ms * each_ms, right, y,
                        colors[k % (int)(sizeof colors / sizeof *colors)]);
            y -= ms * each_ms;
        }
    }
    const float line = area.y + area.height - budget_ms * each_ms;
    ui_area_stroke(area.x, line, area.x + area.width, line, 0xffffffa0, unit);
    snprintf(text, sizeof text, "%.1f ms", (double)budget_ms);
    ui_area_text(area.x + 4.0f * unit, line - 15.0f * unit, 0xffffffff, text);
    snprintf(text, sizeof text, "%.0f ms", (double)most);
    ui_area_text(area.x + 4.0f * unit, area.y + 2.0f * unit, 0xffffff80, text);
}

static void list_passes(const struct times *times, float unit)
{
    for (int k = 0; k < times->count; k++) {
        const float ms = times->ms[k][times->newest];
        if (ms <= 0) continue;
        const struct ui_area area = ui_area(16.0f * unit);
        char text[64];
        ui_area_box(area.x, area.y + 3.0f * unit, area.x + 10.0f * unit, area.y + 13.0f * unit,
                    colors[k % (int)(sizeof colors / sizeof *colors)]);
        ui_area_text(area.x + 16.0f * unit, area.y + unit, 0xe0e0e0ff, times->names[k]);
        snprintf(text, sizeof text, "%8.3f ms", (double)ms);
        ui_area_text(area.x + area.width - ui_label_width(text), area.y + unit, 0xe0e0e0ff, text);
    }
}

static void list_memory(struct viewer *v)
{
    const float unit = window_scale(v->window);
    struct ag_memory owners[64];
    const int count = ag_renderer_memory(v->main.renderer, owners, 64);
    uint64_t sum = 0;
    for (int i = 0; i < count && i < 64; i++) {
        sum += owners[i].bytes;
        const struct ui_area area = ui_area(16.0f * unit);
        char text[64];
        ui_area_text(area.x, area.y + unit, 0xe0e0e0ff, owners[i].owner);
        snprintf(text, sizeof text, "%10.2f MB", (double)owners[i].bytes * 1e-6);
        ui_area_text(area.x + area.width - ui_label_width(text), area.y + unit, 0xe0e0e0ff, text);
    }
    ui_text("in all %.2f MB", (double)sum * 1e-6);
}

// A row for each frame, the oldest first.
static void save_csv(struct viewer *v, const char *path)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    const struct times *times = &v->times;
    if (!file) return;
    fprintf(file, "frame,frame_ms");
    for (int k = 0; k < times->count; k++) fprintf(file, ",%s", times->names[k]);
    for (int i = times->frames - 1; i >= 0; i--) {
        const int at = (times->newest - i + VIEWER_HISTORY) % VIEWER_HISTORY;
        fprintf(file, "\n%d,%.6g", times->frames - i, (double)times->frame_ms[at]);
        for (int k = 0; k < times->count; k++) fprintf(file, ",%.6g", (double)times->ms[k][at]);
    }
    fprintf(file, "\n");
    if (fclose(file) == 0)
        viewer_write_text(v, path, text);
    else
        viewer_warn(v, "cannot write %s: out of memory", path);
    free(text);
}

void panel_cost(struct viewer *v)
{
    const float unit = window_scale(v->window);
    ui_text("%s", v->device_info.name);
    ui_text("%.2f ms on the GPU", (double)v->times.frame_ms[v->times.newest]);
    ui_text("%.0f frames of the window a second", v->frame_s > 0 ? 1.0 / (double)v->frame_s : 0.0);
    plot(&v->times, v->budget_ms, unit);
    ui_number("budget (ms)", &v->budget_ms, 1.0f, 200.0f, "%.1f", true);
    if (ui_button("Save as CSV")) save_csv(v, "afterglow-times.csv");
    if (ui_section("Passes", true)) list_passes(&v->times, unit);
    if (ui_section("Memory", true)) list_memory(v);
}
