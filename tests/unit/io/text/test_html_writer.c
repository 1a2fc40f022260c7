// SPDX-License-Identifier: GPL-2.0-or-later
// Markup and text, read back from the file; Base64 by the vectors of RFC 4648.
#include "io/text/html_writer.h"

#include "base/memory.h"
#include "cases.h"
#include "io/files/text_file.h"

#include <math.h>
#include <string.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

static const char PATH[] = "html_writer_test.html";

// The text that `write` writes.
static char *written(void (*write)(TextWriter *html))
{
    Error err = {0};
    char *text = NULL;
    int32_t size = 0;
    TextWriter *html = text_writer_create(PATH, false, &err);
    assert_non_null(html);
    write(html);
    assert_int_not_equal(access(PATH, F_OK), 0);   // no half file under the final name
    assert_true(text_writer_finish(html, &err));
    assert_true(text_file_read(PATH, 1 << 24, &text, &size, &err));
    unlink(PATH);
    return text;
}

static void check(void (*write)(TextWriter *html), const char *expected)
{
    char *text = written(write);
    assert_string_equal(text, expected);
    memory_free(text);
}

static void write_texts(TextWriter *html)
{
    html_markup(html, "<b a='%d'>", 3);
    html_text(html, "</b> & \"x\" 'y' \u00b5");
    html_text(html, "\x01\xff\xc3(\x7f\t\n");   // control, no UTF-8, cut UTF-8
    html_raw(html, "</b>");
}

TEST(text_never_becomes_markup)
{
    check(write_texts, "<b a='3'>&lt;/b&gt; &amp; &quot;x&quot; &#39;y&#39; \u00b5"
                       "\uFFFD\uFFFD\uFFFD(\uFFFD\t\n</b>");
}

static void write_numbers(TextWriter *html)
{
    html_number(html, 0.32746, 3);
    html_raw(html, " ");
    html_number(html, -1.5e-7, 2);
    html_raw(html, " ");
    html_number(html, NAN, 2);
    html_raw(html, " ");
    html_number(html, 6400, 12);
}

TEST(numbers_are_for_people)
{
    check(write_numbers, "0.327 \u22121.5\u202f\u00d7\u202f10<sup>\u22127</sup> \u2013 6400");
}

TEST(base64_is_that_of_rfc_4648)
{
    static const char *const vectors[][2] = {{"", ""},
                                             {"f", "Zg=="},
                                             {"fo", "Zm8="},
                                             {"foo", "Zm9v"},
                                             {"foob", "Zm9vYg=="},
                                             {"fooba", "Zm9vYmE="},
                                             {"foobar", "Zm9vYmFy"}};
    char text[16];
    for (size_t k = 0; k < sizeof vectors / sizeof *vectors; ++k) {
        html_base64((const uint8_t *)vectors[k][0], (int64_t)strlen(vectors[k][0]), text);
        assert_string_equal(text, vectors[k][1]);
    }
    html_base64((const uint8_t *)"\xfb\xff\xfe", 3, text);
    assert_string_equal(text, "+//+");
}

// Longer than any buffer of the writer.
enum { LONG = 200000 };

static void write_data(TextWriter *html)
{
    Error err = {0};
    uint8_t *bytes = NEW_ARRAY(uint8_t, LONG, &err);
    html_data(html, "image/png", bytes, LONG);
    memory_free(bytes);
}

TEST(long_data_is_whole)
{
    char *text = written(write_data);
    const char *body = text + strlen("data:image/png;base64,");
    assert_int_equal(strlen(body), 4 * ((LONG + 2) / 3));
    assert_int_equal(strspn(body, "A"), strlen(body) - 1);   // 200000 = 3 n + 2: one = at the end
    assert_int_equal(body[strlen(body) - 1], '=');
    memory_free(text);
}

static void write_too_much(TextWriter *html)
{
    char words[3000];
    memset(words, 'x', sizeof words - 1);
    words[sizeof words - 1] = 0;
    html_markup(html, "%s", words);
}

TEST(a_failure_leaves_no_file)
{
    Error err = {0};
    struct rlimit before, small = {.rlim_cur = 1000};
    TextWriter *html = text_writer_create(PATH, false, &err);
    assert_non_null(html);
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    small.rlim_max = before.rlim_max;
    setrlimit(RLIMIT_FSIZE, &small);
    write_too_much(html);
    assert_false(text_writer_finish(html, &err));
    setrlimit(RLIMIT_FSIZE, &before);
    assert_int_equal(err.code, ERROR_FILE);
    assert_non_null(strstr(err.message, "File too large"));
    assert_int_not_equal(access(PATH, F_OK), 0);
}
