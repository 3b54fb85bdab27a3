// Variables that an entry point uses: those that pointers of instructions name, in the functions
// that it calls.
#include "gpu/pipelines/spirv.h"

enum { USED = 1, WALKED = 2 };
enum {
    OP_FUNCTION_CALL = 57,
    OP_IMAGE_TEXEL_POINTER = 60,
    OP_LOAD = 61,
    OP_STORE = 62,
    OP_COPY_MEMORY = 63,
    OP_ACCESS_CHAIN = 65,
    OP_PTR_ACCESS_CHAIN = 67,
    OP_ARRAY_LENGTH = 68,
    OP_COPY_OBJECT = 83,
    OP_SELECT = 169,
    OP_ATOMIC_LOAD = 227,
    OP_ATOMIC_STORE = 228,
    OP_ATOMIC_XOR = 242,
    OP_PHI = 245,
    OP_ATOMIC_FMIN = 5614,
    OP_ATOMIC_FMAX = 5615,
    OP_ATOMIC_FADD = 6035,
};

static void use(struct spirv *m, size_t at, uint32_t index)
{
    const uint32_t id = spirv_operand(m, at, index);
    if (id && id < m->bound) m->used[id] |= USED;
}

static void use_from(struct spirv *m, size_t at, uint32_t first)
{
    const uint32_t end = (uint32_t)(spirv_next(m, at) - at);
    for (uint32_t i = first; i < end; i++) use(m, at, i);
}

// Pointers among the operands; more ids do no harm, if they are no literals.
static void use_operands(struct spirv *m, size_t at)
{
    const uint32_t op = spirv_op_at(m, at);
    const bool reads = (op >= OP_ATOMIC_LOAD && op <= OP_ATOMIC_XOR) || op == OP_ATOMIC_FMIN ||
                       op == OP_ATOMIC_FMAX || op == OP_ATOMIC_FADD || op == OP_LOAD ||
                       op == OP_IMAGE_TEXEL_POINTER || op == OP_ARRAY_LENGTH ||
                       op == OP_COPY_OBJECT || (op >= OP_ACCESS_CHAIN && op <= OP_PTR_ACCESS_CHAIN);
    if (op == OP_STORE || op == OP_ATOMIC_STORE || op == OP_COPY_MEMORY) use(m, at, 1);
    if (op == OP_COPY_MEMORY) use(m, at, 2);
    if (reads && op != OP_ATOMIC_STORE) use(m, at, 3);
    if (op == OP_FUNCTION_CALL || op == OP_SELECT || op == OP_PHI) use_from(m, at, 3);
}

// Walks the functions that are known to be called. False: all have been walked before.
static bool walk(struct spirv *m)
{
    bool found = false, inside = false;
    for (size_t at = m->functions; at < m->count; at = spirv_next(m, at)) {
        const uint32_t op = spirv_op_at(m, at), id = spirv_operand(m, at, 2);
        if (op == SPIRV_FUNCTION) {
            inside = id < m->bound && m->used[id] == USED;
            found |= inside;
            if (inside) m->used[id] |= WALKED;
        }
        if (inside) use_operands(m, at);
        inside &= op != SPIRV_FUNCTION_END;
    }
    return found;
}

void spirv_mark_used(struct spirv *m, uint32_t function)
{
    if (function >= m->bound) return;
    m->used[function] |= USED;
    while (walk(m)) {}
}

bool spirv_used(const struct spirv *m, uint32_t id)
{
    return id < m->bound && m->used[id];
}
