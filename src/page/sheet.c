// SPDX-License-Identifier: GPL-2.0-or-later
// The policy names style and script by their SHA-256 (Content Security Policy 3): no other script
// runs, whatever a text should smuggle in.
#include "page/page.h"

#include "io/text/json_reader.h"
#include "page_resources.h"

#include <string.h>

enum { HASH_SIZE = 32, HASH_TEXT = 48 };

const SheetPart SHEET_CITE = {"cite", "How to cite", NULL};

static const char PAPER[] =
    "M. Otsuki and H. Matsukawa, <cite>Systematic breakdown of Amontons\u2019 law of friction for "
    "an elastic object locally obeying Amontons\u2019 law</cite>, Scientific Reports 3, 1586 "
    "(2013), <a href='https://doi.org/10.1038/srep01586'>doi:10.1038/srep01586</a>";

void sheet_begin(TextWriter *html, const char *title, const char *kind, const SheetPart *parts)
{
    char style[HASH_TEXT], script[HASH_TEXT];
    html_base64(page_css_sha256, HASH_SIZE, style);
    html_base64(page_js_sha256, HASH_SIZE, script);
    html_markup(html, "<!DOCTYPE html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n");
    html_markup(html,
                "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'; img-src "
                "data:; style-src 'sha256-%s'; script-src 'sha256-%s'; base-uri "
                "'none'; form-action 'none'\">\n",
                style, script);
    html_markup(html, "<meta name='viewport' content='width=device-width, initial-scale=1'>\n"
                      "<meta name='color-scheme' content='light dark'>\n"
                      "<meta name='generator' content='amontons " AMONTONS_VERSION "'>\n<title>");
    html_text(html, title);
    html_markup(html, "</title>\n<style>");
    html_raw(html, page_css);
    html_markup(html, "</style>\n</head>\n<body>\n"
                      "<a class='skip' href='#main'>Skip to the results</a>\n<header>\n<h1>");
    html_text(html, title);
    html_markup(html, "</h1>\n<p class='kind'>%s</p>\n<nav aria-label='Parts of this page'><ul>",
                kind);
    for (const SheetPart *part = parts; part->id; ++part)
        html_markup(html, "<li><a href='#%s'>%s</a></li>", part->id, part->name);
    html_markup(html, "</ul></nav>\n</header>\n<main id='main' tabindex='-1'>\n<section>\n");
}

bool sheet_parts(TextWriter *html, const SheetPart *parts, PageSource *source, Error *err)
{
    for (const SheetPart *part = parts; part->id; ++part) {
        if (!part->write) continue;
        html_markup(html, "</section>\n<section id='%s'>\n<h2>%s</h2>\n", part->id, part->name);
        if (!part->write(html, source, err)) return false;
    }
    return true;
}

void sheet_end(TextWriter *html, const char *json)
{
    char made_by[40] = "";
    if (json) json_find_text(json, "version", made_by, sizeof made_by);
    html_markup(html, "</section>\n</main>\n<footer>\n<h2 id='cite'>How to cite</h2>\n<p>The "
                      "program: amontons ");
    html_text(html, *made_by ? made_by : AMONTONS_VERSION);
    html_markup(html,
                ". The model: %s.</p>\n<p>This page was written by amontons %s; it needs no "
                "network.</p>\n</footer>\n<script>",
                PAPER, AMONTONS_VERSION);
    html_raw(html, page_js);
    html_markup(html, "</script>\n</body>\n</html>\n");
}

void sheet_box(TextWriter *html, const char *kind, const char *words)
{
    html_markup(html, "<p class='box %s'><strong>%s:</strong> ", kind,
                strcmp(kind, "warning") == 0 ? "Warning" : "Not complete");
    html_text(html, words);
    html_markup(html, "</p>\n");
}
