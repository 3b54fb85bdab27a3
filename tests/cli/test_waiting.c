// A long frame is said within ten seconds, a short one is not.
#include "cli/terminal/waiting.h"

#include "framework/test.h"

#include <fcntl.h>
#include <math.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

// Standard error after a frame of `ms` milliseconds.
static const char *said_after(int frame, double ms)
{
    static char text[512];
    int kept = dup(STDERR_FILENO), file = open(test_path("said"), O_RDWR | O_CREAT | O_TRUNC, 0600);
    assert_true(kept >= 0 && file >= 0);
    dup2(file, STDERR_FILENO);
    waiting_begin(frame, 7);
    test_pause_ms(ms);
    waiting_end();
    dup2(kept, STDERR_FILENO);
    ssize_t got = pread(file, text, sizeof text - 1, 0);
    text[got > 0 ? got : 0] = 0;
    close(kept);
    close(file);
    return text;
}

// Later frames follow a line of progress.
TEST(a_first_frame_of_six_seconds_is_said_once_a_later_one_is_not)
{
    const double ms = 5000 + fmin(1000 * test_time_factor(), 9000); // said after 5 and 15 seconds
    CHECK_STRING(said_after(0, ms), "afterglow: rendering frame 1 of 7: 5 s so far\n");
    CHECK_STRING(said_after(1, ms), "");
}

TEST(short_frames_are_not_said_and_end_at_once)
{
    struct timespec begin, end;
    clock_gettime(CLOCK_MONOTONIC, &begin);
    for (int i = 0; i < 20; i++) CHECK_STRING(said_after(i, 1), "");
    clock_gettime(CLOCK_MONOTONIC, &end);
    CHECK((double)(end.tv_sec - begin.tv_sec) < 4 * test_time_factor());
}
