// Option tables: defaults, parsing, printing, JSON, and the effect of changes.
#include "core/option.h"

#include "core/c_locale.h"
#include "core/text.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VALUE_SIZE = 64, LIST_SIZE = 512, NAME_MAX_LENGTH = 63, MAX_KNOWN = 128 };

static void *field_of(const struct option_row *row, void *options)
{
    return (char *)options + row->offset;
}

static const void *const_field_of(const struct option_row *row, const void *options)
{
    return (const char *)options + row->offset;
}

static char *text_of(const struct option_row *row, void *options)
{
    return ((option_text *)field_of(row, options))->at;
}

static const char *const_text_of(const struct option_row *row, const void *options)
{
    return ((const option_text *)const_field_of(row, options))->at;
}

// The value as a number; exact for all types but texts.
static double value_of(const struct option_row *row, const void *options)
{
    const void *field = const_field_of(row, options);
    switch (row->type) {
    case OPTION_TYPE_float32:
        return (double)*(const float *)field;
    case OPTION_TYPE_bool8:
        return *(const bool *)field ? 1.0 : 0.0;
    case OPTION_TYPE_int32:
    case OPTION_TYPE_choice:
        break;
    case OPTION_TYPE_text:
        return 0.0;
    }
    return (double)*(const int32_t *)field;
}

static void set_value(const struct option_row *row, void *options, double value)
{
    void *field = field_of(row, options);
    switch (row->type) {
    case OPTION_TYPE_float32:
        *(float *)field = (float)value;
        break;
    case OPTION_TYPE_bool8:
        *(bool *)field = value != 0.0;
        break;
    case OPTION_TYPE_int32:
    case OPTION_TYPE_choice:
        *(int32_t *)field = (int32_t)value;
        break;
    case OPTION_TYPE_text: // empty by default
        break;
    }
}

// -1: not an old name.
static int find_alias(const struct option_table *table, const char *name)
{
    for (int i = 0; table->aliases && table->aliases[i].old_name; i++)
        if (strcmp(table->aliases[i].old_name, name) == 0) return i;
    return -1;
}

void option_defaults(const struct option_table *table, void *options)
{
    memset(options, 0, table->size);
    for (size_t i = 0; i < table->count; i++)
        set_value(&table->rows[i], options, table->rows[i].initial);
}

const struct option_row *option_find(const struct option_table *table, const char *name)
{
    const int alias = find_alias(table, name);
    if (alias >= 0) name = table->aliases[alias].name;
    for (size_t i = 0; i < table->count; i++)
        if (strcmp(table->rows[i].name, name) == 0) return &table->rows[i];
    return NULL;
}

// ---- choices: "first|second|…"

// The i-th name and its length; NULL past the last.
static const char *choice_name(const char *choices, int32_t i, size_t *length)
{
    if (i < 0) return NULL;
    for (;; i--) {
        *length = strcspn(choices, "|");
        if (i == 0) return choices;
        if (!choices[*length]) return NULL;
        choices += *length + 1;
    }
}

static int32_t choice_index(const char *choices, const char *name)
{
    size_t length;
    const char *choice;
    for (int32_t i = 0; (choice = choice_name(choices, i, &length)); i++)
        if (strlen(name) == length && memcmp(choice, name, length) == 0) return i;
    return -1;
}

// ---- printing

// Bytes that would end a text in a list of options, or begin an escape.
static bool is_escaped(char c)
{
    return c == ',' || c == '+' || c == '%';
}

static void print_text(const char *text, char *out, size_t out_size)
{
    size_t used = 0;
    out[0] = 0;
    for (; *text && used + 1 < out_size; text++)
        used += (size_t)snprintf(out + used, out_size - used, is_escaped(*text) ? "%%%02X" : "%c",
                                 *text);
}

