# SPDX-License-Identifier: GPL-2.0-or-later
# cmake -D OUTPUT=... -D FILES=a;b -P: writes each file into the header OUTPUT as an array of bytes that ends with a
# zero, and its SHA-256.
set(text "// Made from src/page/.\n")
foreach(file ${FILES})
    get_filename_component(name ${file} NAME)
    string(REPLACE "." "_" name ${name})
    file(READ ${file} bytes HEX)
    file(SHA256 ${file} hash)
    foreach(part bytes hash)
        string(REGEX REPLACE "(..)" "0x\\1," ${part} "${${part}}")
    endforeach()
    string(APPEND text "static const char ${name}[] = {${bytes}0};\n"
                       "static const unsigned char ${name}_sha256[] = {${hash}};\n")
endforeach()
file(WRITE ${OUTPUT} "${text}")
