// Interrupts the program or closes its streams during work: files are never left half written.
#include "cli/program.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static bool has_temporary(const char *folder)
{
    DIR *dir = opendir(folder);
    if (!dir) fail_msg("cannot open %s", folder);
    bool found = false;
    for (struct dirent *entry; (entry = readdir(dir));)
        found |= strstr(entry->d_name, ".tmp-") != NULL;
    closedir(dir);
    return found;
}

static pid_t start(char **words)
{
    pid_t child = fork();
    if (child < 0) fail_msg("cannot fork");
    if (child == 0) {
        int nowhere = open("/dev/null", O_WRONLY);
        if (nowhere < 0 || dup2(nowhere, STDOUT_FILENO) < 0) _exit(126);
        execv(AFTERGLOW_PROGRAM, words);
        _exit(127);
    }
    return child;
}

// Writes many images; the signal comes while one is being written.
static void check_signal(int number, const char *name)
{
    char folder[300], pattern[400], first[400];
    snprintf(folder, sizeof folder, "%s", make_folder(name));
    snprintf(pattern, sizeof pattern, "%s/%%d.exr", folder);
    snprintf(first, sizeof first, "%s/0.exr", folder);
    char *words[] = { (char *)AFTERGLOW_PROGRAM,
                      (char *)"render",
                      (char *)"@cornell:light=point",
                      (char *)"--quiet",
                      (char *)"--size=512x512",
                      (char *)"--aov=color,direct,irradiance,normal,albedo,position",
                      (char *)"--frames=1000",
                      (char *)"-o",
                      pattern,
                      NULL };
    pid_t child = start(words);
    int status = 0;
    for (int i = 0; i < 20000 * test_time_factor() && !has_temporary(folder); i++) test_pause_ms(1);
    kill(child, number);
    if (waitpid(child, &status, 0) != child) fail_msg("cannot wait for the program");
    CHECK(WIFSIGNALED(status) && WTERMSIG(status) == number);
    CHECK(!has_temporary(folder));
    CHECK(file_exists(first));
}

TEST(signals_end_the_program_between_files)
{
    require_device();
    check_signal(SIGTERM, "term");
    check_signal(SIGINT, "int");
}

// As under nohup, or in the background of a script.
TEST(signals_that_are_ignored_stay_ignored)
{
    signal(SIGTERM, SIG_IGN);
    char *words[] = { (char *)AFTERGLOW_PROGRAM, (char *)"info", (char *)"@atrium:texels=512",
                      NULL };
    pid_t child = start(words);
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
        kill(child, SIGTERM);
        test_pause_ms(1);
    }
    signal(SIGTERM, SIG_DFL);
    CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

// Two runs, the second without standard streams: its messages must not end up in its files.
TEST(closed_streams_leave_files_alone)
{
    require_device();
    char open_path[300], closed_path[300];
    snprintf(open_path, sizeof open_path, "%s", test_path("open.png"));
    snprintf(closed_path, sizeof closed_path, "%s", test_path("closed.png"));
    char *words[] = { (char *)AFTERGLOW_PROGRAM,
                      (char *)"render",
                      (char *)"@cornell:light=point",
                      (char *)"--verbose",
                      (char *)"--size=32x24",
                      (char *)"-o",
                      closed_path,
                      NULL };
    run_expect(0, "render @cornell:light=point --size=32x24 --quiet -o", open_path, NULL);
    pid_t child = fork();
    if (child == 0) {
        for (int fd = 0; fd < 3; fd++) close(fd);
        execv(AFTERGLOW_PROGRAM, words);
        _exit(127);
    }
    int status = 0;
    if (waitpid(child, &status, 0) != child) fail_msg("cannot wait for the program");
    CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    CHECK(files_are_equal(open_path, closed_path));
}
