// SPIR-V modules: sections, ids, names and decorations.
#include "gpu/pipelines/spirv.h"

#include <string.h>

enum { HEADER = 5, MOST_IDS = 4194303 }; // limits of the specification, section 2.17
enum {
    OP_NAME = 5,
    OP_TYPE_VOID = 19,
    OP_TYPE_FORWARD_POINTER = 39,
    OP_DECORATE = 71,
    OP_MEMBER_DECORATE = 72,
    OP_GROUP_DECORATE = 74,
};

uint32_t spirv_op_at(const struct spirv *m, size_t at)
{
    return at ? m->words[at] & 0xffff : 0;
}

static uint32_t length_at(const struct spirv *m, size_t at)
{
    return m->words[at] >> 16;
}

uint32_t spirv_operand(const struct spirv *m, size_t at, uint32_t index)
{
    return at && index < length_at(m, at) ? m->words[at + index] : 0;
}

size_t spirv_next(const struct spirv *m, size_t at)
{
    return at + length_at(m, at);
}

size_t spirv_find(const struct spirv *m, uint32_t id)
{
    return id < m->bound ? m->at[id] : 0;
}

// ---- ids

// The operand with the result of an instruction, for those whose results are looked up; 0: none.
static uint32_t result_index(uint32_t op)
{
    if (op == OP_TYPE_FORWARD_POINTER) return 0;
    if (op >= OP_TYPE_VOID && op <= SPIRV_TYPE_POINTER) return 1;
    if (op > SPIRV_TYPE_POINTER && op <= SPIRV_FUNCTION) return 2; // constants too
    return op == SPIRV_VARIABLE ? 2 : 0;
}

static bool note_id(struct spirv *m, uint32_t *table, uint32_t id, size_t at)
{
    if (id == 0 || id >= m->bound) return false;
    if (!table[id]) table[id] = (uint32_t)at;
    return true;
}

static bool is_annotation(uint32_t op)
{
    return op >= OP_DECORATE && op <= OP_GROUP_DECORATE;
}

// One pass over all instructions. Sections come in a fixed order (specification, section 2.4).
static bool note_ids(struct spirv *m)
{
    bool ok = true;
    for (size_t at = HEADER; ok && at < m->count; at = spirv_next(m, at)) {
        const uint32_t op = spirv_op_at(m, at), index = result_index(op);
        if (op == OP_NAME) ok = note_id(m, m->name_at, spirv_operand(m, at, 1), at);
        if (index) ok = note_id(m, m->at, spirv_operand(m, at, index), at);
        if (!m->annotations && is_annotation(op)) m->annotations = at;
        if (!m->types && op >= OP_TYPE_VOID && op <= SPIRV_VARIABLE) m->types = at;
        if (!m->functions && op == SPIRV_FUNCTION) m->functions = at;
    }
    if (!m->types) m->types = m->count;
    if (!m->functions) m->functions = m->count;
    if (!m->annotations || m->annotations > m->types) m->annotations = m->types;
    return ok;
}

const char *spirv_name(const struct spirv *m, uint32_t id)
{
    const size_t at = id < m->bound ? m->name_at[id] : 0;
    if (!at || length_at(m, at) < 3) return "";
    const char *name = (const char *)(m->words + at + 2);
    const size_t bytes = 4 * ((size_t)length_at(m, at) - 2);
    return memchr(name, 0, bytes) ? name : "";
}

bool spirv_decoration(const struct spirv *m, uint32_t id, int member, enum spirv_decoration what,
                      uint32_t *value)
{
    const bool whole = member == SPIRV_WHOLE;
    const uint32_t op = whole ? OP_DECORATE : OP_MEMBER_DECORATE, next = whole ? 2 : 3;
    if (value) *value = 0;
    for (size_t at = m->annotations; at < m->types; at = spirv_next(m, at)) {
        if (spirv_op_at(m, at) != op || spirv_operand(m, at, 1) != id) continue;
        if (!whole && spirv_operand(m, at, 2) != (uint32_t)member) continue;
        if (next >= length_at(m, at) || spirv_operand(m, at, next) != (uint32_t)what) continue;
        if (value) *value = spirv_operand(m, at, next + 1);
        return true;
    }
    return false;
}

