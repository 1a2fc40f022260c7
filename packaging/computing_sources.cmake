# SPDX-License-Identifier: GPL-2.0-or-later
# cmake -D SOURCE=... -D HEADER=... -D FILES=a;b -D WORDS=... -P: writes HEADER, with a hash over the names (below SOURCE)
# and bytes of FILES, and over WORDS. The same in every folder, with git or without, in whatever order FILES come.
list(SORT FILES)
set(all "${WORDS}\n")
foreach(file ${FILES})
    file(RELATIVE_PATH name ${SOURCE} ${file})
    file(SHA256 ${file} hash)
    string(APPEND all "${name} ${hash}\n")
endforeach()
string(SHA256 hash "${all}")
file(WRITE ${HEADER} "#define COMPUTING_SOURCES \"${hash}\"\n")
