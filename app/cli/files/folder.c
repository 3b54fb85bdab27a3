// A temporary folder is filled, then exchanged with the final one in one step.
#include "folder.h"
#include "interrupt.h"
#include "whole_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// ---- checks

static bool take_path(struct folder *folder, const char *path)
{
    size_t length = strlen(path);
    while (length > 1 && path[length - 1] == '/') length--;
    char *real = realpath(path, NULL);
    int wrote = snprintf(folder->shown, PATH_SIZE, "%.*s", (int)length, path);
    if (wrote < PATH_SIZE)
        wrote = snprintf(folder->path, PATH_SIZE, "%s", real ? real : folder->shown);
    free(real);
    return wrote > 0 && wrote < PATH_SIZE;
}

static bool is_current(const char *path)
{
    struct stat here, there;
    return stat(".", &here) == 0 && stat(path, &there) == 0 && here.st_dev == there.st_dev &&
           here.st_ino == there.st_ino;
}

static enum status check_parent(const char *path)
{
    char parent[PATH_SIZE];
    const char *slash = strrchr(path, '/');
    size_t length = slash == path ? 1 : slash ? (size_t)(slash - path) : 0;
    snprintf(parent, sizeof parent, "%.*s", length ? (int)length : 1, length ? path : ".");
    struct stat info;
    if (stat(parent, &info) != 0) return fail("cannot write %s: no folder %s", path, parent);
    if (!S_ISDIR(info.st_mode)) return fail("cannot write %s: %s is not a folder", path, parent);
    if (access(parent, W_OK | X_OK) != 0)
        return fail("cannot write %s: %s: %s", path, parent, strerror(errno));
    return DONE;
}

static enum status check_files(const struct folder *folder, const char *mark)
{
    DIR *dir = opendir(folder->path);
    if (!dir) return fail("cannot replace %s: %s", folder->shown, strerror(errno));
    char stranger[NAME_MAX + 1] = "";
    int count = 0;
    bool marked = false;
    for (struct dirent *entry; (entry = readdir(dir));) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        count++;
        marked |= strcmp(entry->d_name, mark) == 0;
        bool ours = entry->d_type != DT_DIR && folder->is_ours(entry->d_name);
        if (!ours) snprintf(stranger, sizeof stranger, "%s", entry->d_name);
    }
    closedir(dir);
    if (count > 0 && !marked)
        return fail("cannot replace %s: it is not a result of an earlier run (no %s in it); name "
                    "another folder",
                    folder->shown, mark);
    if (stranger[0])
        return fail("cannot replace %s: %s in it would be lost; move it or name another folder",
                    folder->shown, stranger);
    return DONE;
}

static enum status check_existing(const struct folder *folder, const char *mark)
{
    struct stat info;
    const char *path = folder->path;
    if (stat(path, &info) != 0)
        return errno == ENOENT ? DONE : fail("cannot write %s: %s", path, strerror(errno));
    if (!S_ISDIR(info.st_mode)) return fail("cannot write %s: it is a file, not a folder", path);
    if (is_current(path))
        return fail("cannot replace %s: it is the current folder; name one in it", path);
    if (access(path, R_OK | W_OK | X_OK) != 0)
        return fail("cannot replace %s: %s", path, strerror(errno));
    return check_files(folder, mark);
}

enum status folder_plan(struct folder *folder, const char *path, const char *mark,
                        bool (*is_ours)(const char *name))
{
    *folder = (struct folder){ .is_ours = is_ours };
    if (!take_path(folder, path)) return fail("cannot write %s: the path is too long", path);
    enum status status = check_parent(folder->path);
    return status == DONE ? check_existing(folder, mark) : status;
}

// ---- content

