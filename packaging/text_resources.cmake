# SPDX-License-Identifier: GPL-2.0-or-later
# cmake -D OUTPUT=... -D FILES=a.txt;b.txt -P: writes each text into the header OUTPUT as an array of characters. A line
# `[options]` between empty ones becomes a vertical tab, where argp puts the list of options; the last line end goes.
set(text "// Made from src/cli/help/.\n")
string(HEX "\n\n[options]\n\n" mark)
foreach(file ${FILES})
    get_filename_component(name ${file} NAME)
    string(REPLACE "." "_" name ${name})
    file(READ ${file} bytes HEX)
    string(REGEX REPLACE "0a$" "" bytes "${bytes}")
    string(REPLACE "${mark}" "0b" bytes "${bytes}")
    string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
    string(APPEND text "static const char ${name}[] = {${bytes}0};\n")
endforeach()
file(WRITE ${OUTPUT} "${text}")