static void print_value(const struct option_row *row, double value, char *out, size_t out_size)
{
    size_t length = 0;
    switch (row->type) {
    case OPTION_TYPE_int32:
        snprintf(out, out_size, "%.0f", value);
        break;
    case OPTION_TYPE_float32:
        text_float((float)value, out, out_size);
        break;
    case OPTION_TYPE_bool8:
        snprintf(out, out_size, "%s", value != 0.0 ? "true" : "false");
        break;
    case OPTION_TYPE_choice: {
        const char *name = choice_name(row->unit, (int32_t)value, &length);
        snprintf(out, out_size, "%.*s", (int)length, name ? name : "");
        break;
    }
    case OPTION_TYPE_text:
        break;
    }
}

void option_print(const struct option_row *row, const void *options, char *out, size_t out_size)
{
    if (row->type == OPTION_TYPE_text) {
        print_text(const_text_of(row, options), out, out_size);
        return;
    }
    struct c_locale scope = c_locale_enter();
    print_value(row, value_of(row, options), out, out_size);
    c_locale_leave(scope);
}

// ---- parsing

struct parse {
    struct host *host;
    const struct option_table *table;
    const char *owner;
    void *options;   // a copy until all items are valid
    uint32_t warned; // a bit for each alias
};

static void warn_of_old_name(struct parse *parse, const char *key)
{
    const int alias = find_alias(parse->table, key);
    if (alias < 0 || parse->warned & (1u << alias)) return;
    parse->warned |= 1u << alias;
    host_log(parse->host, LOG_WARNING,
             "%s: option %s is now %s; the old name will be removed in the next release",
             parse->owner, key, parse->table->aliases[alias].name);
}

static bool fail_value(const struct parse *parse, const struct option_row *row, const char *text,
                       const char *why)
{
    return host_fail(parse->host, FAIL_ARGUMENT, "cannot set %s:%s to \"%s\": %s", parse->owner,
                     row->name, text, why);
}

static bool fail_range(const struct parse *parse, const struct option_row *row, const char *text)
{
    char low[VALUE_SIZE], high[VALUE_SIZE], why[3 * VALUE_SIZE];
    print_value(row, row->min, low, sizeof low);
    print_value(row, row->max, high, sizeof high);
    snprintf(why, sizeof why, "it must be from %s to %s%s%.40s", low, high, row->unit[0] ? " " : "",
             row->unit);
    return fail_value(parse, row, text, why);
}

static bool parse_int(const struct parse *parse, const struct option_row *row, const char *text)
{
    char *end;
    errno = 0;
    long long value = strtoll(text, &end, 10);
    if (end == text || *end) return fail_value(parse, row, text, "it must be a whole number");
    if (errno || (double)value < row->min || (double)value > row->max)
        return fail_range(parse, row, text);
    set_value(row, parse->options, (double)value);
    return true;
}

// The range is compared in single precision: 0.1 lies within 0…0.1 although 0.1f > 0.1.
static bool parse_float(const struct parse *parse, const struct option_row *row, const char *text)
{
    char *end;
    float value = strtof(text, &end);
    if (end == text || *end) return fail_value(parse, row, text, "it must be a number");
    if (!isfinite(value) || value < (float)row->min || value > (float)row->max)
        return fail_range(parse, row, text);
    set_value(row, parse->options, (double)value);
    return true;
}

static bool parse_bool(const struct parse *parse, const struct option_row *row, const char *text)
{
    static const char *const yes[] = { "true", "1", "on", "yes" };
    static const char *const no[] = { "false", "0", "off", "no" };
    for (size_t i = 0; i < sizeof yes / sizeof *yes; i++) {
        bool is_yes = strcmp(text, yes[i]) == 0;
        if (!is_yes && strcmp(text, no[i]) != 0) continue;
        set_value(row, parse->options, is_yes ? 1.0 : 0.0);
        return true;
    }
    return fail_value(parse, row, text, "it must be true or false");
}

