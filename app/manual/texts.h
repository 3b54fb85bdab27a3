// Texts made from the tables of commands, options and techniques; each prints to standard output.
#pragma once

// The manual page, in roff with the man macros.
void print_manual_page(void);
// Completion for bash, and for zsh.
void print_bash_completion(void);
void print_zsh_completion(void);
