#!/bin/sh
# documented.sh ROOT: every public function is on docs/library.md's page, and called in a program that the tests run; its comment
# tells the threads that may call it. Every option of the command line is on docs/cli.md's.
set -eu
cd "$1"
bad=0
functions=$(cat include/afterglow/*.h | tr '\n' ' ' | sed 's/AG_API/\nAG_API/g' | sed 's/;.*//' | grep '^AG_API ' | grep -v '__attribute__' |
    grep -o '^[^(;]*(' | grep -o 'ag_[a-z_]*($' | tr -d '(' | sort -u)
[ -n "$functions" ] || { echo "no functions found"; exit 1; }
missing() { # of the functions in the list $1, a line each
    printf '%s\n' "$functions" "$1" "$1" | sort | uniq -u
}
told=$(grep -o '`ag_[a-z_]*`' docs/library.md | tr -d '`' | sort -u)
called=$(cat examples/*.c tests/api/*.c | grep -o 'ag_[a-z_]*(' | tr -d '(' | sort -u)
for name in $(missing "$told"); do echo "$name is not on docs/library.md"; bad=1; done
for name in $(missing "$called"); do echo "$name is called in no example and no test"; bad=1; done
awk '
    /^AG_API / && comment !~ /Thread: / { print FILENAME ":" FNR ": the comment has no \"Thread: ...\" (types.h)"; bad = 1 }
    { comment = /^\/\/\// ? comment $0 : "" }
    END { exit bad }' include/afterglow/*.h || bad=1
for option in $(grep -o '^OPTION("[^"]*"' app/cli/options/options.def | cut -d'"' -f2 | grep -v -e --help); do
    grep -q -e "\`$option[\` ]" docs/cli.md || { echo "$option is not on docs/cli.md"; bad=1; }
done
exit $bad
