# shared_structs.awk [-v glsl=1] HEADER…: what the *_shared.h headers declare, as tables for test_shared_layout.c: every struct
# with its size, every member with its offset and size. Unknown syntax fails to compile there. With glsl=1 a shader with an
# array of each struct in a storage block, for structs that no other shader has.
function note(text) { members = members text }

FNR == 1 { # paths as the sources write them
    path = FILENAME
    sub(/^.*\/src\//, "", path)
    includes = includes sprintf("#include \"%s\"\n", path)
}

{ sub(/\/\/.*/, "") }

/^struct [a-z0-9_]+ \{/ {
    name = $2
    members = ""
    next
}

name != "" && /^\};/ {
    tables = tables sprintf("static const struct member %s_members[] = {\n%s};\n", name, members)
    blocks = blocks sprintf("layout(set = 0, binding = %d, scalar) readonly buffer block_%d { %s table_%d[]; };\n", \
        count_blocks, count_blocks, name, count_blocks)
    count_blocks++
    list = list sprintf("    { \"%s\", sizeof(struct %s), %s_members, sizeof %s_members / sizeof *%s_members },\n", \
        name, name, name, name, name)
    name = ""
    next
}

name != "" { # vec3s map_u[4], map_v[4];
    sub(/^ *(AG_STRUCT\([a-z0-9_]+\)|[a-z0-9_]+) +/, "")
    count = split($0, parts, /[,;]/)
    for (i = 1; i <= count; i++) {
        member = parts[i]
        sub(/\[.*/, "", member)
        gsub(/ /, "", member)
        if (member != "")
            note(sprintf("    { \"%s\", offsetof(struct %s, %s), sizeof(((struct %s *)0)->%s) },\n", member, name, member, \
                name, member))
    }
}

END {
    if (glsl) {
        print "#version 460"
        print "#extension GL_GOOGLE_include_directive : require"
        print "#extension GL_EXT_scalar_block_layout : require"
        printf "%s\n%s\nlayout(local_size_x = 8) in;\nvoid main() {}\n", includes, blocks
        exit
    }
    printf "%s\n%s\nstatic const struct shared shared_structs[] = {\n%s};\n", includes, tables, list
}
