// Input by scripts: mouse, keys, dropped files, random events.
#include "script_state.h"

#include "viewer/operations.h"

#include <string.h>

static bool run_mouse(const struct words *w)
{
    struct event event = { .kind = script_is(w, "mouse") ? EVENT_MOUSE : EVENT_SCROLL };
    if (sscanf(w->rest, "%f %f", &event.x, &event.y) != 2)
        return script_wrong(w->script, "two numbers expected:", w->rest);
    event_push(w->queue, &event);
    return true;
}

static bool run_button(const struct words *w)
{
    static const char *const buttons[] = { "left", "right", "middle" };
    char name[16] = "", state[16] = "";
    struct event event = { .kind = EVENT_BUTTON, .code = -1 };
    sscanf(w->rest, "%15s %15s", name, state);
    for (int i = 0; i < 3; i++)
        if (strcmp(name, buttons[i]) == 0) event.code = i;
    event.down = strcmp(state, "down") == 0;
    if (event.code < 0) return script_wrong(w->script, "unknown button", name);
    event_push(w->queue, &event);
    return true;
}

static bool run_key(const struct words *w)
{
    char name[32] = "", state[16] = "";
    sscanf(w->rest, "%31s %15s", name, state);
    struct event event = { .kind = EVENT_KEY, .code = event_key_code(name) };
    if (!event.code) return script_wrong(w->script, "unknown key", name);
    event.down = script_is(w, "press") || strcmp(state, "down") == 0;
    event_push(w->queue, &event);
    if (!script_is(w, "press")) return true;
    event.down = false;
    event_push(w->queue, &event);
    return true;
}

static bool run_text(const struct words *w)
{
    for (const char *c = w->rest; *c; c++)
        event_push(w->queue, &(struct event){ .kind = EVENT_TEXT, .code = (unsigned char)*c });
    return true;
}

static bool run_click(const struct words *w)
{
    struct script *script = w->script;
    if (!interface_find(w->rest, &script->click_x, &script->click_y))
        return script_wrong(script, "no element is shown with the label", w->rest);
    event_push(w->queue,
               &(struct event){ .kind = EVENT_MOUSE, .x = script->click_x, .y = script->click_y });
    script->click = 2;
    script->drag_x = script->drag_y = 0;
    return true;
}

static bool run_drag(const struct words *w)
{
    struct script *script = w->script;
    char name[8];
    if (sscanf(w->rest, "%7s %f %f", name, &script->drag_x, &script->drag_y) != 3)
        return script_wrong(script, "drag takes x|y|z|turn DX DY:", w->rest);
    for (int i = 0; i < HANDLE_COUNT; i++)
        if (strcmp(name, gizmo_handles[i]) == 0 &&
            gizmo_find(w->v, (enum gizmo_handle)i, &script->click_x, &script->click_y)) {
            event_push(
                w->queue,
                &(struct event){ .kind = EVENT_MOUSE, .x = script->click_x, .y = script->click_y });
            script->waits = 1; // the panels let go of the mouse
            script->click = 2;
            return true;
        }
    return script_wrong(script, "no handle is shown with the name", name);
}

static bool run_drop(const struct words *w)
{
    struct event event = { .kind = EVENT_DROP };
    snprintf(event.text, sizeof event.text, "%s", w->rest);
    event_push(w->queue, &event);
    w->script->waits = 1;
    return true;
}

static bool run_random(const struct words *w)
{
    unsigned long seed = 0;
    if (sscanf(w->rest, "%lu %d", &seed, &w->script->random_left) != 2)
        return script_wrong(w->script, "random takes SEED N:", w->rest);
    w->script->random = seed * 0x9e3779b97f4a7c15u + 1;
    return true;
}

// ---- random events

static uint32_t draw(struct script *script, uint32_t below)
{
    script->random = script->random * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(script->random >> 33) % below;
}

void script_push_random(struct script *script, struct viewer *v, struct event_queue *queue)
{
    static const char *const names[] = { "w",      "a",    "s",    "d",     "q",
                                         "e",      "f",    "tab",  "enter", "space",
                                         "escape", "home", "down", "up",    "backspace" };
    struct event event = { .kind = EVENT_MOUSE };
    switch (draw(script, 9)) {
    case 8:
        if (interface_element(draw(script, 1 << 20), &event.x, &event.y)) break;
        // fall through
    case 0:
    case 1:
    case 2:
        event.x = (float)draw(script, v->swapchain.width + 1);
        event.y = (float)draw(script, v->swapchain.height + 1);
        break;
    case 3:
    case 4:
    case 5:
        event.kind = EVENT_BUTTON;
        event.code = draw(script, 8) ? 0 : (int)draw(script, 3);
        event.down = draw(script, 2);
        break;
    case 6:
        event.kind = EVENT_KEY;
        event.code = event_key_code(names[draw(script, sizeof names / sizeof *names)]);
        event.down = draw(script, 2);
        break;
    case 7:
        event.kind = draw(script, 2) ? EVENT_SCROLL : EVENT_TEXT;
        event.y = (float)draw(script, 5) - 2.0f;
        event.code = (int)draw(script, 95) + 32;
        if (event.code == '/') event.code = '.'; // files are those of this folder
        break;
    default:
        break;
    }
    event_push(queue, &event);
}

const struct script_command script_input[] = {
    { "mouse", true, run_mouse },    { "scroll", true, run_mouse }, { "button", true, run_button },
    { "key", true, run_key },        { "press", true, run_key },    { "text", true, run_text },
    { "click", false, run_click },   { "drag", false, run_drag },   { "drop", false, run_drop },
    { "random", false, run_random }, { NULL, false, NULL },
};