// ---- sizes of types

enum { DEEPEST = 16 };

static size_t size_of(const struct spirv *m, uint32_t type, int depth);

static size_t array_size(const struct spirv *m, size_t at, uint32_t type)
{
    uint32_t stride;
    const size_t length = spirv_find(m, spirv_operand(m, at, 3));
    spirv_decoration(m, type, SPIRV_WHOLE, SPIRV_ARRAY_STRIDE, &stride);
    return length ? (size_t)stride * spirv_operand(m, length, 3) : 0;
}

// A matrix is an array of its columns, or of its rows, with a stride.
static size_t matrix_size(const struct spirv *m, size_t at, uint32_t of, int member)
{
    uint32_t stride;
    const size_t column = spirv_find(m, spirv_operand(m, at, 2));
    spirv_decoration(m, of, member, SPIRV_MATRIX_STRIDE, &stride);
    if (spirv_decoration(m, of, member, SPIRV_ROW_MAJOR, NULL))
        return column ? (size_t)stride * spirv_operand(m, column, 3) : 0;
    return (size_t)stride * spirv_operand(m, at, 3);
}

static size_t member_size(const struct spirv *m, uint32_t of, int member, uint32_t type, int depth)
{
    const size_t at = spirv_find(m, type);
    if (spirv_op_at(m, at) == SPIRV_TYPE_MATRIX) return matrix_size(m, at, of, member);
    return size_of(m, type, depth);
}

// To the end of the member with the highest offset.
static size_t struct_size(const struct spirv *m, size_t at, uint32_t type, int depth)
{
    uint32_t highest = 0;
    int last = 0;
    const int members = (int)length_at(m, at) - 2;
    for (int i = 0; i < members; i++) {
        uint32_t offset;
        spirv_decoration(m, type, i, SPIRV_OFFSET, &offset);
        if (offset < highest) continue;
        highest = offset;
        last = i;
    }
    if (members < 1) return 0;
    return highest + member_size(m, type, last, spirv_operand(m, at, 2 + (uint32_t)last), depth);
}

static size_t size_of(const struct spirv *m, uint32_t type, int depth)
{
    const size_t at = spirv_find(m, type);
    if (depth == DEEPEST) return 0;
    switch (spirv_op_at(m, at)) {
    case SPIRV_TYPE_INT:
    case SPIRV_TYPE_FLOAT:
        return spirv_operand(m, at, 2) / 8;
    case SPIRV_TYPE_VECTOR:
        return size_of(m, spirv_operand(m, at, 2), depth + 1) * spirv_operand(m, at, 3);
    case SPIRV_TYPE_ARRAY:
        return array_size(m, at, type);
    case SPIRV_TYPE_STRUCT:
        return struct_size(m, at, type, depth + 1);
    default:
        return 0;
    }
}

size_t spirv_type_size(const struct spirv *m, uint32_t type)
{
    return size_of(m, type, 0);
}

// ---- opening

const char *spirv_open(struct spirv *m, struct host *host, const uint32_t *words, size_t count)
{
    *m = (struct spirv){ .words = words, .count = count, .bound = words[3], .host = host };
    if (m->bound > MOST_IDS || count > UINT32_MAX) return "it has too many ids";
    m->at = host_alloc(host, m->bound, sizeof *m->at);
    m->name_at = host_alloc(host, m->bound, sizeof *m->name_at);
    m->used = host_alloc(host, m->bound, sizeof *m->used);
    if (!m->at || !m->name_at || !m->used) return "";
    return note_ids(m) ? NULL : "an id is beyond their bound";
}

void spirv_close(struct spirv *m)
{
    host_free(m->host, m->at);
    host_free(m->host, m->name_at);
    host_free(m->host, m->used);
}
