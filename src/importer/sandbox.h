// The system calls that are left to the importer while it reads an untrusted file. Linux; libc and
// libseccomp alone.
#pragma once

#include <stddef.h>

// From now on the process reads files, writes to `output` and allocates. Other calls fail with
// EPERM; those that begin a program, a process or a connection end the process (SIGSYS). There is
// no way back. Returns NULL, or why the kernel or a container refuses it: then all stays as it was.
const char *sandbox_enter(int output);
