// SPDX-License-Identifier: GPL-2.0-or-later
// The inside of a YamlDocument, shared by yaml_tree.c (access, errors) and yaml_parse.c (bytes and
// libfyaml); nobody else includes it.
#ifndef AMONTONS_IO_TEXT_YAML_TREE_H
#define AMONTONS_IO_TEXT_YAML_TREE_H

#include "io/text/yaml_document.h"

#include <stdbool.h>

typedef struct YamlItem {
    YamlKind kind;
    bool quoted;
    int32_t position;   // byte in the text where the value starts
    char *text;   // of a scalar; owned
    char *stand_in;   // yaml_stand_in; NULL: none; owned
    YamlNode key;   // the key's scalar node; YAML_NO_NODE: not a map's child
    int32_t count;   // children
    YamlNode first, last;   // children
    YamlNode next;   // sibling
} YamlItem;

struct YamlDocument {
    char *name;   // for errors; owned
    char *shown;   // the text as typed; owned
    int32_t size;   // of it, bytes
    YamlItem *nodes;   // [node_count] of node_capacity; owned
    int32_t node_count, node_capacity;
};

// Where a byte of the text stands.
typedef struct YamlPlace {
    int32_t line, column;   // from 1; column in characters
    int32_t line_start, line_end;   // bytes
} YamlPlace;

YamlPlace yaml_place(const YamlDocument *document, int32_t position);

// As yaml_error, at a byte of the text.
bool yaml_error_at(const YamlDocument *document, int32_t position, Error *err, const char *message);

#endif
