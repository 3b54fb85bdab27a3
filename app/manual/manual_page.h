// Made from the tables of commands, options and techniques.
#pragma once

// The manual page, in roff with the man macros, to standard output.
void print_manual_page(void);
