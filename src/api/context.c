// Contexts: the program's log and memory as a host for the modules. Only this file reads the
// environment.
#include "api/objects.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

_Static_assert((int)AG_LOG_ERROR == (int)LOG_ERROR && (int)AG_LOG_WARNING == (int)LOG_WARNING &&
                   (int)AG_LOG_INFO == (int)LOG_INFO && (int)AG_LOG_DEBUG == (int)LOG_DEBUG,
               "levels are converted by value");

static void context_log(void *user, enum log_level level, const char *message)
{
    struct ag_context *context = user;
    if (level == LOG_ERROR)
        snprintf(context->last_error, sizeof context->last_error, "%s", message);
    if (context->log && (int)level <= (int)context->log_up_to)
        context->log(context->user, (enum ag_log_level)level, message);
}

static void *context_reallocate(void *user, void *old, size_t bytes)
{
    struct ag_context *context = user;
    return context->reallocate(context->user, old, bytes);
}

enum ag_result api_done(struct ag_context *context, bool ok)
{
    enum fail_kind failure = context->host.failure;
    context->host.failure = FAIL_NONE;
    if (ok) return AG_OK;
    switch (failure) {
    case FAIL_NONE: // a refused value
    case FAIL_ARGUMENT:
        return AG_ERROR_ARGUMENT;
    case FAIL_FILE:
        return AG_ERROR_FILE;
    case FAIL_FORMAT:
        return AG_ERROR_FORMAT;
    case FAIL_UNSUPPORTED:
        return AG_ERROR_UNSUPPORTED;
    case FAIL_MEMORY:
        return AG_ERROR_MEMORY;
    case FAIL_DEVICE:
        return AG_ERROR_DEVICE;
    case FAIL_CANCELLED:
        return AG_ERROR_CANCELLED;
    }
    return AG_ERROR_ARGUMENT;
}

enum ag_result api_refuse(struct ag_context *context, const char *function, const char *why, ...)
{
    if (!context) return AG_ERROR_ARGUMENT;
    char text[API_MESSAGE_SIZE / 2];
    va_list arguments;
    va_start(arguments, why);
    if (vsnprintf(text, sizeof text, why, arguments) < 0) text[0] = 0;
    va_end(arguments);
    return api_done(context,
                    host_fail(&context->host, FAIL_ARGUMENT, "cannot call %s: %s", function, text));
}

void ag_context_desc_default(struct ag_context_desc *desc)
{
    if (!desc) return;
    *desc = (struct ag_context_desc){ .log_up_to = AG_LOG_WARNING, .use_environment = true };
}

static bool read_environment(struct ag_context *context)
{
    const char *validation = getenv("AFTERGLOW_VALIDATION");
    context->validation = validation && validation[0] && strcmp(validation, "0") != 0;
    const char *shader_dir = getenv("AFTERGLOW_SHADER_DIR");
    if (!shader_dir || !shader_dir[0]) return true;
    context->shader_dir = host_strdup(&context->host, shader_dir);
    return context->shader_dir != NULL;
}

// secure_getenv: a program that runs with more rights than its caller starts no program of his.
static bool choose_importer(struct ag_context *context, const struct ag_context_desc *desc)
{
    const char *given = desc->importer;
    if (!given && desc->use_environment) given = secure_getenv("AFTERGLOW_IMPORTER");
    context->importer =
        given ? host_strdup(&context->host, given) : api_find_importer(&context->host);
    if (context->importer && context->importer[0]) context->host.importer = context->importer;
    return context->host.failure == FAIL_NONE; // else out of memory
}

enum ag_result ag_context_create(const struct ag_context_desc *desc, struct ag_context **out)
{
    if (!out) return AG_ERROR_ARGUMENT;
    *out = NULL;
    struct ag_context_desc fallback;
    ag_context_desc_default(&fallback);
    if (!desc) desc = &fallback;
    if ((unsigned)desc->log_up_to > AG_LOG_DEBUG) return AG_ERROR_ARGUMENT;
    AG_REQUIRE_KNOWN(__func__, NULL, desc);

    // Starts on the stack, so that the program's allocator also provides the context's memory.
    struct ag_context seed = { .log = desc->log,
                               .reallocate = desc->reallocate,
                               .user = desc->user,
                               .log_up_to = desc->log_up_to };
    seed.host =
        (struct host){ .log = context_log,
                       .reallocate = desc->reallocate ? context_reallocate : NULL,
                       .user = &seed,
                       .follow_links = desc->follow_links,
                       .log_up_to = desc->log ? (enum log_level)desc->log_up_to : LOG_ERROR };
    struct ag_context *context = host_alloc(&seed.host, 1, sizeof *context);
    if (!context) return AG_ERROR_MEMORY;
    *context = seed;
    context->host.user = context;
    if (desc->no_links_in)
        context->host.no_links_in = context->no_links_in =
            host_strdup(&context->host, desc->no_links_in);
    if ((desc->no_links_in && !context->no_links_in) ||
        (desc->use_environment && !read_environment(context)) || !choose_importer(context, desc)) {
        ag_context_destroy(context);
        return AG_ERROR_MEMORY;
    }
    *out = context;
    return AG_OK;
}

static void free_context(struct ag_context *context)
{
    host_free(&context->host, context->shader_dir);
    host_free(&context->host, context->no_links_in);
    host_free(&context->host, context->importer);
    struct ag_context last = *context; // context_reallocate reads it while freeing the context
    last.host.user = &last;
    host_free(&last.host, context);
}

void api_context_use(struct ag_context *context)
{
    lifetime_use(&context->life);
}

bool api_same_memory(const struct ag_context *a, const struct ag_context *b)
{
    return a->reallocate == b->reallocate && (!a->reallocate || a->user == b->user);
}

void api_context_release(struct ag_context *context)
{
    if (lifetime_release(&context->life)) free_context(context);
}

void ag_context_destroy(struct ag_context *context)
{
    if (!context) return;
    if (lifetime_destroy(&context->life))
        free_context(context);
    else
        host_log(&context->host, LOG_DEBUG,
                 "ag_context_destroy: objects still use the context (%d)", context->life.users);
}

const char *ag_context_last_error(const struct ag_context *context)
{
    return context ? context->last_error : "";
}
