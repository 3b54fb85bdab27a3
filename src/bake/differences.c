// Which options of a bake file differ from the wanted ones, for messages.
#include "bake/bake_state.h"

#include <stdio.h>
#include <string.h>

// The next "key=value" of a list "key=value,…"; false at its end.
struct pair {
    const char *key, *value;
    int key_length, value_length;
};

static bool next_pair(const char **list, struct pair *out)
{
    const char *text = *list;
    if (!text[0]) return false;
    const size_t length = strcspn(text, ","), key = strcspn(text, "=,");
    const char *value = text + key + (text[key] == '=');
    *out = (struct pair){ text, value, (int)key, (int)(text + length - value) };
    *list = text + length + (text[length] == ',');
    return true;
}

static bool find(const char *list, const struct pair *wanted, struct pair *out)
{
    while (next_pair(&list, out))
        if (out->key_length == wanted->key_length &&
            memcmp(out->key, wanted->key, (size_t)wanted->key_length) == 0)
            return true;
    return false;
}

static bool is_same(const struct pair *a, const struct pair *b)
{
    return a->value_length == b->value_length &&
           memcmp(a->value, b->value, (size_t)a->value_length) == 0;
}

static size_t append(char *out, size_t size, size_t used, const char *text)
{
    const int wrote = snprintf(out + used, size - used, "%s%s", used ? ", " : "", text);
    return wrote > 0 && used + (size_t)wrote < size ? used + (size_t)wrote : size - 1;
}

void option_differences(const char *of_file, const char *wanted, char *out, size_t size)
{
    struct pair mine, theirs;
    char text[192];
    size_t used = 0;
    out[0] = 0;
    for (const char *list = wanted; next_pair(&list, &mine);) {
        const bool found = find(of_file, &mine, &theirs);
        if (found && is_same(&mine, &theirs)) continue;
        snprintf(text, sizeof text, "%.*s is %.*s, not %.*s", mine.key_length, mine.key,
                 found ? theirs.value_length : 10, found ? theirs.value : "not stated",
                 mine.value_length, mine.value);
        used = append(out, size, used, text);
    }
    for (const char *list = of_file; next_pair(&list, &theirs);) {
        if (find(wanted, &theirs, &mine)) continue;
        snprintf(text, sizeof text, "%.*s is %.*s, an option of another version", theirs.key_length,
                 theirs.key, theirs.value_length, theirs.value);
        used = append(out, size, used, text);
    }
}
