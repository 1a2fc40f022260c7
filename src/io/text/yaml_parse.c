// SPDX-License-Identifier: GPL-2.0-or-later
// From bytes to a YamlDocument: checks that they are text, then takes one node after the other from
// libfyaml's events, which know their byte positions.
#include "io/text/yaml_tree.h"

#include "base/memory.h"
#include "base/text.h"
#include "io/files/text_file.h"

#include <libfyaml.h>

#include <stdio.h>
#include <string.h>

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

// Reports the error that libfyaml found, at its place.
static bool report_syntax(const Reader *reader, Error *err)
{
    void *iterator = NULL;
    struct fy_diag_error *found = fy_diag_errors_iterate(reader->diag, &iterator);
    char message[300] = "this is not YAML";
    if (found && found->msg) snprintf(message, sizeof message, "not YAML: %.200s", found->msg);
    int32_t position = token_position(found ? found->fyt : NULL, 0);
    return yaml_error_at(reader->document, position, err, message);
}

// Which event may stand where is libfyaml's to check. After the last one reader->event is NULL.
static bool next_event(Reader *reader, Error *err)
{
    fy_parser_event_free(reader->parser, reader->event);
    reader->event = fy_parser_parse(reader->parser);
    return !fy_parser_get_stream_error(reader->parser) || report_syntax(reader, err);
}

// Indices, not pointers, name nodes: the array moves as it grows.
static bool add_node(YamlDocument *document, YamlKind kind, int32_t position, YamlNode *node,
                     Error *err)
{
    if (document->node_count == YAML_NODES_MAX)
        return yaml_error_at(document, position, err, "more than 20000 values: this is no scene");
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

// As YAML 1.2's core schema has it, without its `Null` and `NULL`.
static bool is_null(const char *text)
{
    return !*text || strcmp(text, "~") == 0 || strcmp(text, "null") == 0 ||
           strcmp(text, "Null") == 0 || strcmp(text, "NULL") == 0;
}

// Escapes ("\uFFFE") bring characters that check_is_text does not see, and that no title or name
// may have: pictures and pages are written at the end of a run.
static bool check_shown(const YamlDocument *document, YamlNode node, size_t length, YamlNode beside,
                        Error *err)
{
    char message[160];
    uint32_t code = 0;   // of "\0", at which the text would end
    const YamlItem *item = &document->nodes[node];
    const char *key = beside == YAML_NO_NODE                        ? ""
                      : document->nodes[beside].kind == YAML_SCALAR ? yaml_text(document, beside)
                                                                    : yaml_key(document, beside);
    if (strlen(item->text) == length && text_find_unshown(item->text, &code) < 0) return true;
    snprintf(message, sizeof message,
             "%.60s%sthe character U+%04X, which no page or picture can show", key,
             *key ? ": " : "", code);
    return yaml_error_at(document, item->position, err, message);
}

// Block scalars (| and >) count as quoted: `null` in one of them is a word.
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
    bool quoted = style != FYSS_PLAIN;
    YamlKind kind = !quoted && is_null(text) ? YAML_NOTHING : YAML_SCALAR;
    if (!add_node(document, kind, position, node, err)) return false;
    document->nodes[*node].quoted = quoted;
    return (document->nodes[*node].text = memory_text(text, err)) &&
           check_shown(document, *node, length, beside, err);
}

// YAML leaves open what a key twice means; here it is an error with both places.
static bool check_key(const YamlDocument *document, YamlNode map, YamlNode key, Error *err)
{
    char message[200] = "a key must be a plain word";
    const char *word = yaml_text(document, key);
    bool good = yaml_kind(document, key) == YAML_SCALAR;
    for (YamlNode i = yaml_first(document, map); good && i != YAML_NO_NODE;
         i = yaml_next(document, i)) {
        if (strcmp(yaml_key(document, i), word) != 0) continue;
        int32_t line = yaml_line(document, document->nodes[i].key);
        snprintf(message, sizeof message, "the key `%.60s` stands twice (first in line %d)", word,
                 line);
        good = false;
    }
    if (!good) yaml_error_at(document, document->nodes[key].position, err, message);
    return good;
}

