// afterglow: finds and runs the command. Exit status: 0 success, 1 failure, 2 wrong usage.
#include "commands.h"
#include "cli/complete/complete.h"
#include "help.h"
#include "cli/files/interrupt.h"

#include <afterglow/catalogue.h>

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static enum status unknown_command(const char *name)
{
    const char *known[MAX_COMMANDS];
    int count = 0;
    for (; count < MAX_COMMANDS && command_get(count); count++)
        known[count] = command_get(count)->name;
    const char *nearest = ag_nearest_name(name, known, count);
    if (nearest) return wrong_usage("unknown command %s: did you mean %s?", name, nearest);
    return wrong_usage("unknown command %s: see afterglow --help", name);
}

// Reports an error of buffered output, which otherwise nobody would notice.
static enum status flush_output(enum status status)
{
    bool failed = fflush(stdout) != 0 || ferror(stdout);
    return failed && status == DONE ? fail("cannot write standard output: it is closed or full")
                                    : status;
}

static enum status help(int count, char **words)
{
    const struct command *command = count > 0 ? command_find(words[0]) : NULL;
    if (count > 0 && !command) return unknown_command(words[0]);
    if (command)
        help_command(command);
    else
        help_program();
    return DONE;
}

static enum status run(int count, char **words)
{
    if (count < 2) return wrong_usage("no command given: see afterglow --help");
    if (strcmp(words[1], "help") == 0) return help(count - 2, words + 2);
    if (strcmp(words[1], "--help") == 0 || strcmp(words[1], "-h") == 0) return help(0, NULL);
    if (strcmp(words[1], "--version") == 0 || strcmp(words[1], "-V") == 0) {
        int version = ag_version();
        printf("afterglow %d.%d.%d\n", version / 10000, version / 100 % 100, version % 100);
        return DONE;
    }
    if (strcmp(words[1], "__complete") == 0) { // called by app/completions
        complete(count - 2, words + 2);
        return DONE;
    }
    const struct command *command = command_find(words[1]);
    if (!command) return unknown_command(words[1]);
    struct arguments arguments;
    enum status status = arguments_parse(command, count - 2, words + 2, &arguments);
    if (status != DONE) return status;
    if (arguments.help) {
        help_command(command);
        return DONE;
    }
    messages_init(arguments.quiet, arguments.verbose);
    return command->run(&arguments);
}

// If a standard stream is closed, the next opened file gets its descriptor and messages would end
// up in an image. /dev/null opened the wrong way round takes its place and fails like a closed
// stream.
static void keep_standard_streams_apart(void)
{
    for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; fd++)
        if (fcntl(fd, F_GETFD) < 0 && errno == EBADF)
            (void)!open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

int main(int count, char **words)
{
    keep_standard_streams_apart();
    signal(SIGXFSZ, SIG_IGN); // a file over the size limit is a failed write
    interrupt_begin();
    return flush_output(run(count, words));
}
