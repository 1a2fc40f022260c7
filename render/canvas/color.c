// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/canvas/color.h"

#include <math.h>
#include <stdio.h>

static const double DARK_PAPER = 0.10, DARK_INK = 0.966;   // sRGB of what was white, and black

// Red, green, blue of each entry. A smooth path in CIELAB (CIE 15:2004, white D65), walked at
// constant speed through (lightness, chroma, hue) = (96, 20, 97), (80, 56, 76), (63, 72, 51),
// (46, 66, 24), (29, 52, 352), (14, 36, 310): lightness falls in nearly equal steps while the hue
// goes from yellowish white through red to violet, with as much chroma as sRGB holds there.
static const char MAP[6 * MAP_SIZE + 1] =
    "fef4cdfef3cbfff1c9fff0c7ffefc5ffeec3ffedc1ffecbfffebbdffeabbffe9b9ffe8b7ffe7b4ffe7b3ffe6b0"
    "ffe5aeffe4acffe3aaffe2a8ffe1a6ffe0a4ffdfa2ffdea0ffdd9effdc9cffdb9affda98ffd996ffd894fed892"
    "fed790fed68efed58cfed48afed388fed286fed184fdd082fdcf80fdce7efdcc7cfdcb7afdca78fcc976fcc874"
    "fcc772fcc670fcc56efcc36cfbc26afbc168fbc066fbbe64fbbd62fabc60faba5efab95dfab75bfab659fab558"
    "fab356fab255f9b054f9af52f9ae51f9ac50f9ab4ef9a94df9a84cf9a74bf9a54af9a448f9a247f9a146f9a045"
    "f99e44f99d43f99b43f99a42f99941f99740f9963ff9943ef9933ef9913df8903cf88e3cf88d3bf88b3af88a3a"
    "f88839f88739f78538f78438f78237f78137f67f36f67e36f67c35f57a35f57935f47735f47634f37434f27234"
    "f27134f16f34f16e34f06c34ef6a34ef6934ee6734ed6634ed6534ec6335eb6235eb6035ea5f36e95d36e95c36"
    "e85b37e75937e75837e65738e55538e45439e45339e3513ae2503ae14f3ae14e3be04c3bdf4b3cde4a3cdd483d"
    "dc473ddc463ddb453eda433ed9423fd8413fd74040d63e40d53d40d43c41d33b41d23942d13842d03742cf3643"
    "ce3443cd3343cc3244cb3144ca2f44c82e44c72d45c62c45c52b45c42a46c22846c12746c02647bf2547bd2447"
    "bc2348bb2248ba2148b82048b71f49b61e49b51e49b31d4ab21c4ab11b4aaf1a4bae194bad194bac184caa174c"
    "a9164ca8164ca6154da5144da3144da2134ea1134e9f124e9e114e9d114e9b104f9a104f98104f970f4f950f50"
    "940e50920e50910e508f0e508e0d508c0d518b0d51890d51880d51860d51840d51830d51810d51800d517e0d51"
    "7c0e517b0e51790e51770e51760f51740f517210517110516f10506d11506c11506a1250681250671250651350"
    "63135062134f60144f5e144f5c144f5b154f59154f57154e56164e54164e52164e51164e4f174e4d174d4b174d"
    "4a174d48174d46174d44184d43184c41184c3f184c3d184c3b184c39184c37184b36184b34184b32184b30184b"
    "2e184b";

void color_map_fill(uint8_t *colors)
{
    for (int32_t k = 0; k < 3 * MAP_SIZE; ++k) sscanf(MAP + 2 * k, "%2hhx", &colors[k]);
}

// Inverted, then turned by half a circle of hue about the grey axis, by which luma stays.
Color color_on_dark(Color color)
{
    double luma = 0.2126 * (double)color.red + 0.7152 * (double)color.green +
                  0.0722 * (double)color.blue;
    double turned[3] = {(double)color.red, (double)color.green, (double)color.blue};
    for (int32_t k = 0; k < 3; ++k)
        turned[k] =
            fmin(fmax(DARK_PAPER + (DARK_INK - DARK_PAPER) * (1 - 2 * luma + turned[k]), 0), 1);
    return (Color){(float)turned[0], (float)turned[1], (float)turned[2], color.alpha};
}
