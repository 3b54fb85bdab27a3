// Scripts: events and commands of a text file, a line each, replayed with frames of 1/60 s. Words
// are separated by spaces; the last may have some. '#' begins a comment.
//
//   wait N                       frames pass
//   settle [N]                   frames pass until the image is complete, at most N
//   samples N                    frames pass until the reference has N a pixel
//   mouse X Y                    pixels of the window
//   button left|right|middle down|up
//   scroll X Y                   steps
//   key NAME down|up             w, f, space, escape, left …
//   press NAME                   a key, down and up
//   text WORDS                   characters
//   click LABEL                  moves the mouse to an element of the panels and clicks
//   tab NAME                     shows View, Light, Method, Compare, Cost or Inspect
//   size WxH                     of the window
//   gi SPEC · split SPEC|reference|off · side on|off · layer NAME
//   exposure EV|auto|mean|highlights · tonemap neutral|agx|linear · scale F
//   camera NAME|given · look X,Y,Z X,Y,Z
//   light N X                    switches light N on (1) or off (0), or removes it (remove)
//   paint X,Y,Z NX,NY,NZ RADIUS R,G,B · paint clear
//                                a dab of the brush: point, normal, metres, lux
//   environment file FILE|none|scene
//   environment strength S · environment rotation DEG
//   choose light N|instance N    it gets handles in the tabs Light and Inspect
//   drag x|y|z|turn DX DY        drags a handle by pixels; of a block: -x, +x, -y …
//   blocks read|write FILE       the block map of the method, to be edited; writes and uses it
//   blocks choose N              a block, for the following
//   blocks move FACE M           moves a face (-x, +x, -y …) outwards by metres
//   blocks shift X,Y,Z · blocks corner N X,Y,Z · blocks rename NAME
//   blocks open FACE wall|open|connect
//   blocks extend FACE|add|duplicate|remove
//   blocks join on|off           faces move with the corners of connected blocks
//   path add|every S FPS|record FOLDER
//                                adds the view as a key; seconds from key to key and images a
//                                second; writes the flight's images
//   open FILE                    another scene or session, in this window
//   undo · redo                  changes of scene and methods
//   session write FILE|read FILE
//   drop FILE                    drops a file on the window
//   save FILE · screenshot FILE  the image (.png, .exr); the window (.png)
//   errors FILE                  errors to the reference, as JSON
//   pace clear|FILE              durations of the window's frames since the last pace, as JSON
//   inspect FILE                 the layers at the pixel under the mouse, as JSON
//   command FILE                 the command that renders this view
//   memory FILE                  bytes on the device and in main memory, as JSON
//   fails LINE · says TEXT       a line that must fail; the status line must have a text
//   try LINE                     a line that may fail
//   lose                         as if the device were lost
//   random SEED N                N random events; no text of them has a slash
//   quit
//
// A line that fails ends the script: viewer_run returns its sentence.
#pragma once

#include "viewer/window/event.h"

struct script;
struct viewer;

// NULL with a sentence in `error`.
struct script *script_open(const char *path, char error[1024]);
void script_close(struct script *script); // accepts NULL
// Runs lines until one waits, and appends events. False: the script has ended.
bool script_step(struct script *script, struct viewer *v, struct event_queue *queue);
// It waits for threads, not for frames.
bool script_waits(const struct script *script, const struct viewer *v);
bool script_failed(const struct script *script, char error[1024]);
