// SPDX-License-Identifier: GPL-2.0-or-later
// Words of gmsh 4's language, looked for everywhere, in comments and strings too: whoever hides a
// command must not be able to by a quote that we take for another's. So a file may be refused for a
// comment; none is let through for one.
#include "io/mesh/geo_commands.h"

#include "base/memory.h"
#include "io/files/text_file.h"
#include "io/mesh/geo_parameters.h"

#include <ctype.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// FILES_MAX: files that include the next one twice each would be read 2^depth times.
enum { FILES_MAX = 1000 };

// A script and what it includes, on the way through.
typedef struct Scripts {
    int32_t depth, files;   // now open, read so far
} Scripts;

// System: SystemCall and NonBlockingSystemCall too. FileName: options that name a log to write.
static const char *const COMMANDS[] = {"System", "Onelab",   "Solver",    "Merge",   "Save",
                                       "Plugin", "FileName", "CreateDir", "UnitTest"};

// The line of a place in a text, from 1.
static int32_t line_of(const char *text, const char *at)
{
    int32_t line = 1;
    for (; text < at; text++) line += *text == '\n';
    return line;
}

// `Print "x.png"`, or `Printf` with a ">" behind it: output that goes to a file.
static const char *find_print(const char *text)
{
    for (const char *at = text; (at = strstr(at, "Print")); at += 5) {
        if (at[5] != 'f' && !isalpha((unsigned char)at[5])) return at;
        if (at[5] == 'f' && strchr(at, '>')) return at;
    }
    return NULL;
}

static const char *find_command(const char *text)
{
    for (size_t k = 0; k < sizeof COMMANDS / sizeof COMMANDS[0]; k++) {
        const char *found = strstr(text, COMMANDS[k]);
        if (found) return found;
    }
    return find_print(text);
}

static bool refuse_script(const char *path, Scripts *scripts, Error *err);

// `other` comes along with the script `path`. What cannot be opened here cannot be by gmsh; a pipe
// or terminal would never end.
static bool refuse_found(const char *path, const char *other, Scripts *scripts, Error *err)
{
    struct stat status;
    if (access(other, R_OK) != 0 || stat(other, &status) != 0) return true;
    if (!S_ISREG(status.st_mode))
        return REFUSE(err, "%s: includes %s, which is no file", path, other);
    return refuse_script(other, scripts, err);
}

// `quoted` begins with a quote; the name is relative to the file that includes it.
static bool refuse_included(const char *path, const char *quoted, Scripts *scripts, Error *err)
{
    char other[GEO_PATH_SIZE];
    geo_included_path(path, quoted + 1, (int)strcspn(quoted + 1, "\"'\n"), other);
    return refuse_found(path, other, scripts, err);
}

static bool refuse_script(const char *path, Scripts *scripts, Error *err)
{
    static const char *const how =
        "give --trust, or set AMONTONS_TRUST=yes, if you know where it comes from";
    char *text = NULL;
    int32_t size = 0;
    scripts->files++;
    scripts->depth++;
    TRY(text_file_read(path, GEO_BYTES_MAX, &text, &size, err));
    if (scripts->depth > GEO_INCLUDE_DEPTH_MAX + 1)
        FAIL(err, ERROR_INPUT, "%s: files include each other more than %d deep", path,
             GEO_INCLUDE_DEPTH_MAX);
    if (scripts->files > FILES_MAX)
        FAIL(err, ERROR_INPUT, "%s: more than %d files are included", path, FILES_MAX);
    if (strlen(text) != (size_t)size) FAIL(err, ERROR_INPUT, "%s: is no text", path);
    const char *found = find_command(text);
    if (found)
        FAIL(err, ERROR_INPUT,
             "%s:%d: `%.*s`: gmsh would run a command, write a file or open one that was not "
             "looked at; %s",
             path, line_of(text, found), (int)strcspn(found, " \t\n;(\"'"), found, how);
    for (const char *at = text; (at = strstr(at, "Include"));) {
        int32_t line = line_of(text, at);
        at += strlen("Include");
        const char *name = at + strspn(at, " \t");
        if (*name != '"' && *name != '\'')
            FAIL(err, ERROR_INPUT, "%s:%d: includes a file whose name is not written out; %s", path,
                 line, how);
        TRY(refuse_included(path, name, scripts, err));
    }
cleanup:
    scripts->depth--;
    memory_free(text);
    return error_is_clean(err);
}

// gmsh reads the options like a script, those of a .msh too.
bool geo_commands_refuse(const char *path, bool is_script, Error *err)
{
    char options[PATH_MAX];
    Scripts scripts = {0};
    if (is_script && !refuse_script(path, &scripts, err)) return false;
    int length = snprintf(options, sizeof options, "%s.opt", path);
    if (length < (int)sizeof options && access(options, F_OK) == 0 &&
        !refuse_found(path, options, &scripts, err))
        return false;
    return true;
}
