// Parsing and printing "source+delta+visibility+reflection".
#include "techniques/gi.h"

#include "techniques/gi_preset.h"
#include "techniques/gi_spec.h"
#include "techniques/registry.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_KNOWN = 64, LIST_SIZE = 512 };

static const char *role_name(enum technique_role role)
{
    static const char *const names[] = { "source", "delta", "visibility", "reflection" };
    return names[role];
}

// A '+' between terms, not in a number such as 1e+3.
static bool is_separator(const char *text, size_t i)
{
    if (text[i] != '+') return false;
    const bool exponent = i >= 2 && (text[i - 1] == 'e' || text[i - 1] == 'E') &&
                          (isdigit((unsigned char)text[i - 2]) || text[i - 2] == '.') &&
                          isdigit((unsigned char)text[i + 1]) && memchr(text, ':', i) != NULL;
    return !exponent;
}

static size_t term_length(const char *text)
{
    size_t length = 0;
    while (text[length] && !is_separator(text, length)) length++;
    return length;
}

static bool fail_unknown(struct host *host, const char *name, const struct technique *const *known)
{
    const char *names[MAX_KNOWN];
    char list[LIST_SIZE] = "";
    size_t count = 0, used = 0;
    if (technique_left_out(name))
        return host_fail(host, FAIL_UNSUPPORTED,
                         "cannot use %s: the library was built without techniques that need a bake "
                         "(AFTERGLOW_BAKES=OFF)",
                         name);
    for (; known[count] && count < MAX_KNOWN; count++) {
        names[count] = known[count]->name;
        const int written =
            snprintf(list + used, sizeof list - used, "%s%s", used ? ", " : "", names[count]);
        if (written > 0)
            used += (size_t)written < sizeof list - used ? (size_t)written : sizeof list - used - 1;
    }
    const char *nearest = nearest_name(name, names, count);
    if (nearest)
        return host_fail(host, FAIL_ARGUMENT, "unknown technique %s: did you mean %s?", name,
                         nearest);
    return host_fail(host, FAIL_ARGUMENT, "unknown technique %s: known are %s", name, list);
}

static const struct technique *find_known(const char *name, size_t length,
                                          const struct technique *const *known)
{
    for (size_t i = 0; known[i]; i++)
        if (strlen(known[i]->name) == length && memcmp(known[i]->name, name, length) == 0)
            return known[i];
    return NULL;
}

// "lpv,steps=8": the first option follows a colon. "lpv,vo": a plus joins techniques. options: what
// follows the term's colon, NULL: it has none.
static bool fail_comma(struct host *host, char *term, const char *options,
                       const struct technique *const *known)
{
    char *comma = strchr(term, ','), *rest = comma + 1;
    if (!find_known(term, (size_t)(comma - term), known)) return fail_unknown(host, term, known);
    *comma = 0;
    const char joint = find_known(rest, strcspn(rest, ","), known) ? '+' : ':';
    return host_fail(host, FAIL_ARGUMENT, "unknown technique %s,%s: did you mean %s%c%s%s%s?", term,
                     rest, term, joint, rest, options ? ":" : "", options ? options : "");
}

// "lpv:steps=8,vo": an option that is the name of a technique. False after a failure.
static bool check_options(struct host *host, const char *name, const char *options,
                          const struct technique *const *known)
{
    for (const char *comma = options; (comma = strchr(comma, ',')); comma++)
        if (find_known(comma + 1, strcspn(comma + 1, ":,"), known))
            return host_fail(host, FAIL_ARGUMENT, "unknown option %s:%s: did you mean %s:%.*s+%s?",
                             name, comma + 1, name, (int)(comma - options), options, comma + 1);
    return true;
}

// Inserts the technique in the order of roles. The spec takes ownership of `options`.
static void insert_term(struct gi_spec *spec, const struct technique *technique, void *options)
{
    int at = spec->count++;
    for (; at > 0 && spec->technique[at - 1]->role > technique->role; at--) {
        spec->technique[at] = spec->technique[at - 1];
        spec->options[at] = spec->options[at - 1];
    }
    spec->technique[at] = technique;
    spec->options[at] = options;
}

