// The file: a header that names the bake and its plan, then records, a head and the blocks of the
// task's outputs. Numbers are those of the machine: other machines ignore the file.
#include "bake/journal.h"

#include "core/files/file.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char ENDING[] = ".tasks";
static const char MAGIC[8] = { 'A', 'G', 'T', 'A', 'S', 'K', 'S', '1' };

struct journal_header {
    char magic[8];
    char key[HASH128_TEXT];
    char unused[7];
    uint64_t plan; // hash of stages and tasks
};

struct record {
    uint32_t stage, task;
    double seconds, run_s;
    uint64_t bytes; // of the blocks that follow
    uint64_t hash;  // of the members before and of the blocks
};

char *journal_path(struct host *host, const char *checkpoint)
{
    return host_sprintf(host, "%s%s", checkpoint, ENDING);
}

static uint64_t plan_hash(const struct bake_plan *plan)
{
    uint64_t hash = 0;
    for (int s = 0; s < plan->stage_count; s++) {
        const struct planned_stage *stage = &plan->stages[s];
        const uint64_t tasks = stage->what.task_count;
        hash = hash_bytes(stage->what.name, strlen(stage->what.name), hash);
        hash = hash_bytes(&tasks, sizeof tasks, hash);
        for (int i = 0; i < stage->what.output_count; i++)
            hash = hash_bytes(&stage->outputs[i].bytes, sizeof stage->outputs[i].bytes, hash);
    }
    return hash;
}

static struct journal_header header_of(const struct bake *bake)
{
    struct journal_header header = { .plan = plan_hash(&bake->plan) };
    memcpy(header.magic, MAGIC, sizeof MAGIC);
    bake_key(bake, header.key);
    return header;
}

static uint64_t begin_hash(const struct record *record)
{
    return hash_bytes(record, offsetof(struct record, hash), 0);
}

// ---- writing

static bool fail_create(struct bake *bake, const char *path)
{
    return host_fail(bake->host, FAIL_FILE,
                     "cannot keep finished tasks in %s: %s; nothing that was kept before is lost",
                     path, strerror(errno));
}

static bool write_all(int file, const void *data, size_t bytes)
{
    const char *at = data;
    while (bytes > 0) {
        const ssize_t wrote = write(file, at, bytes);
        if (wrote < 0 && errno == EINTR) continue;
        if (wrote <= 0) return false;
        at += wrote;
        bytes -= (size_t)wrote;
    }
    return true;
}

// The header, written beside and renamed, as every file.
static bool create(struct bake *bake, const char *path)
{
    const struct journal_header header = header_of(bake);
    struct file_writer writer;
    if (!file_begin(&writer, bake->host, path)) return false;
    file_write(&writer, &header, sizeof header);
    return file_commit(&writer);
}

bool journal_begin(struct journal *journal, struct bake *bake, const char *checkpoint)
{
    *journal = (struct journal){ .file = -1 };
    pthread_mutex_init(&journal->mutex, NULL);
    if (!checkpoint) return true;
    journal->path = journal_path(bake->host, checkpoint);
    if (!journal->path || !create(bake, journal->path)) return false;
    journal->file = open(journal->path, O_WRONLY | O_APPEND | O_CLOEXEC);
    return journal->file >= 0 || fail_create(bake, journal->path);
}

void journal_finish(struct journal *journal, struct host *host)
{
    if (journal->file >= 0) close(journal->file);
    host_free(host, journal->path);
    pthread_mutex_destroy(&journal->mutex);
    *journal = (struct journal){ .file = -1 };
}

static bool write_record(int file, const struct record *record, const struct planned_stage *stage,
                         const size_t *bytes, void *const *out)
{
    bool ok = write_all(file, record, sizeof *record);
    for (int i = 0; ok && i < stage->what.output_count; i++) ok = write_all(file, out[i], bytes[i]);
    return ok;
}

bool journal_add(struct journal *journal, const struct bake *bake,
                 const struct journal_entry *entry, void *const *out)
{
    const struct planned_stage *stage = entry->stage;
    size_t bytes[BAKE_MAX_OUTPUTS];
    struct record record = { .stage = (uint32_t)(stage - bake->plan.stages),
                             .task = (uint32_t)entry->index,
                             .seconds = entry->seconds,
                             .run_s = entry->run_s };
    if (journal->file < 0) return true;
    record.bytes = output_block_sizes(stage, entry->index, bytes);
    record.hash = begin_hash(&record);
    for (int i = 0; i < stage->what.output_count; i++)
        record.hash = hash_bytes(out[i], bytes[i], record.hash);
    pthread_mutex_lock(&journal->mutex);
    if (journal->why == 0 && !write_record(journal->file, &record, stage, bytes, out))
        journal->why = errno ? errno : EIO;
    const bool ok = journal->why == 0;
    pthread_mutex_unlock(&journal->mutex);
    return ok;
}

