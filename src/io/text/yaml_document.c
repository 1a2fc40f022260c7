// SPDX-License-Identifier: GPL-2.0-or-later
// A tree in one array: nodes, linked by first child and next sibling. libfyaml's events, which know
// their byte positions, become its nodes. Lines and columns are counted only when an error wants
// them.
#include "io/text/yaml_document.h"

#include "base/memory.h"
#include "base/text.h"
#include "io/files/text_file.h"

#include <libfyaml.h>

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

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
    bool is_file;   // read by yaml_read
};

// --- errors that show the place -----------------------------------------------------------------

enum { SHOWN_WIDTH = 88 };   // of a source line in an error, characters

// Place of a byte of the text.
typedef struct YamlPlace {
    int32_t line, column;   // from 1; column in characters
    int32_t line_start, line_end;   // bytes
} YamlPlace;

static bool starts_character(char byte)
{
    return ((unsigned char)byte & 0xC0) != 0x80;
}

// Columns count characters, not bytes: continuation bytes of UTF-8 (10xxxxxx) are passed over.
static YamlPlace find_place(const YamlDocument *document, int32_t position)
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

// The error of yaml_error, at a byte of the text.
static bool error_at(const YamlDocument *document, int32_t position, Error *err,
                     const char *message)
{
    // The line at that place as "   7 | material: {young: 1", of a long one the part around the
    // column.
    YamlPlace place = find_place(document, position);
    int32_t first = place.column > SHOWN_WIDTH - 8 ? place.column - SHOWN_WIDTH / 2 : 1;
    char line[4 * SHOWN_WIDTH + 1] = {0}, excerpt[6 * SHOWN_WIDTH];
    int32_t used = 0, column = 0;
    for (int32_t i = place.line_start; i < place.line_end; i++) {
        char byte = document->shown[i];
        if (starts_character(byte)) column++;
        if (column < first) continue;
        if (column >= first + SHOWN_WIDTH || used == 4 * SHOWN_WIDTH) break;
        line[used++] = (unsigned char)byte < ' ' ? ' ' : byte;
    }
    // A caret stands below it.
    snprintf(excerpt, sizeof excerpt, "\n%5d | %s\n      | %*s^", place.line, line,
             place.column - first, "");
    // The error's own file and line are this file's: the place in the user's text is in the
    // message.
    error_set(err, ERROR_INPUT, __FILE__, __LINE__, "%s:%d:%d: %s%s", document->name, place.line,
              place.column, message, excerpt);
    return false;
}

bool yaml_error(const YamlDocument *document, YamlNode node, Error *err, const char *format, ...)
{
    char message[ERROR_MESSAGE_SIZE / 2];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return error_at(document, document->nodes[node].position, err, message);
}

// The error is placed at the key rather than at its value: for keys that are not known, or stand
// where they must not.
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
    return error_at(document, position, err, message);
}

bool yaml_refuse(const YamlDocument *document, YamlNode node, const char *name, const char *allowed,
                 Error *err)
{
    char found[100] = "nothing";   // YAML_NOTHING
    const YamlItem *item = &document->nodes[node];
    if (item->kind == YAML_SCALAR)
        snprintf(found, sizeof found, "`%.60s`", yaml_text(document, node));
    else if (item->kind == YAML_LIST)
        snprintf(found, sizeof found, "a list of %d", item->count);
    else if (item->kind == YAML_MAP)
        snprintf(found, sizeof found, "a map of %d keys", item->count);
    return yaml_error(document, node, err, "%s: found %s; allowed: %s", name, found, allowed);
}

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
    return find_place(document, document->nodes[node].position).line;
}

