# Prints each strongly connected component of more than one node of a graph given as lines "from to label", with the
# edges that make it, and exits with 1 when there is any. POSIX awk.

{
    if ($1 == $2) next
    if (!(($1, $2) in labels)) {
        targets[$1] = targets[$1] " " $2
        labels[$1, $2] = $3
        needed_by[$2]++
        needed_by[$1] += 0
        nodes[$1]
        nodes[$2]
        pairs++
    } else {
        labels[$1, $2] = labels[$1, $2] ", " $3
    }
}

# Removes the nodes that no other needs, and then those that only they needed: none is in a cycle.
function remove_unneeded(    i, k, n, m, queue, next_nodes)
{
    for (i in nodes)
        if (needed_by[i] == 0) queue[++n] = i
    for (i = 1; i <= n; i++) {
        m = split(targets[queue[i]], next_nodes, " ")
        for (k = 1; k <= m; k++)
            if (--needed_by[next_nodes[k]] == 0) queue[++n] = next_nodes[k]
        delete nodes[queue[i]]
    }
}

# Marks all nodes that a path from `node` leads to as reached from `start`.
function visit(start, node,    i, n, next_nodes)
{
    n = split(targets[node], next_nodes, " ")
    for (i = 1; i <= n; i++) {
        if ((start, next_nodes[i]) in reached) continue
        reached[start, next_nodes[i]]
        visit(start, next_nodes[i])
    }
}

function print_component(node,    i, k, n, m, members, others, list)
{
    for (i = 1; i <= count; i++)
        if ((node, sorted[i]) in reached && (sorted[i], node) in reached) {
            members[++n] = sorted[i]
            done[sorted[i]]
            list = list " " sorted[i]
        }
    print "cycle of " n " files:" list
    for (i = 1; i <= n; i++) {
        m = split(targets[members[i]], others, " ")
        for (k = 1; k <= m; k++)
            if ((others[k], members[i]) in reached)
                print "    " members[i] " -> " others[k] ": " labels[members[i], others[k]]
    }
    cycles++
}

END {
    if (!pairs) { print "no dependencies were found"; exit 1 }
    remove_unneeded()
    for (node in nodes) { # sorted by insertion, so that the output is the same on every system
        for (i = ++count; i > 1 && sorted[i - 1] > node; i--) sorted[i] = sorted[i - 1]
        sorted[i] = node
    }
    for (i = 1; i <= count; i++) visit(sorted[i], sorted[i])
    for (i = 1; i <= count; i++)
        if ((sorted[i], sorted[i]) in reached && !(sorted[i] in done)) print_component(sorted[i])
    exit cycles > 0
}
