# SPDX-License-Identifier: GPL-2.0-or-later
# cmake -D SOURCE=... -D RECORD=... -D LIBRARIES=... -P: writes the header RECORD, with the revision of SOURCE where
# that is a checkout of its own (an archive has none, and a folder inside of another checkout is not asked).
set(revision "")
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)
    execute_process(COMMAND ${GIT} -C ${SOURCE} rev-parse --short=10 HEAD OUTPUT_VARIABLE revision
                    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    execute_process(COMMAND ${GIT} -C ${SOURCE} --no-optional-locks status --porcelain --untracked-files=no
                    OUTPUT_VARIABLE changes ERROR_QUIET)
    if(revision AND changes)
        string(APPEND revision ", changed")
    endif()
endif()
set(text "#define BUILD_REVISION \"${revision}\"\n#define BUILD_LIBRARIES \"${LIBRARIES}\"\n")
set(before "")
if(EXISTS ${RECORD})
    file(READ ${RECORD} before)
endif()
if(NOT text STREQUAL before)
    file(WRITE ${RECORD} "${text}")
endif()
