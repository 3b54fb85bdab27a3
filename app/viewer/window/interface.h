// The user interface, by Dear ImGui. Positions and sizes are pixels of the window. Between
// interface_begin and interface_end each call draws one element and tells of its use, so that
// panels have no state of their own.
#pragma once

#include "event.h"
#include "swapchain.h"

#ifdef __cplusplus
extern "C" {
#endif

struct interface_desc {
    const struct gpu *gpu;
    const struct swapchain *swapchain;
    float scale; // pixels per unit
    void *user;  // of both functions
    const char *(*clipboard)(void *user);
    void (*set_clipboard)(void *user, const char *text);
};
bool interface_open(const struct interface_desc *desc);
void interface_close(void);
void interface_event(const struct event *event);
void interface_begin(int width, int height, float seconds);
// Draws all elements since interface_begin inside of the window's render pass.
void interface_end(VkCommandBuffer commands);
// Without a window's image to draw to.
void interface_skip(void);
bool interface_wants_mouse(void);
bool interface_wants_keys(void);
bool interface_is_held(void); // an element is being changed: its mouse button is down
// The centre of an element of the last frame by its label, for scripts; false: it is not shown.
bool interface_find(const char *label, float *x, float *y);
// Likewise, of any element: numbers beyond the last begin again at the first.
bool interface_element(unsigned number, float *x, float *y);

// ---- elements: true when the user changed the value or pressed

bool ui_panel_begin(const char *title, float x, float y, float width, float height);
void ui_panel_end(void);
bool ui_tabs_begin(const char *name);
void ui_tabs_end(void);
bool ui_tab_begin(const char *label, bool select);
void ui_tab_end(void);
bool ui_section(const char *label, bool open_at_first);
void ui_push(int id); // elements until ui_pop have names of their own
void ui_pop(void);
void ui_indent(void);
void ui_unindent(void);

void ui_text(const char *format, ...) __attribute__((format(printf, 1, 2)));
void ui_faint(const char *format, ...) __attribute__((format(printf, 1, 2)));
void ui_warning(const char *format, ...) __attribute__((format(printf, 1, 2)));
void ui_tooltip(const char *text); // of the last element
void ui_same_line(void);
void ui_separator(void);
void ui_progress(double done, const char *text);
void ui_disable(bool disabled); // elements until ui_enable
void ui_enable(void);

bool ui_button(const char *label);
bool ui_small_button(const char *label);
bool ui_selectable(const char *label, bool selected);
bool ui_switch(const char *label, bool *value);
bool ui_choice(const char *label, int *index, const char *const *names, int count);
bool ui_integer(const char *label, int *value, int least, int most);
// logarithmic: where the range covers decades and begins above 0.
bool ui_number(const char *label, float *value, float least, float most, const char *format,
               bool logarithmic);
bool ui_numbers(const char *label, float *values, int count, float step, const char *format);
bool ui_color(const char *label, float rgb[3]);
bool ui_line(const char *label, char *text, size_t size);
bool ui_released(void); // whether the last element's change ended, as a slider's when let go

// ---- drawing behind the panels

void ui_stroke(float x0, float y0, float x1, float y1, uint32_t rgba, float width);
void ui_box(float x0, float y0, float x1, float y1, uint32_t rgba);
void ui_disk(float x, float y, float radius, uint32_t rgba);
struct ui_vertex {
    float x, y;
    uint32_t rgba;
};
// Triangles with interpolated colours; three indices each.
void ui_triangles(const struct ui_vertex *vertices, int vertex_count, const int *indices,
                  int index_count);
void ui_label(float x, float y, uint32_t rgba, const char *text);
float ui_label_width(const char *text);

// ---- drawing inside of a panel: reserves a rectangle of its width

struct ui_area {
    float x, y, width, height;
    bool hovered;
    float mouse_x, mouse_y;
};
struct ui_area ui_area(float height);
void ui_area_box(float x0, float y0, float x1, float y1, uint32_t rgba);
void ui_area_stroke(float x0, float y0, float x1, float y1, uint32_t rgba, float width);
void ui_area_text(float x, float y, uint32_t rgba, const char *text);

#ifdef __cplusplus
}
#endif