static bool fail_choice(const struct parse *parse, const struct option_row *row, const char *text)
{
    static const size_t capacity = MAX_KNOWN;
    char names[MAX_KNOWN][VALUE_SIZE], why[LIST_SIZE];
    const char *known[MAX_KNOWN] = { NULL };
    const char *choice;
    size_t length, count = 0;
    while (count < capacity && (choice = choice_name(row->unit, (int32_t)count, &length))) {
        snprintf(names[count], VALUE_SIZE, "%.*s", (int)length, choice);
        known[count] = names[count];
        count++;
    }
    const char *nearest = nearest_name(text, known, count);
    if (nearest)
        snprintf(why, sizeof why, "did you mean %s? (one of %s)", nearest, row->unit);
    else
        snprintf(why, sizeof why, "it must be one of %s", row->unit);
    return fail_value(parse, row, text, why);
}

static int hex_digit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

// −1: not two digits.
static int unescape(const char *digits)
{
    const int high = hex_digit(digits[0]), low = high < 0 ? -1 : hex_digit(digits[1]);
    return low < 0 ? -1 : 16 * high + low;
}

static bool parse_text(const struct parse *parse, const struct option_row *row, const char *text)
{
    option_text value = { "" };
    size_t used = 0;
    for (const char *c = text; *c; c++) {
        const int byte = *c == '%' ? unescape(c + 1) : (unsigned char)*c;
        if (byte < 0)
            return fail_value(parse, row, text,
                              "a percent sign is written %25, a comma %2C, a plus sign %2B");
        if (byte < ' ' || byte == 127)
            return fail_value(parse, row, text, "it has a control character");
        if (used + 1 == sizeof value.at)
            return fail_value(parse, row, text, "it is longer than 255 bytes");
        value.at[used++] = (char)byte;
        if (*c == '%') c += 2;
    }
    memcpy(text_of(row, parse->options), value.at, sizeof value.at);
    return true;
}

static bool parse_value(const struct parse *parse, const struct option_row *row, const char *text)
{
    switch (row->type) {
    case OPTION_TYPE_int32:
        return parse_int(parse, row, text);
    case OPTION_TYPE_float32:
        return parse_float(parse, row, text);
    case OPTION_TYPE_bool8:
        return parse_bool(parse, row, text);
    case OPTION_TYPE_text:
        return parse_text(parse, row, text);
    case OPTION_TYPE_choice:
        break;
    }
    int32_t index = choice_index(row->unit, text);
    if (index < 0) return fail_choice(parse, row, text);
    set_value(row, parse->options, index);
    return true;
}

static bool fail_unknown(const struct parse *parse, const char *key)
{
    const char *known[MAX_KNOWN] = { NULL };
    char list[LIST_SIZE] = "";
    size_t count = 0, used = 0;
    for (; count < parse->table->count && count < MAX_KNOWN; count++) {
        known[count] = parse->table->rows[count].name;
        if (used >= sizeof list) continue;
        int wrote =
            snprintf(list + used, sizeof list - used, "%s%s", count ? ", " : "", known[count]);
        used += wrote > 0 ? (size_t)wrote : 0;
    }
    const char *nearest = nearest_name(key, known, count);
    if (nearest)
        return host_fail(parse->host, FAIL_ARGUMENT, "unknown option %s:%s: did you mean %s?",
                         parse->owner, key, nearest);
    if (count == 0)
        return host_fail(parse->host, FAIL_ARGUMENT, "unknown option %s:%s: it has no options",
                         parse->owner, key);
    return host_fail(parse->host, FAIL_ARGUMENT, "unknown option %s:%s: known are %s", parse->owner,
                     key, list);
}

// One "key=value".
static bool parse_item(struct parse *parse, char *item)
{
    char *equals = strchr(item, '=');
    if (equals) *equals = 0;
    if (!item[0])
        return host_fail(parse->host, FAIL_ARGUMENT,
                         "cannot read the options of %s: a name is missing (key=value,key=value)",
                         parse->owner);
    const struct option_row *row = option_find(parse->table, item);
    if (!row) return fail_unknown(parse, item);
    warn_of_old_name(parse, item);
    if (equals && (equals[1] || row->type == OPTION_TYPE_text))
        return parse_value(parse, row, equals + 1);
    return host_fail(parse->host, FAIL_ARGUMENT, "cannot set %s:%s: no value is given",
                     parse->owner, item);
}

