// SPDX-License-Identifier: GPL-2.0-or-later
// Control characters in the words of others are shown, not obeyed; all else comes out as it
// is.
#include "cli/say.h"

#include "near.h"

static void assert_said(const char *wanted, const char *words)
{
    char *text = NULL;
    size_t size = 0;
    FILE *usual = stdout;
    stdout = open_memstream(&text, &size);
    int length = say("<%s>\n", words);
    fclose(stdout);
    stdout = usual;
    assert_int_equal(length, strlen(words) + 3);
    assert_string_equal(text, wanted);
    free(text);
}

TEST(test_others_words)
{
    assert_said("<Figure 1, 50 %\t\xC2\xB5m \xE6\x91\xA9 \xF0\x9F\x98\x80>\n",
                "Figure 1, 50 %\t\xC2\xB5m \xE6\x91\xA9 \xF0\x9F\x98\x80");
    assert_said("<a\\x1b[31m\\x07b\\x0d\\x7f>\n", "a\033[31m\ab\r\x7F");
    assert_said("<\\xc2\\x9b31m>\n", "\xC2\x9B"
                                     "31m");   // CSI in one character
    assert_said("<\\x9b\\xe9\\xff\\xc3>\n", "\x9B\xE9\xFF\xC3");   // no UTF-8
    assert_said("<\\xe2\\x80\\xaeexe\\xe2\\x81\\xa7>\n", "\xE2\x80\xAE"
                                                         "exe\xE2\x81\xA7");
    assert_said("<\\xc0\\x9b\\xe0\\x82\\x9b>\n", "\xC0\x9B\xE0\x82\x9B");   // overlong
}

// The line that stands is left and cleared; its own control characters are ours.
TEST(test_over)
{
    char *text = NULL;
    size_t size = 0;
    FILE *usual = stderr;
    stderr = open_memstream(&text, &size);
    tell_over("33 %\033 and more", 6);
    tell_over("", 0);
    tell("%s\n", "e\033");
    fclose(stderr);
    stderr = usual;
    assert_string_equal(text, "\r33 %\\x1b \033[K\r\033[Ke\\x1b\n");
    free(text);
}
