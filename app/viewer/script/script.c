#include "script.h"

#include "script_state.h"

#include "viewer/methods/bakes.h"
#include "viewer/operations.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

struct script *script_open(const char *path, char error[1024])
{
    struct script *script = calloc(1, sizeof *script);
    FILE *file = script ? fopen(path, "r") : NULL;
    if (!file) {
        snprintf(error, 1024, "cannot read %s: %s", path, script ? strerror(errno) : "no memory");
        free(script);
        return NULL;
    }
    script->file = file;
    script->path = path;
    return script;
}

void script_close(struct script *script)
{
    if (!script) return;
    fclose(script->file);
    free(script);
}

bool script_failed(const struct script *script, char error[1024])
{
    if (script->error[0]) snprintf(error, 1024, "%s", script->error);
    return script->error[0] != 0;
}

bool script_waits(const struct script *script, const struct viewer *v)
{
    return v->dirty == 0 && (script->samples > 0 || (script->settles && bakes_running(v)));
}

static const struct script_command *find(const char *name, size_t length)
{
    const struct script_command *const tables[] = { script_input, script_commands };
    for (int i = 0; i < 2; i++)
        for (const struct script_command *c = tables[i]; c->name; c++)
            if (strlen(c->name) == length && strncmp(c->name, name, length) == 0) return c;
    return NULL;
}

// ---- lines

static bool read_line(struct script *script, char line[SCRIPT_LINE])
{
    while (fgets(line, SCRIPT_LINE, script->file)) {
        script->line++;
        line[strcspn(line, "\r\n#")] = 0;
        size_t length = strlen(line);
        while (length > 0 && line[length - 1] == ' ') line[--length] = 0;
        if (line[strspn(line, " \t")]) return true;
    }
    return false;
}

static bool run_line(struct script *script, struct viewer *v, struct event_queue *queue,
                     char *line);

static bool run_says(const struct words *w)
{
    return strstr(w->v->message, w->rest) ||
           script_wrong(w->script, "the status line has no such text, but:", w->v->message);
}

// The rest of the line must fail; its sentence goes to the status line.
static bool run_fails(const struct words *w)
{
    struct script *script = w->script;
    if (run_line(script, w->v, w->queue, w->rest))
        return script_wrong(script, "the line did not fail:", w->name);
    if (script->error[0]) viewer_warn(w->v, "%s", script->error);
    script->error[0] = 0;
    return true;
}

static bool run_try(const struct words *w)
{
    struct script *script = w->script;
    run_line(script, w->v, w->queue, w->rest);
    if (script->error[0]) viewer_warn(w->v, "%s", script->error);
    script->error[0] = 0;
    return true;
}

static bool run_line(struct script *script, struct viewer *v, struct event_queue *queue, char *line)
{
    char *name = line + strspn(line, " \t"), *rest = name + strcspn(name, " \t");
    if (*rest) *rest++ = 0;
    rest += strspn(rest, " \t");
    const struct words w = { v, script, queue, name, rest };
    const struct script_command *command = find(name, strlen(name));
    if (script_is(&w, "fails")) return run_fails(&w);
    if (script_is(&w, "try")) return run_try(&w);
    if (script_is(&w, "says")) return run_says(&w);
    return command ? command->run(&w) : script_wrong(script, "unknown command", name);
}

static bool lacks_samples(struct script *script, struct viewer *v)
{
    struct truth_state state = { 0 };
    if (script->samples == 0 || !v->truth) return false;
    truth_get(v->truth, &state);
    if (state.error[0]) script_wrong(script, state.error, "");
    if (state.samples >= script->samples && state.measured && v->offered) script->samples = 0;
    return script->samples > 0;
}

// A line goes on for further frames.
static bool goes_on(struct script *script, struct viewer *v, struct event_queue *queue)
{
    if (script->waits > 0) {
        script->waits--;
        return true;
    }
    if (script->click > 0) {
        if (script->click == 1)
            event_push(queue, &(struct event){ .kind = EVENT_MOUSE,
                                               .x = script->click_x + script->drag_x,
                                               .y = script->click_y + script->drag_y });
        event_push(queue, &(struct event){ .kind = EVENT_BUTTON, .down = script->click == 2 });
        script->click--;
        return true;
    }
    if (script->random_left > 0) {
        script->random_left--;
        script_push_random(script, v, queue);
        return true;
    }
    if (v->screenshot[0]) return true; // the window had no image
    script->records = script->records && v->record.runs;
    if (script->records) return true;          // until the last image is written
    if (v->opening[0] || v->next) return true; // until the scene is there
    script->settles = script->settles && (v->dirty > 0 || bakes_running(v)) &&
                      (script->settle_frames == 0 || --script->settle_frames > 0);
    return script->settles || lacks_samples(script, v);
}

static bool is_event(const char *line)
{
    line += strspn(line, " \t");
    const struct script_command *command = find(line, strcspn(line, " \t"));
    return command && command->is_event;
}

bool script_step(struct script *script, struct viewer *v, struct event_queue *queue)
{
    if (v->screenshot_failed || (script->records && v->record.failed))
        return script_wrong(script, v->message, "");
    while (!goes_on(script, v, queue)) {
        if (!script->text[0] && !read_line(script, script->text)) return false;
        if (queue->count > 0 && !is_event(script->text)) return true;
        if (!run_line(script, v, queue, script->text)) return false;
        script->text[0] = 0;
    }
    return !script->error[0]; // the reference failed
}
