// SPDX-License-Identifier: GPL-2.0-or-later
// The inside of a YamlDocument, shared by yaml_tree.c (access, errors), yaml_build.c (nodes)
// and yaml_parse.c (bytes and libfyaml); nobody else includes it.
#ifndef AMONTONS_IO_YAML_TREE_H
#define AMONTONS_IO_YAML_TREE_H

#include "io/yaml_document.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct YamlItem {
    YamlKind kind;
    bool quoted;
    int32_t position;   // byte in the text where the value starts
    int32_t key;   // the key's scalar node; YAML_NO_NODE: not a map's child
    int32_t text;   // offset into texts; scalars only
    int32_t count;   // children
    int32_t first, last;   // children
    int32_t next;   // sibling
} YamlItem;

struct YamlDocument {
    char *name;   // for errors; owned
    char *shown;   // the text as typed, for errors; owned
    char *read;   // the same with the skipped part blanked; owned
    int32_t size;   // of both, bytes
    YamlItem *nodes;   // [node_count] of node_capacity; owned
    int32_t node_count, node_capacity;
    char *texts;   // zero-terminated scalars one behind the other; owned
    int32_t text_size, text_capacity;
};

// The lists and maps that are open while events come in, outermost first.
typedef struct YamlBuilder {
    YamlDocument *document;
    int32_t open[YAML_DEPTH_MAX];
    int32_t depth;
    int32_t key[YAML_DEPTH_MAX];   // a map's key that waits for its value
    int32_t documents;
} YamlBuilder;

// Where a byte of the text stands.
typedef struct YamlPlace {
    int32_t line, column;   // from 1; column in characters
    int32_t line_start, line_end;   // bytes
} YamlPlace;

YamlPlace yaml_place(const YamlDocument *document, int32_t position);

// As yaml_error, at a byte of the text.
void yaml_error_at(const YamlDocument *document, int32_t position, Error *err, const char *message);

bool yaml_add_node(YamlDocument *document, YamlKind kind, int32_t position, int32_t *index,
                   Error *err);

// What the text's events build. `position` -1: not written in the text (an empty value).
bool yaml_build_scalar(YamlBuilder *builder, const char *text, size_t length, bool quoted,
                       int32_t position, Error *err);
bool yaml_build_open(YamlBuilder *builder, YamlKind kind, int32_t position, Error *err);
void yaml_build_close(YamlBuilder *builder);
int32_t yaml_build_position(const YamlBuilder *builder);   // of a value that is not written

#endif
