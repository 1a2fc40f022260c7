// SPDX-License-Identifier: GPL-2.0-or-later
// A tree in one array: nodes, linked by first child and next sibling. Positions are bytes; lines
// and columns are counted only when an error wants them.
#include "io/text/yaml_tree.h"

#include "base/memory.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// --- access -------------------------------------------------------------------------------------

// Nodes are indices, valid as long as the document.
YamlKind yaml_kind(const YamlDocument *document, YamlNode node)
{
    return document->nodes[node].kind;
}

// Owned by the document; "" where the node is no scalar, so that it can be compared in any case.
const char *yaml_text(const YamlDocument *document, YamlNode node)
{
    const YamlItem *item = &document->nodes[node];
    if (item->kind != YAML_SCALAR) return "";
    return item->stand_in ? item->stand_in : item->text;
}

bool yaml_stand_in(const YamlDocument *document, YamlNode node, const char *text, Error *err)
{
    YamlItem *item = &document->nodes[node];
    memory_free(item->stand_in);
    item->stand_in = text ? memory_text(text, err) : NULL;
    return !text || item->stand_in;
}

bool yaml_is_quoted(const YamlDocument *document, YamlNode node)
{
    return document->nodes[node].quoted;
}

int32_t yaml_count(const YamlDocument *document, YamlNode node)
{
    return document->nodes[node].count;
}

int32_t yaml_line(const YamlDocument *document, YamlNode node)
{
    return yaml_place(document, document->nodes[node].position).line;
}

int32_t yaml_column(const YamlDocument *document, YamlNode node)
{
    return yaml_place(document, document->nodes[node].position).column;
}

YamlNode yaml_first(const YamlDocument *document, YamlNode node)
{
    return document->nodes[node].first;
}

YamlNode yaml_next(const YamlDocument *document, YamlNode node)
{
    return document->nodes[node].next;
}

const char *yaml_key(const YamlDocument *document, YamlNode node)
{
    int32_t key = document->nodes[node].key;
    return key == YAML_NO_NODE ? "" : yaml_text(document, key);
}

// One level of `path` a round; a name with a dot in it cannot be looked up.
YamlNode yaml_look_up(const YamlDocument *document, const char *path)
{
    YamlNode node = YAML_ROOT;
    while (node != YAML_NO_NODE && *path) {
        size_t length = strcspn(path, ".");
        YamlNode child = yaml_first(document, node);
        for (; child != YAML_NO_NODE; child = yaml_next(document, child)) {
            const char *key = yaml_key(document, child);
            if (strlen(key) == length && strncmp(key, path, length) == 0) break;
        }
        node = child;
        path += length + (path[length] == '.');
    }
    return node;
}

// --- errors that show the place -----------------------------------------------------------------

enum { SHOWN_WIDTH = 88 };   // of a source line in an error, characters

static bool starts_character(char byte)
{
    return ((unsigned char)byte & 0xC0) != 0x80;
}

// Columns count characters, not bytes: continuation bytes of UTF-8 (10xxxxxx) are passed over.
YamlPlace yaml_place(const YamlDocument *document, int32_t position)
{
    YamlPlace place = {.line = 1, .column = 1};
    const char *text = document->shown;
    if (position > document->size) position = document->size;
    for (int32_t i = 0; i < position; i++)
        if (text[i] == '\n') {
            place.line++;
            place.line_start = i + 1;
        }
    for (int32_t i = place.line_start; i < position; i++)
        if (starts_character(text[i])) place.column++;
    place.line_end = place.line_start;
    while (place.line_end < document->size && text[place.line_end] != '\n') place.line_end++;
    if (place.line_end > place.line_start && text[place.line_end - 1] == '\r') place.line_end--;
    return place;
}

// "   7 | material: {young: 1" and a caret below; of a long line the part around the column.
static void write_excerpt(const YamlDocument *document, const YamlPlace *place, char *out,
                          int32_t size)
{
    int32_t first = place->column > SHOWN_WIDTH - 8 ? place->column - SHOWN_WIDTH / 2 : 1;
    char line[4 * SHOWN_WIDTH + 1] = {0};
    int32_t used = 0, column = 0;
    for (int32_t i = place->line_start; i < place->line_end; i++) {
        char byte = document->shown[i];
        if (starts_character(byte)) column++;
        if (column < first) continue;
        if (column >= first + SHOWN_WIDTH || used == 4 * SHOWN_WIDTH) break;
        line[used++] = (unsigned char)byte < ' ' ? ' ' : byte;
    }
    snprintf(out, (size_t)size, "\n%5d | %s\n      | %*s^", place->line, line,
             place->column - first, "");
}

bool yaml_error_at(const YamlDocument *document, int32_t position, Error *err, const char *message)
{
    char excerpt[6 * SHOWN_WIDTH];
    YamlPlace place = yaml_place(document, position);
    write_excerpt(document, &place, excerpt, sizeof excerpt);
    error_set(err, ERROR_INPUT, __FILE__, __LINE__, "%s:%d:%d: %s%s", document->name, place.line,
              place.column, message, excerpt);
    return false;
}

// The error's own file and line are this file's: the place in the user's text is in the message.
bool yaml_error(const YamlDocument *document, YamlNode node, Error *err, const char *format, ...)
{
    char message[ERROR_MESSAGE_SIZE / 2];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return yaml_error_at(document, document->nodes[node].position, err, message);
}

// At the key rather than at its value: for keys that are not known, or stand where they must not.
bool yaml_key_error(const YamlDocument *document, YamlNode node, Error *err, const char *format,
                    ...)
{
    char message[ERROR_MESSAGE_SIZE / 2];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    int32_t key = document->nodes[node].key, position = document->nodes[node].position;
    if (key != YAML_NO_NODE) position = document->nodes[key].position;
    if (node == YAML_ROOT) position = 0;   // of "a.b=1" the key is what yaml_parse skipped
    return yaml_error_at(document, position, err, message);
}

// "`abc`", "a list of 3"
static void describe(const YamlDocument *document, YamlNode node, char *words, int32_t size)
{
    const YamlItem *item = &document->nodes[node];
    switch (item->kind) {
    case YAML_NOTHING:
        snprintf(words, (size_t)size, "nothing");
        return;
    case YAML_SCALAR:
        snprintf(words, (size_t)size, "`%.60s`", yaml_text(document, node));
        return;
    case YAML_LIST:
        snprintf(words, (size_t)size, "a list of %d", item->count);
        return;
    case YAML_MAP:
        snprintf(words, (size_t)size, "a map of %d keys", item->count);
        return;
    }
}

bool yaml_refuse(const YamlDocument *document, YamlNode node, const char *name, const char *allowed,
                 Error *err)
{
    char found[100];
    describe(document, node, found, sizeof found);
    return yaml_error(document, node, err, "%s: found %s; allowed: %s", name, found, allowed);
}

// Also of one half built.
void yaml_destroy(YamlDocument *document)
{
    if (!document) return;
    memory_free_all(document->name, document->shown);
    for (int32_t i = 0; i < document->node_count; i++)
        memory_free_all(document->nodes[i].text, document->nodes[i].stand_in);
    memory_free_all(document->nodes, document);
}
