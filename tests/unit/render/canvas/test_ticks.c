// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/canvas/ticks.h"

#include "cases.h"

#include <float.h>
#include <math.h>
#include <string.h>

static void assert_labels(double low, double high, int32_t wanted, const char *expected)
{
    char all[400] = "", label[TICK_LABEL_SIZE];
    Ticks ticks = ticks_choose(low, high, wanted);
    for (int32_t k = 0; k < ticks.count; ++k) {
        tick_label(&ticks, k, label);
        strcat(strcat(all, label), " ");
    }
    assert_string_equal(all, expected);
}

TEST(labels_are_handy_numbers)
{
    assert_labels(0, 1, 5, "0.0 0.2 0.4 0.6 0.8 1.0 ");
    assert_labels(0, 0.31, 4, "0.0 0.1 0.2 0.3 ");
    assert_labels(-2.5, 2.5, 6, "\u22122 \u22121 0 1 2 ");
    assert_labels(0.24, 0.26, 5, "0.240 0.245 0.250 0.255 0.260 ");
    assert_labels(12, 47, 4, "20 30 40 ");
}

TEST(small_and_large_numbers_have_a_power)
{
    assert_int_equal(ticks_choose(0, 0.006, 6).exponent, -3);
    assert_labels(0, 0.006, 6, "0 1 2 3 4 5 6 ");
    assert_int_equal(ticks_choose(4.41e-3, 4.73e-3, 4).exponent, -3);
    assert_labels(4.41e-3, 4.73e-3, 4, "4.5 4.6 4.7 ");
    assert_int_equal(ticks_choose(0, 25000, 5).exponent, 4);
    assert_labels(0, 25000, 5, "0.0 0.5 1.0 1.5 2.0 2.5 ");
    assert_int_equal(ticks_choose(0, 9999, 5).exponent, 0);
    assert_int_equal(ticks_choose(0, 0.01, 5).exponent, 0);
}

static void assert_powers(double low, double high, int32_t wanted, const char *expected)
{
    char all[400] = "", label[TICK_LABEL_SIZE];
    Ticks ticks = ticks_choose_log(low, high, wanted);
    for (int32_t k = 0; k < ticks.count; ++k) {
        tick_label(&ticks, k, label);
        strcat(strcat(all, label), " ");
        assert_true(tick_value(&ticks, k) >= low * (1 - 1e-5));
        assert_true(tick_value(&ticks, k) <= high * (1 + 1e-5));
    }
    assert_string_equal(all, expected);
}

TEST(logarithmic_ticks_are_powers_of_ten)
{
    assert_powers(1e-3, 1e-1, 7, "10^{-3} 10^{-2} 10^{-1} ");
    assert_powers(8e-4, 1.3, 7, "10^{-3} 10^{-2} 10^{-1} 10^{0} ");
    assert_powers(1e-6, 1e6, 7, "10^{-6} 10^{-4} 10^{-2} 10^{0} 10^{2} 10^{4} 10^{6} ");
    assert_powers(2, 8, 7, "");
    assert_powers(0, 8, 7, "");
    assert_powers(10, 1, 7, "");
    assert_int_equal(ticks_choose_log(1e-3, 1e-1, 7).minor, 9);
    assert_int_equal(ticks_choose_log(1e-6, 1e6, 7).minor, 1);
    assert_true(tick_value(&(Ticks){.is_log = true, .first = -3, .step = 1}, 1) == 1e-2);
}

static void assert_thirds(double low, double high, const char *expected)
{
    char all[400] = "", label[TICK_LABEL_SIZE];
    Ticks ticks = ticks_choose_thirds(low, high);
    for (int32_t k = 0; k < ticks.count; ++k) {
        tick_label(&ticks, k, label);
        strcat(strcat(all, label), " ");
    }
    assert_string_equal(all, expected);
}

