// Threads that yield: what they compute may take longer, but the interface answers.
#pragma once

// The calling thread, and those it starts from now on, get the processor when others leave it.
void thread_yields(void);
