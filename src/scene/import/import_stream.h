// The standard output of the importer program (src/importer): the greeting, then lines, the last
// of which is one of
//
//     glb SIZE                  and SIZE bytes of a binary glTF file
//     fail KIND WHY             KIND is format, unsupported, file or memory
//     fail link PATH            a symbolic link leads out of the folder
//
// Before it any number of "note FEATURE", a feature that is not read, and of "log TEXT", a debug
// message. The glTF is untrusted: it is read and checked like any other file. Images are named as
// in the original file, or contained.
#pragma once

// The version of the format: a program of another version is refused.
#define IMPORT_STREAM_GREETING "afterglow-import 2\n"
enum { IMPORT_STREAM_LINE = 512 }; // bytes of a line at most, with its end
