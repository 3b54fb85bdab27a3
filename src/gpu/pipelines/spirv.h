// A reader of SPIR-V modules, for reflection: instructions by their result, decorations, names, and
// the variables that an entry point uses (SPIR-V specification, sections 2 and 3). Words are
// untrusted: reflect.c checks the lengths of instructions, ids are checked here, and what is
// missing reads as 0.
#pragma once

#include "core/host.h"

#include <stddef.h>
#include <stdint.h>

// Numbers of the specification that reflection needs.
enum spirv_op {
    SPIRV_ENTRY_POINT = 15,
    SPIRV_TYPE_BOOL = 20,
    SPIRV_TYPE_INT = 21,
    SPIRV_TYPE_FLOAT = 22,
    SPIRV_TYPE_VECTOR = 23,
    SPIRV_TYPE_MATRIX = 24,
    SPIRV_TYPE_IMAGE = 25,
    SPIRV_TYPE_SAMPLER = 26,
    SPIRV_TYPE_SAMPLED_IMAGE = 27,
    SPIRV_TYPE_ARRAY = 28,
    SPIRV_TYPE_RUNTIME_ARRAY = 29,
    SPIRV_TYPE_STRUCT = 30,
    SPIRV_TYPE_POINTER = 32,
    SPIRV_CONSTANT = 43,
    SPIRV_SPEC_CONSTANT_TRUE = 48,
    SPIRV_SPEC_CONSTANT_FALSE = 49,
    SPIRV_SPEC_CONSTANT = 50,
    SPIRV_FUNCTION = 54,
    SPIRV_FUNCTION_END = 56,
    SPIRV_VARIABLE = 59,
};
enum spirv_decoration {
    SPIRV_SPEC_ID = 1,
    SPIRV_BUFFER_BLOCK = 3,
    SPIRV_ROW_MAJOR = 4,
    SPIRV_ARRAY_STRIDE = 6,
    SPIRV_MATRIX_STRIDE = 7,
    SPIRV_NON_WRITABLE = 24,
    SPIRV_BINDING = 33,
    SPIRV_DESCRIPTOR_SET = 34,
    SPIRV_OFFSET = 35,
};
enum spirv_class {
    SPIRV_UNIFORM_CONSTANT = 0,
    SPIRV_UNIFORM = 2,
    SPIRV_PUSH_CONSTANT = 9,
    SPIRV_STORAGE_BUFFER = 12,
};
enum { SPIRV_WHOLE = -1 }; // not of a member

struct spirv {
    const uint32_t *words;
    size_t count, annotations, types, functions; // first word of each section
    uint32_t bound;
    uint32_t *at;      // of each id: the word of the instruction that defines it; 0: none
    uint32_t *name_at; // likewise its OpName
    uint8_t *used;     // of each id: whether the entry point reaches it, see spirv_used.c
    struct host *host;
};

// For words whose header and instruction lengths have been checked. NULL, or why it failed; "": out
// of memory, which the host was told. Close in any case.
const char *spirv_open(struct spirv *module, struct host *host, const uint32_t *words,
                       size_t count);
void spirv_close(struct spirv *module);

// The instruction at a word below `count`: its opcode, and operands counted from the first word.
// Operands past the end are 0, and so is all of the instruction 0, which is none.
uint32_t spirv_op_at(const struct spirv *module, size_t at);
uint32_t spirv_operand(const struct spirv *module, size_t at, uint32_t index);
size_t spirv_next(const struct spirv *module, size_t at);
// The instruction that defines an id; 0: none.
size_t spirv_find(const struct spirv *module, uint32_t id);

// spirv_used.c. Marks the variables that instructions of a function, or of those that it calls,
// access; then whether an id is one of them.
void spirv_mark_used(struct spirv *module, uint32_t function);
bool spirv_used(const struct spirv *module, uint32_t id);

// The name of an id, "" without one. The string is in the words.
const char *spirv_name(const struct spirv *module, uint32_t id);
// `value` (may be NULL) is the decoration's first literal, 0 without one.
bool spirv_decoration(const struct spirv *module, uint32_t id, int member,
                      enum spirv_decoration decoration, uint32_t *value);
// Bytes of a type as laid out by its decorations; 0: unknown.
size_t spirv_type_size(const struct spirv *module, uint32_t type);
