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
        "Opens a window with SCENE, or with the scene of a session FILE.json. W A S D, Q and E\n"
        "fly, the right mouse button looks around, the middle one turns around what is in front,\n"
        "the wheel goes nearer, F looks at what was clicked. The panels at the side have lights,\n"
        "the environment, methods with all their options, the blocks of mrt and drt to be edited,\n"
        "times and memory; 'Copy as command' gives the command line for the same image.\n"
        "Control Z undoes. A scene or session that is dropped on the window opens in it.\n"
        "Bakes are taken from the cache, or run while the window shows the old method.\n",
    .examples = "  afterglow view @atrium --gi lpv\n"
                "      a built-in scene with light propagation volumes\n"
                "  afterglow view house.glb --gi vct+vo --split none\n"
                "      two methods in one image\n"
                "  afterglow view afterglow-session.json\n"
                "      goes on where a saved session ended\n"
                "  afterglow view @cornell --frames 10 --screenshot window.png\n"
                "      ten frames, then the window as an image; also on a virtual display\n",
    .run = view,
};
