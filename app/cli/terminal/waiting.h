// A line now and then while the program waits for one long step, such as a large frame.
#pragma once

// Until waiting_end a thread writes a note after five seconds, in frames after the first after
// twenty, then every ten. Without a thread there are no notes. --quiet omits them.
void waiting_begin(int frame, int frames);
void waiting_end(void);