static bool add_technique(struct gi_spec *spec, const struct technique *technique,
                          const char *options)
{
    struct host *host = spec->host;
    for (int i = 0; i < spec->count; i++)
        if (spec->technique[i]->role == technique->role)
            return host_fail(host, FAIL_ARGUMENT,
                             "cannot add %s to %s: a GI spec has at most one %s; leave one out",
                             technique->name, spec->technique[i]->name, role_name(technique->role));
    void *values = host_alloc(host, 1, technique->options.size);
    if (!values) return false;
    if (!gi_options_read(host, technique, options, values)) {
        host_free(host, values);
        return false;
    }
    insert_term(spec, technique, values);
    return true;
}

// One "name" or "name:options"; modifies the text.
static bool parse_term(struct gi_spec *spec, char *term, const struct technique *const *known)
{
    char *colon = strchr(term, ':');
    if (colon) *colon = 0;
    if (!term[0])
        return host_fail(spec->host, FAIL_ARGUMENT,
                         "cannot read the GI spec: a technique's name is missing "
                         "(source+delta+visibility+reflection)");
    const struct technique *technique = find_known(term, strlen(term), known);
    if (technique && colon && !check_options(spec->host, term, colon + 1, known)) return false;
    if (technique) return add_technique(spec, technique, colon ? colon + 1 : "");
    return strchr(term, ',') ? fail_comma(spec->host, term, colon ? colon + 1 : NULL, known)
                             : fail_unknown(spec->host, term, known);
}

static bool parse_terms(struct gi_spec *spec, const char *text,
                        const struct technique *const *known)
{
    if (!text[0]) return true;
    for (;;) {
        const size_t length = term_length(text);
        char *term = host_sprintf(spec->host, "%.*s", (int)length, text);
        const bool ok = term && parse_term(spec, term, known);
        host_free(spec->host, term);
        if (!ok) return false;
        if (!text[length]) return true;
        text += length + 1;
    }
}

// The first with probes that needs no bake.
static const struct technique *source_with_probes(const struct technique *const *known)
{
    for (size_t i = 0; known[i]; i++)
        if ((known[i]->capabilities & PUBLISHES_PROBES) && known[i]->bake_version == 0)
            return known[i];
    return NULL;
}

static const struct technique *find_named(const struct technique *const *known, const char *name)
{
    for (size_t i = 0; known[i]; i++)
        if (strcmp(known[i]->name, name) == 0) return known[i];
    return known[0];
}

// Occlusion shows on indirect light only, and reflections show surfaces with it: both alone stand
// on `ambient`. A delta that needs probes stands on a source that has them.
static bool add_default_source(struct gi_spec *spec, const struct technique *const *known)
{
    const struct technique *source = known[0];
    const struct technique *first = spec->count > 0 ? spec->technique[0] : NULL;
    if (first && first->role == ROLE_DELTA)
        source = first->set_probes ? source_with_probes(known) : NULL;
    else if (first)
        source = find_named(known, "ambient");
    if (!source)
        return host_fail(spec->host, FAIL_ARGUMENT, "cannot use %s alone: a delta needs a source",
                         first->name);
    spec->added_source = first != NULL;
    return add_technique(spec, source, "");
}

// Turns the probes of the source on for a delta that needs them.
static bool ask_for_probes(struct gi_spec *spec)
{
    const struct technique *source = spec->technique[0];
    if (spec->count < 2 || !spec->technique[1]->set_probes) return true;
    if (!(source->capabilities & PUBLISHES_PROBES))
        return host_fail(spec->host, FAIL_ARGUMENT,
                         "cannot use %s with %s, which has no probes: try lpv+%s",
                         spec->technique[1]->name, source->name, spec->technique[1]->name);
    const struct option_row *row = option_find(&source->options, "probes");
    if (row && row->type == OPTION_TYPE_bool8)
        *(option_bool8 *)((char *)spec->options[0] + row->offset) = true;
    return true;
}

