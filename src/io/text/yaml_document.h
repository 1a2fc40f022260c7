// SPDX-License-Identifier: GPL-2.0-or-later
// A YAML text as a tree whose every node knows its line and column, so that an error can show the
// place. libfyaml reads the syntax. For scenes, `--set`, studies and plots; run.json is YAML, too.
// The tree is ours: libfyaml's own (0.7) does not say where a list, a map or an empty value begins,
// which its events do.
//
// Stricter than YAML, because a scene has no use for more: one document, keys are plain words,
// no key twice in a map, no anchors, aliases or merge keys, at most YAML_DEPTH_MAX levels.
#ifndef AMONTONS_IO_TEXT_YAML_DOCUMENT_H
#define AMONTONS_IO_TEXT_YAML_DOCUMENT_H

#include "base/error.h"

#include <stdint.h>

typedef struct YamlDocument YamlDocument;
typedef int32_t YamlNode;   // of one document

enum {
    YAML_ROOT = 0,
    YAML_NO_NODE = -1,
    YAML_BYTES_MAX = 1 << 20,   // a scene has some 2 kB; a mesh given by mistake has many MB
    YAML_NODES_MAX = 20000,
    YAML_DEPTH_MAX = 16,
};

typedef enum YamlKind {
    YAML_NOTHING,   // `key:` with no value, or null, or ~
    YAML_SCALAR,
    YAML_LIST,
    YAML_MAP,
} YamlKind;

// Reads the file `path`. ERROR_FILE: cannot be read. ERROR_INPUT: a folder, empty, too large, not
// text, not UTF-8, not YAML; with file:line:column and the line where there is one.
bool yaml_read(const char *path, YamlDocument **document, Error *err);

// Reads `text`, called `name` in errors. Its first `skip` bytes are shown in errors but not read:
// for "a.b=[1" with skip 4 the value is read and a caret stands under what the user typed.
bool yaml_parse(const char *name, const char *text, int32_t skip, YamlDocument **document,
                Error *err);
void yaml_destroy(YamlDocument *document);   // NULL is fine

// True if it was read from a file: false, it is text of the command line or of the program.
bool yaml_is_file(const YamlDocument *document);
YamlKind yaml_kind(const YamlDocument *document, YamlNode node);
const char *yaml_text(const YamlDocument *document, YamlNode node);   // of a scalar, else ""
bool yaml_is_quoted(const YamlDocument *document, YamlNode node);
// `text` is from now on what yaml_text gives for this scalar: the value of a formula. NULL: its own
// text again. Errors show the source line as it was typed.
bool yaml_stand_in(const YamlDocument *document, YamlNode node, const char *text, Error *err);
int32_t yaml_count(const YamlDocument *document, YamlNode node);   // children
int32_t yaml_line(const YamlDocument *document, YamlNode node);   // from 1
int32_t yaml_column(const YamlDocument *document, YamlNode node);   // from 1, in characters

// The children of a list or a map in the order of the text; YAML_NO_NODE after the last.
YamlNode yaml_first(const YamlDocument *document, YamlNode node);
YamlNode yaml_next(const YamlDocument *document, YamlNode node);
#define YAML_EACH(child, document, node)                                                           \
    for (YamlNode child = yaml_first(document, node); child != YAML_NO_NODE;                       \
         child = yaml_next(document, child))
const char *yaml_key(const YamlDocument *document, YamlNode node);   // of a map's child, else ""

// The value under a path of keys ("material.young"), from the root; YAML_NO_NODE if none.
YamlNode yaml_look_up(const YamlDocument *document, const char *path);

// Sets ERROR_INPUT: "name:line:column: MESSAGE", then the source line with a caret under the value
// of `node` (yaml_error) or under its key (yaml_key_error). Always false, so that a reader can
// return it.
bool yaml_error(const YamlDocument *document, YamlNode node, Error *err, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
bool yaml_key_error(const YamlDocument *document, YamlNode node, Error *err, const char *format,
                    ...) __attribute__((format(printf, 4, 5)));

// yaml_error of "NAME: found WHAT STANDS THERE; allowed: ALLOWED".
bool yaml_refuse(const YamlDocument *document, YamlNode node, const char *name, const char *allowed,
                 Error *err);

#endif
