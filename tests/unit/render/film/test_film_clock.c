// SPDX-License-Identifier: GPL-2.0-or-later
// From the time of a film to that of the run: closed forms of runs that are slow, or rapid for one
// unit of time between two slow parts.
#include "render/film/film_clock.h"

#include "near.h"

enum { ROWS = 6, FRAMES = 201 };

static const double JUMP = 1e-7;   // time: two steps so near to each other are a jump

// 49.5 of slow slip, 1 at `fastest` times the rod's velocity V = 1, 49.5 of slow slip.
static FilmClockDef rapid_between(double t[ROWS], double fastest[ROWS], double times_V)
{
    const double when[ROWS] = {0, 49.5, 49.5 + JUMP, 50.5, 50.5 + JUMP, 100};
    for (int32_t k = 0; k < ROWS; ++k) {
        t[k] = when[k];
        fastest[k] = k == 2 || k == 3 ? times_V : 1;
    }
    return (FilmClockDef){.rows = ROWS,
                          .t = t,
                          .fastest = fastest,
                          .V = 1,
                          .low = 0,
                          .high = 100,
                          .frames = FRAMES,
                          .rate = 20};
}

static void check_rises(const FilmClock *clock, double low, double high)
{
    assert_near("first", clock->t[0], low, 1e-12);
    assert_near("last", clock->t[clock->frames - 1], high, 1e-12);
    for (int32_t k = 1; k < clock->frames; ++k) assert_true(clock->t[k] > clock->t[k - 1]);
}

TEST(test_slow_is_even)
{
    double t[ROWS], fastest[ROWS];
    Error err = {0};
    FilmClock clock;
    FilmClockDef def = rapid_between(t, fastest, 1.9);   // not rapid
    assert_true(film_clock_create(&def, &clock, &err));
    check_rises(&clock, 0, 100);
    for (int32_t k = 0; k < FRAMES; ++k) {
        assert_near("t", clock.t[k], 0.5 * k, 1e-9);
        assert_near("speed", clock.speed[k], 10, 1e-9);   // 100 in 10 s
    }
    film_clock_destroy(&clock);
}

// 1 x g^p = 1 + 2 x 49.5: half of 10 s, and 1/101 of the speed, whatever g.
TEST(test_rapid_takes_half)
{
    double t[ROWS], fastest[ROWS];
    const double faster[] = {40, 200, 1e6};
    for (int32_t i = 0; i < 3; ++i) {
        Error err = {0};
        FilmClock clock;
        FilmClockDef def = rapid_between(t, fastest, faster[i]);
        assert_true(film_clock_create(&def, &clock, &err));
        check_rises(&clock, 0, 100);
        assert_near("seconds", film_clock_seconds(&clock, 49.5), 10 * 49.5 / 200, 0.1);
        assert_near("seconds", film_clock_seconds(&clock, 50.5), 10 * (49.5 + 101) / 200, 0.1);
        assert_near("seconds", film_clock_seconds(&clock, 50), 5, 0.1);
        assert_near("speed", clock.speed[20], 20, 0.3);
        assert_near("speed", clock.speed[FRAMES / 2], 20 / 101.0, 0.004);
        film_clock_destroy(&clock);
    }
}

// At 4 V the speed-up is 2 and the power 2 at most: 1 x 2^2 + 99 of time is all there is.
TEST(test_power_is_bounded)
{
    double t[ROWS], fastest[ROWS];
    Error err = {0};
    FilmClock clock;
    FilmClockDef def = rapid_between(t, fastest, 4);
    assert_true(film_clock_create(&def, &clock, &err));
    assert_near("speed", clock.speed[20] / clock.speed[FRAMES / 2], 4, 1e-6);
    assert_near("speed", clock.speed[20], 10.3, 0.05);
    film_clock_destroy(&clock);
}

TEST(test_part_of_a_run)
{
    double t[ROWS], fastest[ROWS];
    Error err = {0};
    FilmClock clock;
    FilmClockDef def = rapid_between(t, fastest, 200);
    def.low = 10;
    def.high = 49;
    assert_true(film_clock_create(&def, &clock, &err));
    check_rises(&clock, 10, 49);
    assert_near("speed", clock.speed[0], 3.9, 1e-6);
    film_clock_destroy(&clock);
    def.low = def.high;
    assert_false(film_clock_create(&def, &clock, &err));
    assert_int_equal(err.code, ERROR_INPUT);
}