bool option_parse(struct host *host, const struct option_table *table, const char *owner,
                  const char *text, void *options)
{
    if (!text[0]) return true;
    char *words = host_strdup(host, text);
    void *copy = host_alloc(host, table->size, 1);
    bool ok = words && copy;
    if (ok) {
        memcpy(copy, options, table->size);
        struct parse parse = { .host = host, .table = table, .owner = owner, .options = copy };
        struct c_locale scope = c_locale_enter();
        char *rest = words;
        while (ok && rest) ok = parse_item(&parse, strsep(&rest, ","));
        c_locale_leave(scope);
    }
    if (ok) memcpy(options, copy, table->size);
    host_free(host, words);
    host_free(host, copy);
    return ok;
}

static bool is_same(const struct option_row *row, const void *a, const void *b)
{
    if (row->type == OPTION_TYPE_text)
        return strcmp(const_text_of(row, a), const_text_of(row, b)) == 0;
    return value_of(row, a) == value_of(row, b);
}

static void copy_value(const struct option_row *row, const void *from, void *into)
{
    if (row->type == OPTION_TYPE_text)
        memcpy(text_of(row, into), const_text_of(row, from), OPTION_TEXT_SIZE);
    else
        set_value(row, into, value_of(row, from));
}

int option_difference(const struct option_table *table, const void *a, const void *b)
{
    int strongest = -1;
    for (size_t i = 0; i < table->count; i++) {
        const struct option_row *row = &table->rows[i];
        if (!is_same(row, a, b) && (int)row->effect > strongest) strongest = (int)row->effect;
    }
    return strongest;
}

void option_copy_live(const struct option_table *table, const void *from, void *into)
{
    for (size_t i = 0; i < table->count; i++) {
        const struct option_row *row = &table->rows[i];
        if (row->effect <= INVALIDATE) copy_value(row, from, into);
    }
}

// ---- the nearest name

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

// Edit distance with insertion, deletion, substitution and transposition (optimal string alignment,
// Damerau 1964), case-insensitive. Both have at most NAME_MAX_LENGTH characters.
static size_t edit_distance(const char *a, size_t a_length, const char *b, size_t b_length)
{
    size_t rows[3][NAME_MAX_LENGTH + 1];
    size_t *before = rows[0], *last = rows[1], *now = rows[2];
    for (size_t j = 0; j <= b_length; j++) last[j] = j;
    for (size_t i = 1; i <= a_length; i++) {
        now[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            char ca = lower(a[i - 1]), cb = lower(b[j - 1]);
            now[j] = least(last[j - 1] + (ca != cb), 1 + least(last[j], now[j - 1]));
            bool transposed = i > 1 && j > 1 && ca == lower(b[j - 2]) && cb == lower(a[i - 2]);
            if (transposed) now[j] = least(now[j], before[j - 2] + 1);
        }
        size_t *recycled = before;
        before = last;
        last = now;
        now = recycled;
    }
    return last[b_length];
}

const char *nearest_name(const char *name, const char *const *known, size_t count)
{
    size_t length = strlen(name);
    if (length > NAME_MAX_LENGTH) return NULL;
    const char *nearest = NULL;
    size_t nearest_distance = 2 + length / 4; // one typing error, plus one per four letters
    for (size_t i = 0; i < count; i++) {
        size_t known_length = strlen(known[i]);
        if (known_length > NAME_MAX_LENGTH) continue;
        size_t distance = edit_distance(name, length, known[i], known_length);
        // Names without a common letter are never near.
        if (distance >= nearest_distance || distance >= known_length) continue;
        nearest = known[i];
        nearest_distance = distance;
    }
    return nearest;
}