TEST(short_logarithmic_axes_have_one_two_five)
{
    assert_thirds(0.15, 4.8, "0.2 0.5 1 2 ");
    assert_thirds(0.2, 5, "0.2 0.5 1 2 5 ");
    assert_thirds(12, 60, "20 50 ");
    assert_thirds(1.5e-5, 2.5e-4, "2\u00d710^{-5} 5\u00d710^{-5} 1\u00d710^{-4} 2\u00d710^{-4} ");
    assert_thirds(2.5e-3, 2.5e-2, "0.005 0.01 0.02 ");   // one way to write all of an axis
    assert_thirds(3e3, 3e4, "5000 10000 20000 ");
    assert_thirds(1.5e-4, 2.5e-3, "2\u00d710^{-4} 5\u00d710^{-4} 1\u00d710^{-3} 2\u00d710^{-3} ");
    assert_thirds(3, 4, "");
    assert_thirds(0, 4, "");
    Ticks ticks = ticks_choose_thirds(0.15, 4.8);
    assert_float_equal(tick_value(&ticks, 3), 2, 1e-12);
    const double beyond[] = {0.09, 0.1, 0.2};   // about the first tick's power of ten, 0.1
    for (int32_t k = -1; k <= 1; ++k)
        assert_float_equal(ticks_minor_log(&ticks, k), beyond[k + 1], 1e-12);
    assert_float_equal(ticks_minor_log(&ticks, 10), 2, 1e-12);
    ticks = ticks_choose_log(1e-6, 1e6, 7);   // every second power: no minor ticks but these
    assert_float_equal(ticks_minor_log(&ticks, 2), 1e-2, 1e-14);
}

// Whatever the range: inside it, in equal steps of 1, 2 or 5, and neither too few nor too many.
TEST(any_range_gets_ticks)
{
    double low = -3.7e-5, size = 1.234e-6;
    for (int32_t trial = 0; trial < 2000; ++trial) {
        double high = low + size;
        int32_t wanted = 2 + trial % 6;
        Ticks ticks = ticks_choose(low, high, wanted);
        double mantissa = ticks.step / pow(10, floor(log10(ticks.step * 1.0000001)));
        assert_true(fabs(mantissa - 1) < 1e-6 || fabs(mantissa - 2) < 1e-6 ||
                    fabs(mantissa - 5) < 1e-6);
        assert_in_range(ticks.count, wanted / 2 > 2 ? 2 : 0, wanted + 1);
        for (int32_t k = 0; k < ticks.count; ++k) {
            assert_true(tick_value(&ticks, k) >= low - 1e-5 * ticks.step);
            assert_true(tick_value(&ticks, k) <= high + 1e-5 * ticks.step);
        }
        size *= 1.013;
        low = low * 1.007 + (trial % 13) * 1e-6;
    }
}

// Ticks of counted things: ranks 1 to 3 have a tick each and none between them, 0 to 20 whole ones.
TEST(whole_numbers_have_no_ticks_between)
{
    const double ends[][2] = {{0.8, 3.2}, {1, 2}, {0, 8.4}, {0, 20}, {0, 100}};
    for (size_t k = 0; k < sizeof ends / sizeof *ends; ++k) {
        Ticks ticks = ticks_choose(ends[k][0], ends[k][1], 6);
        ticks = ticks_whole(&ticks, ends[k][0], ends[k][1]);
        assert_true(ticks.count >= 2);
        double minor = ticks.step / ticks.minor;
        if (ticks.step != floor(ticks.step) || minor != floor(minor))
            fail_msg("%g to %g: step %g of %d", ends[k][0], ends[k][1], ticks.step, ticks.minor);
    }
}

// The largest and smallest numbers there are: every tick is a number within the range.
TEST(ends_of_all_numbers_get_ticks)
{
    const double ends[][2] = {{1e308, DBL_MAX},   {1e300, DBL_MAX}, {1.7e308, DBL_MAX},
                              {DBL_MIN, 1e-307},  {5e-324, 1e-320}, {5e-324, DBL_MAX},
                              {5e-324, 1.5e-323}, {0, 5e-324},      {-DBL_MAX, DBL_MAX}};
    for (size_t k = 0; k < sizeof ends / sizeof *ends; ++k) {
        double low = ends[k][0], high = ends[k][1];
        Ticks all[] = {ticks_choose_thirds(low, high), ticks_choose_log(low, high, 5),
                       ticks_choose(low, high, 5)};
        for (size_t i = 0; i < 3; ++i) {
            assert_in_range(all[i].count, 0, 2000);
            for (int32_t tick = 0; tick < all[i].count; ++tick)
                assert_true(isfinite(tick_value(&all[i], tick)));
        }
    }
    assert_int_equal(ticks_choose_thirds(1e308, DBL_MAX).count, 1);
}

TEST(no_range_no_ticks)
{
    assert_int_equal(ticks_choose(1, 1, 5).count, 0);
    assert_int_equal(ticks_choose(2, 1, 5).count, 0);
    assert_int_equal(ticks_choose(NAN, 1, 5).count, 0);
    assert_int_equal(ticks_choose(0, INFINITY, 5).count, 0);
    assert_int_equal(ticks_choose(0, 1, 0).count, 0);
    assert_int_equal(ticks_choose(1, 1 + 1e-14, 5).count, 0);
}
