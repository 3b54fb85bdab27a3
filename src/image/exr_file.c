// Callbacks of OpenEXR's C core: errors, memory, size limits.
#include "image/exr_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void on_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)code;
    void *user = NULL;
    if (!context || exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user) return;
    struct exr_file *file = user;
    if (!file->message[0]) snprintf(file->message, sizeof file->message, "%s", message);
}

static enum fail_kind kind_of(exr_result_t code, enum fail_kind otherwise)
{
    if (code == EXR_ERR_OUT_OF_MEMORY) return FAIL_MEMORY;
    if (code == EXR_ERR_FEATURE_NOT_IMPLEMENTED) return FAIL_UNSUPPORTED;
    return otherwise;
}

bool exr_fail_reading(struct exr_file *file, exr_result_t code)
{
    return host_fail(file->host, kind_of(code, FAIL_FORMAT), "cannot read %s: %s", file->path,
                     file->message[0] ? file->message : exr_get_default_error_message(code));
}

bool exr_fail_writing(struct exr_file *file, exr_result_t code)
{
    return host_fail(file->host, kind_of(code, FAIL_FILE), "cannot write %s: %s", file->path,
                     file->message[0] ? file->message : exr_get_default_error_message(code));
}

// Zeroed, so that a chunk that unpacks to too few bytes exposes no uninitialized memory. The
// library passes its allocator no user data, so these buffers cannot come from the host.
static void *zeroed(size_t bytes)
{
    return calloc(bytes ? bytes : 1, 1);
}

exr_context_initializer_t exr_initializer(struct exr_file *file)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = on_error;
    init.alloc_fn = zeroed;
    init.free_fn = free;
    init.user_data = file;
    init.max_image_width = init.max_image_height = IMAGE_MAX_SIZE;
    return init;
}

void exr_file_finish(struct exr_file *file)
{
    if (file->context) exr_finish(&file->context);
    file_bytes_finish(file->host, &file->bytes);
}

bool exr_is_plain(const char *layer)
{
    return strcmp(layer, "color") == 0;
}
