# Checks files against include_table.txt (the first argument; the files follow, as paths from the project's root):
# every #include, and that Vulkan is used in src/gpu alone and Embree in src/trace alone.
# Prints one line per violation and exits with 1 when there is any. POSIX awk.

function complain(text)
{
    print FILENAME ":" FNR ": " text
    bad = 1
}

function matches(path, pattern)
{
    return path ~ ("^(" pattern ")$")
}

# Row of the table for a file; 0 when none fits.
function row_of(path,    i)
{
    for (i = 1; i <= rows; i++)
        if (matches(path, file_of[i])) return i
    return 0
}

function allowed(path, row,    i, patterns, n)
{
    n = split(common " " may_of[row], patterns, " ")
    for (i = 1; i <= n; i++)
        if (matches(path, patterns[i])) return 1
    return 0
}

function check_include(line,    path, quoted)
{
    quoted = line ~ /^[ \t]*#[ \t]*include[ \t]*"/
    path = line
    sub(/^[ \t]*#[ \t]*include[ \t]*["<]/, "", path)
    sub(/[">].*$/, "", path)
    if (path ~ /(^|\/)\.\.?(\/|$)/) {
        complain("include path " path " is not written from src/")
        return
    }
    if (quoted && path !~ /\//) { # beside the file, or generated
        if (allowed(path, row)) return
        if ((getline ignored < (folder "/" path)) >= 0) { close(folder "/" path); return }
        complain(path " does not lie in " folder)
        return
    }
    if (quoted && index("src/" path, folder "/") == 1) return # its own folder
    if (!allowed(path, row)) complain(FILENAME " may not include " path)
}

# The line without comments and string literals.
function code_of(line,    out, c, two, i, n)
{
    out = ""
    n = length(line)
    for (i = 1; i <= n; i++) {
        c = substr(line, i, 1)
        two = substr(line, i, 2)
        if (in_comment) {
            if (two == "*/") { in_comment = 0; i++ }
        } else if (two == "/*") {
            in_comment = 1
            i++
        } else if (two == "//") {
            break
        } else if (c == "\"") {
            for (i++; i <= n && substr(line, i, 1) != "\""; i++)
                if (substr(line, i, 1) == "\\") i++
        } else {
            out = out c
        }
    }
    return out
}

function check_identifiers(code)
{
    if (FILENAME !~ /^(src\/gpu\/|examples\/(host|engine|embed_3)|app\/viewer\/)/ && code ~ /(^|[^A-Za-z0-9_])vk[A-Z]/)
        complain("a Vulkan function outside src/gpu")
    if (FILENAME !~ /^(src\/trace\/|bench\/rays\.c)/ && code ~ /(^|[^A-Za-z0-9_])rtc[A-Z]/)
        complain("an Embree function outside src/trace")
}

# The table.
NR == FNR {
    if ($0 ~ /^[ \t]*(#|$)/) next
    may = ""
    for (i = 2; i <= NF; i++) may = may " " $i
    if ($1 == "*") {
        common = common may
    } else {
        rows++
        file_of[rows] = $1
        may_of[rows] = may
    }
    next
}

FNR == 1 {
    in_comment = 0
    folder = FILENAME
    sub(/\/[^\/]*$/, "", folder)
    row = row_of(FILENAME)
    if (!row) complain("no row of the include table fits " FILENAME)
    files++
}

row && !in_comment && /^[ \t]*#[ \t]*include[ \t]*["<]/ { check_include($0); next }

{ check_identifiers(code_of($0)) }

END {
    if (!files) { print "no file was checked"; bad = 1 }
    exit bad
}
