// Completions that a shell offers at a tab.
#pragma once

// Prints the words that may stand in place of the last of `words`, one a line, each with a tab and
// a description. `words` are those after the program's name and before the cursor; the last one may
// be incomplete or "". A last line ":files" says that files are offered too. The scripts in
// app/completions call it.
void complete(int count, char *const *words);
