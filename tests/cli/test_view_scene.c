// view: changes of the scene, in the image, undone, in session files.
#include "cli/view_run.h"

#include <stdlib.h>

TEST(light_of_an_object_that_moved_is_complete_when_the_image_has_settled)
{
    require_display();
    view(CORNELL SMALL " --gi drt:quality=low",
         "settle\nsave first.png\ntab Inspect\nchoose instance 5\nwait 1\ndrag x 40 0\nsettle\n"
         "save moved.png\ngi drt:quality=low,update=wait\nsettle\nsave waited.png\n");
    check_differ("first.png", "moved.png");
    check_equal("moved.png", "waited.png");
}
