// SPDX-License-Identifier: GPL-2.0-or-later
// Grows the tree of a YamlDocument from what comes in: scalars, starts and ends of lists and maps.
//
// The builder keeps a stack of what is open and, for each open map, the key that waits for its
// value. Limits (nodes, depth) are far above any scene's and keep a hostile file from taking all
// memory.
#include "io/yaml_tree.h"

#include "base/memory.h"

#include <stdio.h>
#include <string.h>

// Indices, not pointers, name nodes: the array moves as it grows.
bool yaml_add_node(YamlDocument *document, YamlKind kind, int32_t position, int32_t *index,
                   Error *err)
{
    if (document->node_count == YAML_NODES_MAX) {
        yaml_error_at(document, position, err, "more than 20000 values: this is no scene");
        goto cleanup;
    }
    YamlItem *nodes = memory_grow(document->nodes, document->node_count, &document->node_capacity,
                                  sizeof(YamlItem), err);
    TRY(nodes);
    document->nodes = nodes;
    *index = document->node_count++;
    document->nodes[*index] = (YamlItem){.kind = kind,
                                         .position = position,
                                         .key = YAML_NO_NODE,
                                         .first = YAML_NO_NODE,
                                         .last = YAML_NO_NODE,
                                         .next = YAML_NO_NODE};
cleanup:
    return error_is_clean(err);
}

// All scalars stand in one buffer, zero-terminated, and are named by their offsets.
// *offset: where it stands in document->texts, whose address may change with the next call.
static bool add_text(YamlDocument *document, const char *text, size_t length, int32_t *offset,
                     Error *err)
{
    int32_t needed = document->text_size + (int32_t)length + 1;
    if (needed > document->text_capacity) {
        int32_t capacity = 2 * needed + 256;
        char *longer = memory_resize(document->texts, document->text_capacity, capacity, 1, err);
        TRY(longer);
        document->texts = longer;
        document->text_capacity = capacity;
    }
    *offset = document->text_size;
    memcpy(document->texts + document->text_size, text, length);
    document->texts[needed - 1] = 0;
    document->text_size = needed;
cleanup:
    return error_is_clean(err);
}

// YAML leaves open what a key twice means; here it is an error with both places.
static bool check_key_is_new(const YamlDocument *document, int32_t map, int32_t key, Error *err)
{
    const char *word = yaml_text(document, key);
    for (int32_t i = document->nodes[map].first; i != YAML_NO_NODE; i = document->nodes[i].next) {
        if (strcmp(yaml_key(document, i), word) != 0) continue;
        char message[200];
        YamlPlace first = yaml_place(document, document->nodes[document->nodes[i].key].position);
        snprintf(message, sizeof message, "the key `%.60s` stands twice (first in line %d)", word,
                 first.line);
        yaml_error_at(document, document->nodes[key].position, err, message);
        return false;
    }
    return true;
}

// A finished key waits in the builder; everything else becomes a child of the innermost open node.
static bool place_node(YamlBuilder *builder, int32_t index, bool *is_key, Error *err)
{
    YamlDocument *document = builder->document;
    *is_key = false;
    if (builder->depth == 0) goto cleanup;
    int32_t *waiting = &builder->key[builder->depth - 1];
    int32_t parent = builder->open[builder->depth - 1];
    YamlItem *node = &document->nodes[index], *above = &document->nodes[parent];
    if (above->kind == YAML_MAP && *waiting == YAML_NO_NODE) {
        if (node->kind != YAML_SCALAR) {
            yaml_error_at(document, node->position, err, "a key must be a plain word");
            goto cleanup;
        }
        TRY(check_key_is_new(document, parent, index, err));
        *waiting = index;
        *is_key = true;
        goto cleanup;
    }
    node->key = *waiting;
    *waiting = YAML_NO_NODE;
    if (above->last == YAML_NO_NODE)
        above->first = index;
    else
        document->nodes[above->last].next = index;
    above->last = index;
    above->count++;
cleanup:
    return error_is_clean(err);
}

// As YAML 1.2's core schema has it, without its `Null` and `NULL`.
static bool is_null(const char *text, size_t length)
{
    return length == 0 || (length == 1 && text[0] == '~') ||
           (length == 4 && memcmp(text, "null", 4) == 0);
}

// Where the event has no mark of its own, an empty value for instance: the key it belongs to, or
// else the list or map it is in.
int32_t yaml_build_position(const YamlBuilder *builder)
{
    if (builder->depth == 0) return 0;
    int32_t key = builder->key[builder->depth - 1];
    int32_t node = key == YAML_NO_NODE ? builder->open[builder->depth - 1] : key;
    return builder->document->nodes[node].position;
}

// position: byte in the text; below 0: not known.
bool yaml_build_scalar(YamlBuilder *builder, const char *text, size_t length, bool quoted,
                       int32_t position, Error *err)
{
    YamlDocument *document = builder->document;
    int32_t index = 0, offset = 0;
    bool nothing = !quoted && is_null(text, length), is_key = false;
    if (position < 0) position = yaml_build_position(builder);
    TRY(yaml_add_node(document, nothing ? YAML_NOTHING : YAML_SCALAR, position, &index, err));
    TRY(add_text(document, text, length, &offset, err));
    document->nodes[index].quoted = quoted;
    document->nodes[index].text = offset;
    TRY(place_node(builder, index, &is_key, err));
cleanup:
    return error_is_clean(err);
}

// The new list or map takes what follows, until yaml_build_close.
bool yaml_build_open(YamlBuilder *builder, YamlKind kind, int32_t position, Error *err)
{
    YamlDocument *document = builder->document;
    int32_t index = 0;
    if (position < 0) position = yaml_build_position(builder);
    if (builder->depth == YAML_DEPTH_MAX) {
        yaml_error_at(document, position, err, "more than 16 levels of lists and maps");
        goto cleanup;
    }
    TRY(yaml_add_node(document, kind, position, &index, err));
    bool is_key = false;
    TRY(place_node(builder, index, &is_key, err));
    builder->open[builder->depth] = index;
    builder->key[builder->depth++] = YAML_NO_NODE;
cleanup:
    return error_is_clean(err);
}

// Events come in pairs: libfyaml reports an end without a beginning before it gets here.
void yaml_build_close(YamlBuilder *builder)
{
    builder->depth--;
}
