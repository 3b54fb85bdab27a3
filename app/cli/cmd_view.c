// afterglow view: the scene, light and camera of the command line in a window.
#include "commands.h"
#include "values.h"
#include "cli/view/viewing.h"

static enum status view(const struct arguments *a)
{
    if (a->screenshot && !has_extension(a->screenshot, "png"))
        return wrong_usage("wrong value --screenshot %s: the file name must end in .png",
                           a->screenshot);
    if (a->screenshot && a->frames == 0 && !a->script)
        return wrong_usage("cannot use --screenshot: it requires --frames or --script");
    return viewing_run(a);
}

const struct command command_view = {
    .name = "view",
    .bit = VIEW,
    .positional_count = 1,
    .usage = "SCENE [options]",
    .summary = "look at SCENE in a window, light it, compare methods and see what they cost",
    .text =
        "Opens a window with SCENE. W A S D, Q and E fly, the right mouse button looks around,\n"
        "the middle one turns around what is in front, the wheel goes nearer, F looks at what\n"
        "was clicked. The panels at the side have lights, methods with all their options,\n"
        "times and memory; 'Copy as command' gives the command line for the same image.\n",
    .examples = "  afterglow view @atrium --gi lpv\n"
                "      a built-in scene with light propagation volumes\n"
                "  afterglow view house.glb --gi vct+vo --split none\n"
                "      two methods in one image\n"
                "  afterglow view @cornell --frames 10 --screenshot window.png\n"
                "      ten frames, then the window as an image; also on a virtual display\n",
    .run = view,
};
