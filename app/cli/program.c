// Finds and runs the command of a command line.
#include "program.h"
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

// With others, only rank 0 prints.
static enum status run_informing(int count, char **words, bool *done)
{
    *done = true;
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
    *done = false;
    return DONE;
}

static enum status check_team(const struct command *command, const struct team *team)
{
    if (!team || (command->bit & (BAKE | REFERENCE)) || team->ranks.count == 1) return DONE;
    return wrong_usage("cannot run %s on %d ranks: only bake and reference work on several; use "
                       "afterglow %s",
                       command->name, team->ranks.count, command->name);
}

static enum status run_command(const struct command *command, int count, char **words,
                               const struct team *team)
{
    struct arguments arguments;
    const bool leads = !team || team->ranks.rank == 0;
    enum status status = arguments_parse(command, count, words, &arguments);
    if (status != DONE) return status;
    if (arguments.help) {
        if (leads) help_command(command);
        return DONE;
    }
    status = check_team(command, team);
    if (status != DONE) return status;
    arguments.team = team;
    if (team && arguments.threads == 0) arguments.threads = team->threads;
    messages_init(arguments.quiet || !leads, arguments.verbose && leads);
    return command->run(&arguments);
}

static enum status run(int count, char **words, const struct team *team)
{
    bool done = false;
    const bool leads = !team || team->ranks.rank == 0;
    const struct command *command = count > 1 ? command_find(words[1]) : NULL;
    if (command) return run_command(command, count - 2, words + 2, team);
    if (!leads) return DONE; // rank 0 says what is wrong
    const enum status status = run_informing(count, words, &done);
    return done ? status : unknown_command(words[1]);
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

void program_begin(bool term_interrupts)
{
    keep_standard_streams_apart();
    signal(SIGXFSZ, SIG_IGN); // a file over the size limit is a failed write
    interrupt_begin(term_interrupts);
}

enum status program_run(int count, char **words, const struct team *team)
{
    return flush_output(run(count, words, team));
}