// ---- reading

struct replay {
    struct host *host;
    struct bake *bake;
    FILE *stream;
};

static bool head_fits(const struct bake *bake, const struct record *record, size_t *bytes)
{
    if (record->stage >= (uint32_t)bake->plan.stage_count) return false;
    const struct planned_stage *stage = &bake->plan.stages[record->stage];
    if (record->task >= stage->what.task_count || !(record->seconds >= 0.0) ||
        !(record->run_s >= 0.0))
        return false;
    return stage->what.wave <= bake->plan.waves_done &&
           record->bytes == output_block_sizes(stage, record->task, bytes) &&
           isfinite(record->seconds) && isfinite(record->run_s);
}

static bool read_blocks(struct replay *r, const struct record *record, const size_t *bytes,
                        char *blocks)
{
    const struct planned_stage *stage = &r->bake->plan.stages[record->stage];
    uint64_t hash = begin_hash(record);
    if (fread(blocks, 1, record->bytes, r->stream) != record->bytes) return false;
    for (int i = 0; i < stage->what.output_count; i++, blocks += bytes[i - 1])
        hash = hash_bytes(blocks, bytes[i], hash);
    return hash == record->hash;
}

// Results of a wave that is complete are reduced already.
static bool take(struct replay *r, const struct record *record, const size_t *bytes,
                 const char *blocks)
{
    struct planned_stage *stage = &r->bake->plan.stages[record->stage];
    if (stage->what.wave < r->bake->plan.waves_done || stage->done[record->task]) return true;
    if (!results_begin(r->bake, stage->what.wave)) return false;
    for (int i = 0; i < stage->what.output_count; blocks += bytes[i++]) {
        size_t size = 0;
        char *to = output_block(stage, &stage->outputs[i], record->task, &size);
        if (size > 0) memcpy(to, blocks, size);
    }
    stage->done[record->task] = true;
    stage->done_count++;
    stage->seconds += record->seconds;
    if (r->bake->seconds < record->run_s) r->bake->seconds = record->run_s;
    return results_complete_waves(r->bake);
}

// False at the end of what can be used, or without memory (*ok).
static bool read_record(struct replay *r, bool *ok)
{
    struct record record;
    size_t bytes[BAKE_MAX_OUTPUTS];
    if (bake_is_complete(r->bake) || fread(&record, sizeof record, 1, r->stream) != 1 ||
        !head_fits(r->bake, &record, bytes))
        return false;
    char *blocks = host_alloc(r->host, (size_t)record.bytes, 1);
    const bool whole = blocks && read_blocks(r, &record, bytes, blocks);
    *ok = blocks && (!whole || take(r, &record, bytes, blocks));
    host_free(r->host, blocks);
    return whole && *ok;
}

static bool read_all(struct replay *r, const char *path)
{
    const struct journal_header wanted = header_of(r->bake);
    struct journal_header header;
    bool ok = true;
    if (fread(&header, sizeof header, 1, r->stream) != 1 ||
        memcmp(&header, &wanted, sizeof header) != 0)
        return host_fail(r->host, FAIL_FORMAT,
                         "cannot use %s: it has no tasks of this bake, its options and its scene",
                         path);
    while (read_record(r, &ok)) continue;
    return ok;
}

static FILE *open_stream(struct host *host, const char *path)
{
    struct stat status;
    const int follow = host->no_links_in ? O_NOFOLLOW : 0;
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | follow);
    if (file < 0) return NULL;
    FILE *stream = fstat(file, &status) == 0 && S_ISREG(status.st_mode) ? fdopen(file, "rb") : NULL;
    if (!stream) close(file);
    return stream;
}

bool journal_read(struct host *host, struct bake *bake, const char *checkpoint)
{
    struct replay r = { .host = host, .bake = bake };
    char *path = journal_path(host, checkpoint);
    bool ok = path != NULL;
    if (ok && access(path, F_OK) == 0) {
        r.stream = open_stream(host, path);
        ok = r.stream ? read_all(&r, path)
                      : host_fail(host, FAIL_FILE, "cannot read %s: %s", path, strerror(errno));
    }
    if (r.stream) fclose(r.stream);
    host_free(host, path);
    return ok;
}
