# Lists the binary interface of the public headers: rows for abi_list.c.
#   STRUCT(name)  MEMBER(struct, member, "declaration")  VALUE(constant)  FUNCTION("declaration")
# Words of `reserved` are no rows: new members take them. Names of parameters are left out.

{
    sub(/\/\/.*/, "")
    if ($0 !~ /^[ \t]*#/ && $0 !~ /\\$/ && !continued) text = text " " $0
    continued = $0 ~ /\\$/
}

function trim(s)
{
    gsub(/[ \t]+/, " ", s)
    sub(/^ /, "", s)
    sub(/ $/, "", s)
    return s
}

# "int width" without its name: "int"; pointers to functions and unnamed ones stay.
function without_name(s,  array)
{
    s = trim(s)
    if (s ~ /\(/ || s == "void") return s
    array = ""
    if (match(s, /(\[[^]]*\])+$/)) {
        array = substr(s, RSTART)
        s = substr(s, 1, RSTART - 1)
    }
    sub(/[A-Za-z_0-9]+$/, "", s)
    return trim(s) array
}

# Parameters are separated by commas outside of parentheses.
function parameters(s,  i, c, depth, one, out)
{
    out = one = ""
    depth = 0
    for (i = 1; i <= length(s) + 1; i++) {
        c = i <= length(s) ? substr(s, i, 1) : ","
        if (c == "(") depth++
        if (c == ")") depth--
        if (c == "," && depth == 0) {
            out = out (out == "" ? "" : ", ") without_name(one)
            one = ""
        } else one = one c
    }
    return out
}

function print_function(s,  open)
{
    s = trim(s)
    sub(/^AG_DEPRECATED /, "", s)
    open = index(s, "(")
    printf "FUNCTION(\"%s(%s)\")\n", substr(s, 1, open - 1), parameters(substr(s, open + 1, length(s) - open - 1))
}

# The base type is all before the name and stars of the first declarator.
function print_members(of, s,  base, count, parts, i, name, type)
{
    s = trim(s)
    if (s == "") return
    if (s ~ /\(/) {
        match(s, /\(\*[A-Za-z_0-9]+\)/)
        printf "MEMBER(%s, %s, \"%s\")\n", of, substr(s, RSTART + 2, RLENGTH - 3), s
        return
    }
    count = split(s, parts, ",")
    base = without_name(parts[1])
    sub(/\[.*/, "", base)
    sub(/[ *]+$/, "", base)
    for (i = 1; i <= count; i++) {
        type = trim(i == 1 ? parts[i] : base " " parts[i])
        name = type
        sub(/\[.*/, "", name)
        sub(/.*[ *]/, "", name)
        if (name != "reserved") printf "MEMBER(%s, %s, \"%s\")\n", of, name, type
    }
}

function print_struct(name, body,  count, parts, i)
{
    printf "STRUCT(%s)\n", name
    count = split(body, parts, ";")
    for (i = 1; i <= count; i++) print_members(name, parts[i])
}

function print_enum(body,  count, parts, i)
{
    count = split(body, parts, ",")
    for (i = 1; i <= count; i++) {
        sub(/=.*/, "", parts[i])
        if (trim(parts[i]) != "") printf "VALUE(%s)\n", trim(parts[i])
    }
}

END {
    while (match(text, /(struct|enum) ag_[a-z_0-9]+ \{[^}]*\};|AG_API [^;]*;/)) {
        found = substr(text, RSTART, RLENGTH - 1)
        text = substr(text, RSTART + RLENGTH)
        if (found ~ /^AG_API /) {
            print_function(substr(found, 8))
            continue
        }
        open = index(found, "{")
        body = substr(found, open + 1, length(found) - open - 1)
        split(found, words, " ")
        if (words[1] == "enum") print_enum(body)
        else print_struct(words[2], body)
    }
}