// Removes a folder and its files, or only those accepted by `is_ours` unless NULL. True: it is
// gone.
static bool remove_folder(const char *path, bool (*is_ours)(const char *name))
{
    char file[PATH_SIZE + NAME_MAX + 2];
    DIR *dir = opendir(path);
    if (!dir) return false;
    for (struct dirent *entry; (entry = readdir(dir));) {
        if (is_ours && !is_ours(entry->d_name)) continue;
        snprintf(file, sizeof file, "%s/%s", path, entry->d_name);
        unlink(file); // refuses . and ..
    }
    closedir(dir);
    return rmdir(path) == 0;
}

static void clean(void *user)
{
    struct folder *folder = user;
    if (folder->beside.path[0]) remove_folder(folder->beside.path, NULL);
}

enum status folder_begin(struct folder *folder)
{
    interrupt_clean_with(clean, folder);
    interrupt_hold();
    temporary_remove_stale(folder->path, whole_file_removed, folder->shown);
    int why = temporary_folder(&folder->beside, folder->path) ? 0 : errno;
    if (why == 0) messages_show(folder->beside.path, folder->shown);
    interrupt_release();
    return why == 0 ? DONE : fail("cannot write %s: %s", folder->shown, strerror(why));
}

bool folder_file(const struct folder *folder, const char *name, char out[PATH_SIZE])
{
    return snprintf(out, PATH_SIZE, "%s/%s", folder->beside.path, name) < PATH_SIZE;
}

// 0, or errno.
static int copy(int from, int to)
{
    static char bytes[1 << 16];
    for (ssize_t got; (got = read(from, bytes, sizeof bytes)) != 0;) {
        if (got < 0) return errno;
        for (ssize_t put = 0, wrote; put < got; put += wrote)
            if ((wrote = write(to, bytes + put, (size_t)(got - put))) < 0) return errno;
    }
    return 0;
}

enum status folder_copy(const char *from, const char *path)
{
    interrupt_hold();
    int in = open(from, O_RDONLY | O_CLOEXEC);
    int out = in < 0 ? -1 : open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    int why = out < 0 ? errno : copy(in, out);
    if (in >= 0) close(in);
    if (out >= 0 && close(out) != 0 && why == 0) why = errno;
    interrupt_release();
    return why == 0 ? DONE : fail("cannot copy %s to %s: %s", from, path, strerror(why));
}

// ---- publishing

// 0, or errno. Afterwards the temporary name holds the old folder. File systems that cannot
// exchange have a moment without either.
static int exchange(const struct folder *folder)
{
    const char *beside = folder->beside.path;
    if (renameat2(AT_FDCWD, beside, AT_FDCWD, folder->path, RENAME_EXCHANGE) == 0) return 0;
    if (errno != EINVAL && errno != ENOSYS) return errno;
    char away[PATH_SIZE + 8];
    snprintf(away, sizeof away, "%s.old", beside);
    if (rename(folder->path, away) != 0) return errno;
    int why = rename(beside, folder->path) == 0 ? 0 : errno;
    if (rename(away, why == 0 ? beside : folder->path) != 0 && why == 0) why = errno;
    return why;
}

enum status folder_commit(struct folder *folder, const char *mark)
{
    enum status status = check_existing(folder, mark); // again: the work may have taken hours
    if (status != DONE) return status;
    interrupt_hold();
    bool exists = access(folder->path, F_OK) == 0;
    const char *beside = folder->beside.path;
    int why = exists ? exchange(folder) : rename(beside, folder->path) == 0 ? 0 : errno;
    bool left = why == 0 && exists && !remove_folder(beside, folder->is_ours);
    if (why == 0) {
        messages_show(NULL, NULL);
        if (left) note("warning: cannot remove %s, the earlier results", beside);
        temporary_release(&folder->beside);
    }
    interrupt_release();
    return why == 0 ? DONE : fail("cannot write %s: %s", folder->shown, strerror(why));
}

void folder_abort(struct folder *folder)
{
    if (!folder->path[0]) return;
    interrupt_hold();
    clean(folder);
    messages_show(NULL, NULL);
    temporary_release(&folder->beside);
    interrupt_release();
    interrupt_clean_with(NULL, NULL);
}