bool gi_spec_parse_among(struct gi_spec *spec, struct host *host, const char *text,
                         const struct technique *const *known)
{
    *spec = (struct gi_spec){ .host = host };
    if (strlen(text) > GI_MAX_TEXT) {
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot read the GI spec: it is longer than %d characters", GI_MAX_TEXT);
    }
    if (!parse_terms(spec, text, known)) goto fail;
    const bool has_source = spec->count > 0 && spec->technique[0]->role == ROLE_SOURCE;
    if ((has_source || add_default_source(spec, known)) && ask_for_probes(spec)) return true;
fail:
    gi_spec_finish(spec);
    return false;
}

bool gi_spec_parse(struct gi_spec *spec, struct host *host, const char *text)
{
    return gi_spec_parse_among(spec, host, text, techniques);
}

void gi_spec_finish(struct gi_spec *spec)
{
    for (int i = 0; i < spec->count; i++) host_free(spec->host, spec->options[i]);
    *spec = (struct gi_spec){ 0 };
}

bool gi_spec_copy(struct gi_spec *spec, const struct gi_spec *from)
{
    *spec = (struct gi_spec){ .host = from->host, .added_source = from->added_source };
    for (int i = 0; i < from->count; i++) {
        const size_t size = from->technique[i]->options.size;
        void *options = host_alloc(from->host, 1, size);
        if (!options) {
            gi_spec_finish(spec);
            return false;
        }
        if (size > 0) memcpy(options, from->options[i], size);
        insert_term(spec, from->technique[i], options);
    }
    return true;
}

void gi_spec_fit(struct gi_spec *spec, float scene_size_m)
{
    for (int i = 0; i < spec->count; i++)
        if (spec->technique[i]->fit) spec->technique[i]->fit(spec->options[i], scene_size_m);
}

void gi_spec_fit_pose(struct gi_spec *spec, const struct scene_pose *pose)
{
    if (!pose || box3_is_empty(pose->bounds)) return;
    const vec3s size = box3_size(pose->bounds);
    gi_spec_fit(spec, fmaxf(size.x, fmaxf(size.y, size.z)));
}

// text + "separator name=value", freeing text. NULL in, NULL out.
static char *append_option(struct host *host, char *text, char separator,
                           const struct option_row *row, const void *options)
{
    if (!text) return NULL;
    char value[OPTION_VALUE_SIZE];
    option_print(row, options, value, sizeof value);
    char *longer = host_sprintf(host, "%s%c%s=%s", text, separator, row->name, value);
    host_free(host, text);
    return longer;
}

char *gi_spec_print(const struct gi_spec *spec)
{
    char *text = host_strdup(spec->host, "");
    for (int i = 0; text && i < spec->count; i++) {
        const struct technique *technique = spec->technique[i];
        char *longer = host_sprintf(spec->host, "%s%s%s", text, i > 0 ? "+" : "", technique->name);
        host_free(spec->host, text);
        text = longer;
        for (size_t k = 0; k < technique->options.count; k++)
            text = append_option(spec->host, text, k == 0 ? ':' : ',', &technique->options.rows[k],
                                 spec->options[i]);
    }
    return text;
}

uint32_t gi_term_needs(const struct gi_spec *spec, int term)
{
    const struct technique *technique = spec->technique[term];
    return technique->needs |
           (technique->more_needs ? technique->more_needs(spec->options[term]) : 0);
}

uint32_t gi_spec_needs(const struct gi_spec *spec)
{
    uint32_t needs = 0;
    for (int i = 0; i < spec->count; i++) needs |= gi_term_needs(spec, i);
    return needs;
}

uint64_t gi_view_memory_estimate(const struct gi_spec *spec, uint32_t width, uint32_t height,
                                 bool apart)
{
    uint64_t bytes = 0;
    for (int i = 0; i < spec->count; i++)
        bytes += technique_view_memory(spec->technique[i], spec->options[i], width, height, !apart);
    return bytes;
}

uint64_t gi_memory_estimate(const struct gi_spec *spec, uint32_t width, uint32_t height)
{
    uint64_t bytes = 0;
    for (int i = 0; i < spec->count; i++)
        bytes += technique_memory(spec->technique[i], spec->options[i], width, height);
    return bytes;
}

bool gi_spec_gathers_emission(const struct gi_spec *spec)
{
    for (int i = 0; i < spec->count; i++)
        if (spec->technique[i]->capabilities & GATHERS_EMISSION) return true;
    return false;
}