static void append(YamlDocument *document, YamlNode above, YamlNode key, YamlNode node)
{
    YamlItem *list = &document->nodes[above];
    document->nodes[node].key = key;
    if (list->last == YAML_NO_NODE)
        list->first = node;
    else
        document->nodes[list->last].next = node;
    list->last = node;
    list->count++;
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
        return yaml_error_at(document, token_position(anchor, position), err,
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
        return yaml_error_at(document, document->nodes[above].position, err,
                             "more than 16 levels of lists and maps");
    for (;;) {
        YamlNode key = YAML_NO_NODE, node = YAML_NO_NODE;
        if (!next_event(reader, err)) return false;
        if (reader->event->type == (kind == YAML_MAP ? FYET_MAPPING_END : FYET_SEQUENCE_END)) break;
        if (kind == YAML_MAP) {
            if (!begin_node(reader, above, &key, err)) return false;
            if (!check_key(document, above, key, err)) return false;
            if (!next_event(reader, err)) return false;
        }
        if (!begin_node(reader, kind == YAML_MAP ? key : above, &node, err)) return false;
        append(document, above, key, node);
        if (!read_children(reader, node, depth + 1, err)) return false;
    }
    return true;
}

// One document at most: its root is node 0.
static bool read_events(Reader *reader, Error *err)
{
    int32_t documents = 0;
    YamlNode root = YAML_NO_NODE;
    do {
        if (!next_event(reader, err)) return false;
        enum fy_event_type type = reader->event ? reader->event->type : FYET_NONE;
        if (type == FYET_DOCUMENT_START && ++documents == 2) {
            struct fy_token *token = reader->event->document_start.document_start;
            return yaml_error_at(reader->document, token_position(token, 0), err,
                                 "a second document (---): a scene is one document");
        }
        if (type == FYET_SCALAR || type == FYET_ALIAS || type == FYET_SEQUENCE_START ||
            type == FYET_MAPPING_START) {
            if (!begin_node(reader, YAML_NO_NODE, &root, err)) return false;
            if (!read_children(reader, root, 0, err)) return false;
        }
    } while (reader->event);
    return root != YAML_NO_NODE ||
           add_node(reader->document, YAML_NOTHING, reader->document->size, &root, err);
}

// libfyaml would print its errors; they are asked for instead.
static void discard_output(struct fy_diag *diag, void *user, const char *text, size_t length)
{
    (void)diag;
    (void)user;
    (void)text;
    (void)length;
}

// Returns at the first fault, ours or libfyaml's; the tree is the caller's to destroy. Blanks stand
// in the place of the first `skip` bytes, so that all others keep theirs.
static bool parse_text(YamlDocument *document, int32_t skip, Error *err)
{
    struct fy_diag_cfg diag_cfg;
    fy_diag_cfg_default(&diag_cfg);
    diag_cfg.fp = NULL;
    diag_cfg.output_fn = discard_output;
    diag_cfg.colorize = false;
    Reader reader = {.document = document, .diag = fy_diag_create(&diag_cfg)};
    struct fy_parse_cfg cfg = {.flags = FYPCF_DEFAULT_VERSION_1_2, .diag = reader.diag};
    char *text = memory_text(document->shown, err);
    TRY(text);
    memset(text, ' ', (size_t)(skip < document->size ? skip : document->size));
    if (reader.diag) reader.parser = fy_parser_create(&cfg);
    if (!reader.parser) FAIL(err, ERROR_MEMORY, "no memory to read %s", document->name);
    fy_diag_set_collect_errors(reader.diag, true);
    if (fy_parser_set_string(reader.parser, text, (size_t)document->size) != 0)
        FAIL(err, ERROR_MEMORY, "no memory to read %s", document->name);
    TRY(read_events(&reader, err));
cleanup:
    if (reader.parser) {
        fy_parser_event_free(reader.parser, reader.event);
        fy_parser_destroy(reader.parser);
    }
    if (reader.diag) fy_diag_destroy(reader.diag);
    memory_free(text);
    return error_is_clean(err);
}

// Before libfyaml reads it: a binary file gets an error with the byte and its place.
static bool check_is_text(const YamlDocument *document, Error *err)
{
    const unsigned char *text = (const unsigned char *)document->shown;
    for (int32_t i = 0; i < document->size;) {
        char message[100];
        int32_t length = text_utf8_length((const char *)text + i);
        bool control = text[i] < ' ' && !strchr("\t\n\r", text[i]);
        if (control || text[i] == 0 || text[i] == 0x7F)
            snprintf(message, sizeof message, "the byte 0x%02X: not a text file", text[i]);
        else if (length == 0)
            snprintf(message, sizeof message, "the byte 0x%02X: not UTF-8", text[i]);
        if (control || text[i] == 0 || text[i] == 0x7F || length == 0) {
            YamlPlace place = yaml_place(document, i);
            return REFUSE(err, "%s:%d:%d: %s", document->name, place.line, place.column, message);
        }
        i += length;
    }
    return true;
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
    TRY(check_is_text(made, err));
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

bool yaml_scalar(const char *name, const char *text, YamlDocument **document, Error *err)
{
    YamlNode root = YAML_NO_NODE;
    YamlDocument *made = NEW_ARRAY(YamlDocument, 1, err);
    *document = NULL;
    TRY(made);
    TRY((made->name = memory_text(name, err)));
    TRY((made->shown = memory_text(text, err)));
    made->size = (int32_t)strlen(text);
    TRY(add_node(made, YAML_SCALAR, 0, &root, err));
    TRY((made->nodes[root].text = memory_text(text, err)));
    *document = made;
    made = NULL;
cleanup:
    yaml_destroy(made);
    return error_is_clean(err);
}

bool yaml_read(const char *path, YamlDocument **document, Error *err)
{
    *document = NULL;
    char *bytes = NULL;
    int32_t size = 0;
    return text_file_bytes(path, YAML_BYTES_MAX, &bytes, &size, err) &&
           parse_bytes(path, bytes, size, 0, document, err);
}
