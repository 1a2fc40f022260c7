// SPDX-License-Identifier: GPL-2.0-or-later
// Keys and values are taken as run.json has them, whatever keys there are: a new one needs no line
// here.
#include "page/page.h"

#include "base/memory.h"
#include "io/text/json_reader.h"

#include <math.h>
#include <string.h>

enum { KEY_SIZE = 200, VALUE_SIZE = 600, DEPTH_MAX = 6, INDENT = 2 };

// Called for each value that is no map; false ends the walk.
typedef void (*KeyFunction)(void *context, const char *path, const char *value);

// A value in short, of at most VALUE_SIZE bytes: a text without its quotes, a number to six digits,
// a list as it stands. Empty lists and null become "".
static void value_words(const char *json, const char *path, char words[VALUE_SIZE])
{
    double number = NAN;
    int32_t length = 0;
    const char *raw = json_find_raw(json, path, &length);
    bool truth = raw && (*raw == 't' || *raw == 'f');
    *words = 0;
    if (!raw || json_find_text(json, path, words, VALUE_SIZE)) return;
    if (length < VALUE_SIZE && !truth && json_find_number(json, path, &number)) {
        if (isfinite(number)) snprintf(words, VALUE_SIZE, "%.6g", number);
    } else if (!(length == 2 && *raw == '[')) {
        int32_t used = 0;   // of a list of several lines one
        for (int32_t k = 0; k < length && used + 1 < VALUE_SIZE; ++k) {
            bool blank = strchr(" \n\t", raw[k]) != NULL;
            if (blank && used > 0 && words[used - 1] == ' ') continue;
            words[used++] = blank ? ' ' : raw[k];
        }
        words[used] = 0;
    }
}

// All values below `path`, in the order of the text.
static void walk(const char *json, const char *path, int32_t depth, KeyFunction each, void *context)
{
    char key[KEY_SIZE], below[KEY_SIZE], words[VALUE_SIZE], inner[KEY_SIZE];
    for (int32_t k = 0; json_find_key(json, path, k, key, sizeof key); ++k) {
        int length = snprintf(below, sizeof below, "%s.%s", path, key);
        if (length < 0 || length >= (int)sizeof below) continue;
        if (depth < DEPTH_MAX && json_find_key(json, below, 0, inner, sizeof inner)) {
            walk(json, below, depth + 1, each, context);
            continue;
        }
        value_words(json, below, words);
        each(context, below, words);
    }
}

// --- differences ---------------------------------------------------------------------------------

typedef struct Differences {
    TextWriter *html;
    const RunSource *runs;
    int32_t count, of;   // of: the run whose keys are gone through
    int32_t written;
} Differences;

// A key that an earlier run has, too, has been told with that one.
static void write_difference(void *context, const char *path, const char *value)
{
    Differences *all = context;
    char words[VALUE_SIZE];
    int32_t length = 0;
    bool differs = false;
    for (int32_t k = 0; k < all->of; ++k)
        if (json_find_raw(all->runs[k].json, path, &length)) return;
    for (int32_t k = 0; k < all->count; ++k) {
        value_words(all->runs[k].json, path, words);
        differs = differs || strcmp(words, value) != 0;
    }
    if (!differs) return;
    ++all->written;
    html_around(all->html, "<tr><th scope='row'>", path + strlen("scene."), "</th>");
    for (int32_t k = 0; k < all->count; ++k) {
        value_words(all->runs[k].json, path, words);
        html_around(all->html, "<td class='number'>", *words ? words : "\u2013", "</td>");
    }
    html_markup(all->html, "</tr>\n");
}

bool scene_differences_write(TextWriter *html, PageSource *source, Error *err)
{
    const RunSource *runs = source->runs;
    int32_t count = source->count;
    Differences all = {.html = html, .runs = runs, .count = count};
    html_markup(html, "<div class='wide'><table><caption>Keys of the scenes that differ; all "
                      "others are the same</caption><thead><tr><th scope='col'>key</th>");
    for (int32_t k = 0; k < count; ++k) {
        html_around(html, "<th scope='col' class='number'>", runs[k].name, "</th>");
    }
    html_markup(html, "</tr></thead><tbody>\n");
    for (all.of = 0; all.of < count; ++all.of)
        walk(runs[all.of].json, "scene", 0, write_difference, &all);
    if (all.written == 0)
        html_markup(html, "<tr><td colspan='%d'>none: the scenes are the same</td></tr>\n",
                    count + 1);
    html_markup(html, "</tbody></table></div>\n");
    return error_is_clean(err);
}

// --- the scene -----------------------------------------------------------------------------------

typedef struct Summary {
    TextWriter *html;
    size_t prefix;   // of the paths, not shown
    bool begun;
} Summary;

static void write_key(void *context, const char *path, const char *value)
{
    Summary *summary = context;
    if (!*value) return;
    html_markup(summary->html, "%s<span class='key'><b>", summary->begun ? ", " : "");
    html_text(summary->html, path + summary->prefix);
    html_around(summary->html, "</b> ", value, "</span>");
    summary->begun = true;
}

// The scene is shown and saved as run.json has it, less the two spaces that it is indented by
// there.
bool scene_write(TextWriter *html, PageSource *source, Error *err)
{
    int32_t length = 0, used = 0;
    const RunSource *run = source->runs;
    char *scene = NULL, group[KEY_SIZE], path[KEY_SIZE + 8], inner[KEY_SIZE];
    html_markup(html,
                "<div class='wide'><table><caption>The scene, all values after defaults, in %s "
                "units</caption><tbody>\n",
                run->si ? "SI" : "normalised");
    for (int32_t k = 0; json_find_key(run->json, "scene", k, group, sizeof group); ++k) {
        snprintf(path, sizeof path, "scene.%s", group);
        if (!json_find_key(run->json, path, 0, inner, sizeof inner)) continue;   // title, units
        Summary summary = {.html = html, .prefix = strlen(path) + 1};
        html_around(html, "<tr><th scope='row'>", group, "</th><td>");
        walk(run->json, path, 0, write_key, &summary);
        html_markup(html, "</td></tr>\n");
    }
    html_markup(html, "</tbody></table></div>\n");

    const char *raw = json_find_raw(run->json, "scene", &length);
    if (!raw) return true;
    TRY(scene = NEW_ARRAY(char, (int64_t)length + 2, err));
    for (int32_t k = 0; k < length; ++k) {
        bool ends = raw[k] == '\n';
        scene[used++] = raw[k];
        for (int32_t i = 0; ends && i < INDENT && raw[k + 1] == ' '; ++i) ++k;
    }
    scene[used++] = '\n';
    html_markup(html, "<p><a download='scene.json' href='");
    html_data(html, "application/json", scene, used);
    html_markup(html, "'>Save as scene.json</a></p>\n<pre class='scene' tabindex='0'>");
    html_text(html, scene);
    html_markup(html, "</pre>\n");
cleanup:
    memory_free(scene);
    return error_is_clean(err);
}
