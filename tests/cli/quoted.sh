#!/bin/sh
# quoted.sh PAGE FOLDER: every block of C on the page stands in a source of the folder, line after line but for the indent.
set -eu
page=$1 folder=$2
awk '
    function trimmed(line) { sub(/^[ \t]+/, "", line); sub(/[ \t]+$/, "", line); return line }
    FNR == 1 { files++ }
    FILENAME != page { text[files] = text[files] trimmed($0) "\n"; next }
    /^```c$/ { inside = 1; began = FNR; block = "\n"; next }
    /^```/ && inside {
        inside = 0
        blocks++
        found = 0
        for (i = 1; i < files; i++) if (index("\n" text[i], block)) found = 1
        if (!found) { printf "%s:%d: this block is in no source of the folder\n", page, began; bad = 1 }
        next
    }
    inside { block = block trimmed($0) "\n" }
    END {
        if (!blocks) { print page ": no blocks of C"; bad = 1 }
        exit bad
    }' page="$page" "$folder"/*.[ch] "$page"
