// SPDX-License-Identifier: GPL-2.0-or-later
#include "record/window.h"

#include <math.h>

Window window_of(const WindowDef *def, const Events *events)
{
    return (Window){.def = *def, .events = events, .furthest = -INFINITY};
}

bool window_is_sought(const Window *window)
{
    return window->def.around > 0 || window->def.last > 0;
}

static bool record_inside(Window *window, const Observation *seen, Error *err)
{
    const WindowDef *def = &window->def;
    bool open = seen->U >= def->from_U && seen->U <= def->to_U && seen->t >= def->from_t &&
                seen->t <= def->to_t;
    if (window_is_sought(window))
        open = open && window->again && seen->t >= window->begin && seen->t <= window->end;
    if (!open) return true;
    window->steps++;
    return recorders_record(&window->inside, seen, err);
}

bool window_record(void *self, const Observation *seen, Error *err)
{
    Window *window = self;
    if (!record_inside(window, seen, err)) return false;
    if (seen->t > window->furthest && !recorders_record(&window->outside, seen, err)) return false;
    if (window->found) return true;

    // A sliding goes from the step before its rapid event to the one in which all is slow again.
    const Events *events = window->events;
    if (events->began) window->onset = window->before;
    window->before = seen->t;
    window->slides = window->slides || events->crossed;
    window->ended = window->slides && events->ended;
    if (!window->ended) return true;
    window->slides = false;
    window->slidings++;
    if (window->slidings != window->def.around) return true;
    window->found = true;
    window->begin = window->onset;
    window->end = seen->t;
    return true;
}

void window_close(Window *window, double begin)
{
    if (window->found) return;
    bool slides = window->slides && window->slidings + 1 == window->def.around;
    bool slid = window->def.last > 0 && window->slidings >= window->def.last;
    window->found = slides || slid;
    window->begin = slides ? window->onset : begin;
    window->end = INFINITY;
}

bool window_take_back(Window *window, const Observation *seen, Error *err)
{
    window->again = true;
    window->furthest = window->before;
    return record_inside(window, seen, err);
}

void window_archive(Window *window, Archive *archive)
{
    archive_section(archive, "window");
    archive_integer(archive, &window->steps);
    archive_integer(archive, &window->slidings);
    archive_flag(archive, &window->slides);
    archive_flag(archive, &window->ended);
    archive_numbers_of(archive, &window->before, &window->onset);
    archive_flag(archive, &window->found);
    archive_numbers_of(archive, &window->begin, &window->end);
    archive_flag(archive, &window->again);
    archive_number(archive, &window->furthest);
}