int32_t yaml_column(const YamlDocument *document, YamlNode node)
{
    return find_place(document, document->nodes[node].position).column;
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

// --- parsing ------------------------------------------------------------------------------------

typedef struct Reader {
    YamlDocument *document;
    struct fy_diag *diag;
    struct fy_parser *parser;
    struct fy_event *event;   // the one to be read
} Reader;

// Byte from the text's start; `otherwise` where libfyaml does not say: of an empty value, say.
static int32_t token_position(struct fy_token *token, int32_t otherwise)
{
    const struct fy_mark *mark = token ? fy_token_start_mark(token) : NULL;
    return mark ? (int32_t)mark->input_pos : otherwise;
}

// Which event may stand where is libfyaml's to check; an error that it found is told at its place.
// After the last event reader->event is NULL.
static bool next_event(Reader *reader, Error *err)
{
    fy_parser_event_free(reader->parser, reader->event);
    reader->event = fy_parser_parse(reader->parser);
    if (!fy_parser_get_stream_error(reader->parser)) return true;
    void *iterator = NULL;
    struct fy_diag_error *found = fy_diag_errors_iterate(reader->diag, &iterator);
    char message[300] = "this is not YAML";
    if (found && found->msg) snprintf(message, sizeof message, "not YAML: %.200s", found->msg);
    return error_at(reader->document, token_position(found ? found->fyt : NULL, 0), err, message);
}

// Indices, not pointers, name nodes: the array moves as it grows.
static bool add_node(YamlDocument *document, YamlKind kind, int32_t position, YamlNode *node,
                     Error *err)
{
    if (document->node_count == YAML_NODES_MAX)
        return error_at(document, position, err, "more than 20000 values: this is no scene");
    if (!memory_grow(&document->nodes, document->node_count, &document->node_capacity,
                     sizeof(YamlItem), err))
        return false;
    *node = document->node_count++;
    document->nodes[*node] = (YamlItem){.kind = kind,
                                        .position = position,
                                        .key = YAML_NO_NODE,
                                        .first = YAML_NO_NODE,
                                        .last = YAML_NO_NODE,
                                        .next = YAML_NO_NODE};
    return true;
}

// `beside`: the key of the value, or the list it is in; YAML_NO_NODE: the root.
static bool add_scalar(Reader *reader, int32_t position, YamlNode beside, YamlNode *node,
                       Error *err)
{
    YamlDocument *document = reader->document;
    struct fy_token *token = fy_event_get_token(reader->event);
    const char *text = token ? fy_token_get_text0(token) : "";
    size_t length = token ? fy_token_get_text_length(token) : 0;
    if (!text) return FAULT(err, ERROR_MEMORY, "no memory for the texts of %s", document->name);
    enum fy_scalar_style style = token ? fy_token_scalar_style(token) : FYSS_PLAIN;
    if (style == FYSS_SINGLE_QUOTED || style == FYSS_DOUBLE_QUOTED)
        position--;   // libfyaml's mark stands behind the quote

    // YAML 1.2's core schema has these words for null. Block scalars (| and >) count as quoted:
    // `null` in one of them is a word.
    bool quoted = style != FYSS_PLAIN;
    bool null = !*text || strcmp(text, "~") == 0 || strcmp(text, "null") == 0 ||
                strcmp(text, "Null") == 0 || strcmp(text, "NULL") == 0;
    if (!add_node(document, !quoted && null ? YAML_NOTHING : YAML_SCALAR, position, node, err))
        return false;
    document->nodes[*node].quoted = quoted;
    char *kept = document->nodes[*node].text = memory_text(text, err);
    if (!kept) return false;

    // Escapes ("\uFFFE") bring characters that parse_bytes does not see, and that no title or
    // name may have: pictures and pages are written at the end of a run.
    char message[160];
    uint32_t code = 0;   // of "\0", at which the text would end
    if (strlen(kept) == length && text_find_unshown(kept, &code) < 0) return true;
    const char *key = beside == YAML_NO_NODE                        ? ""
                      : document->nodes[beside].kind == YAML_SCALAR ? yaml_text(document, beside)
                                                                    : yaml_key(document, beside);
    snprintf(message, sizeof message,
             "%.60s%sthe character U+%04X, which no page or picture can show", key,
             *key ? ": " : "", code);
    return error_at(document, position, err, message);
}

// The node that begins with reader->event; of a list or a map without what is in it. `beside`: its
// key or the list it is in, where it has no place of its own; YAML_NO_NODE: the root.
static bool begin_node(Reader *reader, YamlNode beside, YamlNode *node, Error *err)
{
    YamlDocument *document = reader->document;
    enum fy_event_type type = reader->event->type;
    int32_t position = beside == YAML_NO_NODE ? 0 : document->nodes[beside].position;
    struct fy_token *anchor = type == FYET_ALIAS ? reader->event->alias.anchor
                                                 : fy_event_get_anchor_token(reader->event);
    if (anchor)
        return error_at(document, token_position(anchor, position), err,
                        "anchors and aliases (& and *) are not allowed in a scene");
    // A value left out is where its key is. Since libfyaml 0.8 it has a token, behind the colon.
    struct fy_token *token = fy_event_get_token(reader->event);
    bool left_out = type == FYET_SCALAR && token && fy_token_scalar_style(token) == FYSS_PLAIN &&
                    fy_token_get_text_length(token) == 0;
    if (!left_out) position = token_position(token, position);
    return type == FYET_SCALAR
               ? add_scalar(reader, position, beside, node, err)
               : add_node(document, type == FYET_MAPPING_START ? YAML_MAP : YAML_LIST, position,
                          node, err);
}

// Reads the children of a list or a map up to its end; each value of a map follows its key. depth:
// number of lists and maps around this one.
static bool read_children(Reader *reader, YamlNode above, int32_t depth, Error *err)
{
    YamlDocument *document = reader->document;
    YamlKind kind = yaml_kind(document, above);
    if (kind != YAML_LIST && kind != YAML_MAP) return true;
    if (depth == YAML_DEPTH_MAX)
        return error_at(document, document->nodes[above].position, err,
                        "more than 16 levels of lists and maps");
    for (;;) {
        YamlNode key = YAML_NO_NODE, node = YAML_NO_NODE;
        if (!next_event(reader, err)) return false;
        if (reader->event->type == (kind == YAML_MAP ? FYET_MAPPING_END : FYET_SEQUENCE_END)) break;
        if (kind == YAML_MAP) {
            if (!begin_node(reader, above, &key, err)) return false;

            // YAML leaves open what a key twice means; here it is an error with both places.
            const char *word = yaml_text(document, key);
            int32_t position = document->nodes[key].position;
            if (yaml_kind(document, key) != YAML_SCALAR)
                return error_at(document, position, err, "a key must be a plain word");
            YAML_EACH (other, document, above) {
                char message[200];
                if (strcmp(yaml_key(document, other), word) != 0) continue;
                snprintf(message, sizeof message, "the key `%.60s` stands twice (first in line %d)",
                         word, yaml_line(document, document->nodes[other].key));
                return error_at(document, position, err, message);
            }
            if (!next_event(reader, err)) return false;
        }
        if (!begin_node(reader, kind == YAML_MAP ? key : above, &node, err)) return false;
        // The new node is the last child from here on.
        YamlItem *parent = &document->nodes[above];
        document->nodes[node].key = key;
        if (parent->last == YAML_NO_NODE)
            parent->first = node;
        else
            document->nodes[parent->last].next = node;
        parent->last = node;
        parent->count++;
        if (!read_children(reader, node, depth + 1, err)) return false;
    }
    return true;
}

// libfyaml would print its errors; they are asked for instead.
static void discard_output(struct fy_diag *diag, void *user, const char *text, size_t length)
{
    (void)diag;
    (void)user;
    (void)text;
    (void)length;
}

// Returns at the first fault, ours or libfyaml's; the tree is the caller's to destroy.
static bool parse_text(YamlDocument *document, int32_t skip, Error *err)
{
    int32_t documents = 0;
    YamlNode root = YAML_NO_NODE;
    struct fy_diag_cfg diag_cfg;
    fy_diag_cfg_default(&diag_cfg);
    diag_cfg.fp = NULL;
    diag_cfg.output_fn = discard_output;
    diag_cfg.colorize = false;
    Reader reader = {.document = document, .diag = fy_diag_create(&diag_cfg)};
    struct fy_parse_cfg cfg = {.flags = FYPCF_DEFAULT_VERSION_1_2, .diag = reader.diag};

    // Blanks stand in the place of the first `skip` bytes, so that all others keep theirs.
    char *text = memory_text(document->shown, err);
    TRY(text);
    memset(text, ' ', (size_t)(skip < document->size ? skip : document->size));
    if (reader.diag) reader.parser = fy_parser_create(&cfg);
    if (!reader.parser) FAIL(err, ERROR_MEMORY, "no memory to read %s", document->name);
    fy_diag_set_collect_errors(reader.diag, true);
    if (fy_parser_set_string(reader.parser, text, (size_t)document->size) != 0)
        FAIL(err, ERROR_MEMORY, "no memory to read %s", document->name);

    // One document at most: its root is node 0.
    do {
        TRY(next_event(&reader, err));
        enum fy_event_type type = reader.event ? reader.event->type : FYET_NONE;
        if (type == FYET_DOCUMENT_START && ++documents == 2) {
            struct fy_token *token = reader.event->document_start.document_start;
            TRY(error_at(document, token_position(token, 0), err,
                         "a second document (---): a scene is one document"));
        }
        if (type == FYET_SCALAR || type == FYET_ALIAS || type == FYET_SEQUENCE_START ||
            type == FYET_MAPPING_START) {
            TRY(begin_node(&reader, YAML_NO_NODE, &root, err));
            TRY(read_children(&reader, root, 0, err));
        }
    } while (reader.event);
    if (root == YAML_NO_NODE) TRY(add_node(document, YAML_NOTHING, document->size, &root, err));
cleanup:
    if (reader.parser) {
        fy_parser_event_free(reader.parser, reader.event);
        fy_parser_destroy(reader.parser);
    }
    if (reader.diag) fy_diag_destroy(reader.diag);
    memory_free(text);
    return error_is_clean(err);
}

// Takes over `bytes` ([size + 1], zero-terminated) also when it fails.
static bool parse_bytes(const char *name, char *bytes, int32_t size, int32_t skip,
                        YamlDocument **document, Error *err)
{
    YamlDocument *made = NEW_ARRAY(YamlDocument, 1, err);
    if (!made) {
        memory_free(bytes);
        goto cleanup;
    }
    made->shown = bytes;
    made->size = size;
    TRY((made->name = memory_text(name, err)));

    // Before libfyaml reads it: a binary file gets an error with the byte and its place.
    for (int32_t i = 0, length; i < size; i += length) {
        unsigned char byte = (unsigned char)bytes[i];
        length = text_utf8_length(bytes + i);
        bool control = (byte < ' ' && !strchr("\t\n\r", byte)) || !byte || byte == 0x7F;
        if (!control && length > 0) continue;
        YamlPlace place = find_place(made, i);
        FAIL(err, ERROR_INPUT, "%s:%d:%d: the byte 0x%02X: %s", made->name, place.line,
             place.column, byte, control ? "not a text file" : "not UTF-8");
    }
    TRY(parse_text(made, skip, err));
cleanup:
    if (error_is_clean(err))
        *document = made;
    else
        yaml_destroy(made);
    return error_is_clean(err);
}

bool yaml_parse(const char *name, const char *text, int32_t skip, YamlDocument **document,
                Error *err)
{
    *document = NULL;
    size_t length = strlen(text);
    if (length > YAML_BYTES_MAX)
        return REFUSE(err, "%s: longer than %d bytes", name, YAML_BYTES_MAX);
    char *bytes = memory_text(text, err);
    return bytes && parse_bytes(name, bytes, (int32_t)length, skip, document, err);
}

bool yaml_read(const char *path, YamlDocument **document, Error *err)
{
    *document = NULL;
    char *bytes = NULL;
    int32_t size = 0;
    if (!text_file_bytes(path, YAML_BYTES_MAX, &bytes, &size, err) ||
        !parse_bytes(path, bytes, size, 0, document, err))
        return false;
    (*document)->is_file = true;
    return true;
}

bool yaml_is_file(const YamlDocument *document)
{
    return document->is_file;
}

// Frees a document that is half built, too.
void yaml_destroy(YamlDocument *document)
{
    if (!document) return;
    memory_free_all(document->name, document->shown);
    for (int32_t i = 0; i < document->node_count; i++)
        memory_free_all(document->nodes[i].text, document->nodes[i].stand_in);
    memory_free_all(document->nodes, document);
}
