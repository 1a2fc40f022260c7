// SPDX-License-Identifier: GPL-2.0-or-later
#include "record/window.h"

bool window_record(void *self, const Observation *seen, Error *err)
{
    Window *window = self;
    const WindowDef *def = &window->def;
    bool open = seen->U >= def->from_U && seen->U <= def->to_U && seen->t >= def->from_t &&
                seen->t <= def->to_t;
    if (!open) return true;
    window->steps++;
    return recorders_record(&window->inside, seen, err);
}

void window_archive(Window *window, Archive *archive)
{
    archive_section(archive, "window");
    archive_integer(archive, &window->steps);
}
