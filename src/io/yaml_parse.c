// SPDX-License-Identifier: GPL-2.0-or-later
// From bytes to a YamlDocument: checks that they are text, then hands libfyaml's events, which know
// their byte positions, to the builder.
#include "io/yaml_tree.h"

#include "base/memory.h"
#include "base/text.h"
#include "io/text_file.h"

#include <libfyaml.h>

#include <stdio.h>
#include <string.h>

// Byte from the text's start, -1: libfyaml does not say.
static int32_t token_position(struct fy_token *token)
{
    const struct fy_mark *mark = token ? fy_token_start_mark(token) : NULL;
    return mark ? (int32_t)mark->input_pos : -1;
}

// Block scalars (| and >) count as quoted: `null` in one of them is a word.
static bool take_scalar(YamlBuilder *builder, struct fy_token *token, Error *err)
{
    size_t length = 0;
    const char *text = token ? fy_token_get_text(token, &length) : "";
    if (!text) FAIL(err, ERROR_MEMORY, "no memory for the texts of %s", builder->document->name);
    enum fy_scalar_style style = token ? fy_token_scalar_style(token) : FYSS_PLAIN;
    bool in_quotes = style == FYSS_SINGLE_QUOTED || style == FYSS_DOUBLE_QUOTED;
    int32_t position = token_position(token);
    if (in_quotes && position > 0) position--;   // libfyaml's mark stands behind the quote
    TRY(yaml_build_scalar(builder, text, length, style != FYSS_PLAIN, position, err));
cleanup:
    return error_is_clean(err);
}

// At the token, or where that has no place at what is being built.
static bool refuse(const YamlBuilder *builder, struct fy_token *token, const char *message,
                   Error *err)
{
    int32_t position = token_position(token);
    yaml_error_at(builder->document, position < 0 ? yaml_build_position(builder) : position, err,
                  message);
    return false;
}

// An anchor can stand at a scalar, a list or a map; each is refused before anything is built of it.
// Which event may stand where is libfyaml's to check; what of it a scene may use is decided here.
static bool take_event(YamlBuilder *builder, const struct fy_event *event, Error *err)
{
    static const char no_anchors[] = "anchors and aliases (& and *) are not allowed in a scene";
    switch (event->type) {
    case FYET_DOCUMENT_START:
        if (builder->documents++ == 0) return true;
        return refuse(builder, event->document_start.document_start,
                      "a second document (---): a scene is one document", err);
    case FYET_ALIAS:
        return refuse(builder, event->alias.anchor, no_anchors, err);
    case FYET_SCALAR:
        if (event->scalar.anchor) return refuse(builder, event->scalar.anchor, no_anchors, err);
        return take_scalar(builder, event->scalar.value, err);
    case FYET_SEQUENCE_START:
        if (event->sequence_start.anchor)
            return refuse(builder, event->sequence_start.anchor, no_anchors, err);
        return yaml_build_open(builder, YAML_LIST,
                               token_position(event->sequence_start.sequence_start), err);
    case FYET_MAPPING_START:
        if (event->mapping_start.anchor)
            return refuse(builder, event->mapping_start.anchor, no_anchors, err);
        return yaml_build_open(builder, YAML_MAP,
                               token_position(event->mapping_start.mapping_start), err);
    case FYET_SEQUENCE_END:
    case FYET_MAPPING_END:
        yaml_build_close(builder);
        return true;
    default:
        return true;
    }
}

// libfyaml would print what it finds; we ask it for its errors instead.
static void discard_output(struct fy_diag *diag, void *user, const char *text, size_t length)
{
    (void)diag;
    (void)user;
    (void)text;
    (void)length;
}

// What libfyaml found wrong, at its place.
static void report_syntax(const YamlDocument *document, struct fy_diag *diag, Error *err)
{
    void *iterator = NULL;
    struct fy_diag_error *found = fy_diag_errors_iterate(diag, &iterator);
    char message[300] = "this is not YAML";
    int32_t position = found ? token_position(found->fyt) : 0;
    if (found && found->msg) snprintf(message, sizeof message, "not YAML: %.200s", found->msg);
    yaml_error_at(document, position < 0 ? 0 : position, err, message);
}

// Returns at the first fault, ours or libfyaml's; the tree is the caller's to destroy.
static bool parse_events(YamlDocument *document, Error *err)
{
    struct fy_diag_cfg diag_cfg;
    fy_diag_cfg_default(&diag_cfg);
    diag_cfg.fp = NULL;
    diag_cfg.output_fn = discard_output;
    diag_cfg.colorize = false;
    struct fy_diag *diag = fy_diag_create(&diag_cfg);
    struct fy_parse_cfg cfg = {.flags = FYPCF_DEFAULT_VERSION_1_2, .diag = diag};
    struct fy_parser *parser = diag ? fy_parser_create(&cfg) : NULL;
    if (!parser) FAIL(err, ERROR_MEMORY, "no memory to read %s", document->name);
    fy_diag_set_collect_errors(diag, true);
    if (fy_parser_set_string(parser, document->read, (size_t)document->size) != 0)
        FAIL(err, ERROR_MEMORY, "no memory to read %s", document->name);

    YamlBuilder builder = {.document = document};
    bool taken = true;
    for (;;) {
        struct fy_event *event = fy_parser_parse(parser);
        if (!event) break;
        taken = take_event(&builder, event, err);
        fy_parser_event_free(parser, event);
        if (!taken) goto cleanup;
    }
    if (fy_parser_get_stream_error(parser)) report_syntax(document, diag, err);
cleanup:
    if (parser) fy_parser_destroy(parser);
    if (diag) fy_diag_destroy(diag);
    return error_is_clean(err);
}

// Before libfyaml sees it: a binary file gets a sentence with the byte and its place.
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
            FAIL(err, ERROR_INPUT, "%s:%d:%d: %s", document->name, place.line, place.column,
                 message);
        }
        i += length;
    }
cleanup:
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
    TRY(check_is_text(made, err));
    TRY((made->read = memory_array(size + 1, 1, err)));
    memcpy(made->read, bytes, (size_t)size);
    memset(made->read, ' ', (size_t)(skip < size ? skip : size));
    TRY(parse_events(made, err));
    if (made->node_count == 0) {
        int32_t index = 0;
        TRY(yaml_add_node(made, YAML_NOTHING, size, &index, err));
    }
cleanup:
    if (error_is_clean(err))
        *document = made;
    else
        yaml_destroy(made);
    return error_is_clean(err);
}

// `skip` bytes are overwritten by blanks in what is read, so that places keep their columns.
bool yaml_parse(const char *name, const char *text, int32_t skip, YamlDocument **document,
                Error *err)
{
    *document = NULL;
    size_t length = strlen(text);
    if (length > YAML_BYTES_MAX)
        FAIL(err, ERROR_INPUT, "%s: longer than %d bytes", name, YAML_BYTES_MAX);
    char *bytes = memory_text(text, err);
    TRY(bytes);
    TRY(parse_bytes(name, bytes, (int32_t)length, skip, document, err));
cleanup:
    return error_is_clean(err);
}

bool yaml_read(const char *path, YamlDocument **document, Error *err)
{
    *document = NULL;
    char *bytes = NULL;
    int32_t size = 0;
    TRY(text_file_read(path, YAML_BYTES_MAX, &bytes, &size, err));
    TRY(parse_bytes(path, bytes, size, 0, document, err));
cleanup:
    return error_is_clean(err);
}
