// Members of JSON objects. Each function keeps *out where there is no such member, and is false,
// with a message that names the file and the object, if the member is wrong.
#pragma once

#include <jansson.h>
#include <stdbool.h>

struct viewer;

struct members {
    struct viewer *v;
    const char *path;  // of the file
    const char *where; // "light", "material" …; "": the document
};

bool member_wrong(struct members *m, const char *format, ...) __attribute__((format(printf, 2, 3)));
// False: `object` is none, or has a member of another name.
bool member_known(struct members *m, json_t *object, const char *const *names, int count);
bool member_number(struct members *m, json_t *object, const char *name, double least, double most,
                   double *out);
bool member_float(struct members *m, json_t *object, const char *name, float least, float most,
                  float *out);
bool member_integer(struct members *m, json_t *object, const char *name, int least, int most,
                    int *out);
bool member_floats(struct members *m, json_t *object, const char *name, float least, int count,
                   float *out);
bool member_boolean(struct members *m, json_t *object, const char *name, bool *out);
bool member_text(struct members *m, json_t *object, const char *name,
                 const char **out); // null: NULL
// An array of at most `most`.
bool member_list(struct members *m, json_t *object, const char *name, size_t most);
