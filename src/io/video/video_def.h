// SPDX-License-Identifier: GPL-2.0-or-later
// Definition of a film, for io/video/video_file and its module.
#ifndef AMONTONS_IO_VIDEO_VIDEO_DEF_H
#define AMONTONS_IO_VIDEO_VIDEO_DEF_H

#include <stdbool.h>
#include <stdint.h>

typedef struct VideoDef {
    const char *path;   // its ending says what it becomes: .mp4, .webm or .gif
    int32_t width, height;   // pixels, even
    int32_t rate;   // frames a second; of a GIF a divisor of 100
    const char *title;   // stored in the file; a GIF has none
    // A GIF's colours, [256 * 3] red, green, blue; the last one is kept for what does not change.
    // Others: not asked.
    const uint8_t *palette;
    bool overwrite;   // as io/files/part_file has it
} VideoDef;

#endif
