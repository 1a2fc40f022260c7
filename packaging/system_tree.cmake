# SPDX-License-Identifier: GPL-2.0-or-later
# What the tree of a distribution (prefix /usr) has otherwise; run at the end of an installation, for one package.
#   PACKAGE (name of the Debian package), SOURCE (this folder), VERSION, MAINTAINER, DATE
if(NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr")
    return()
endif()
set(root $ENV{DESTDIR}/usr)
# The loader looks into /usr/lib by itself.
file(GLOB_RECURSE linked ${root}/bin/amontons ${root}/lib/*.so*)
foreach(file IN LISTS linked)
    if(NOT IS_SYMLINK ${file})
        file(RPATH_REMOVE FILE ${file})
    endif()
endforeach()
file(GLOB_RECURSE advice ${root}/lib/amontons.pc)
if(advice)
    file(READ ${advice} text)
    string(REPLACE " -Wl,-rpath,\${libdir}" "" text "${text}")
    file(WRITE ${advice} "${text}")
endif()
file(GLOB pages ${root}/share/man/man1/amontons*.1)
if(pages)
    execute_process(COMMAND gzip -9nf ${pages} COMMAND_ERROR_IS_FATAL ANY)
endif()
# Every package has its licence and a changelog of the packaging.
set(documents ${root}/share/doc/${PACKAGE})
file(COPY ${SOURCE}/debian/copyright DESTINATION ${documents})
file(WRITE ${documents}/changelog "amontons (${VERSION}) unstable; urgency=medium\n\n  * See CHANGELOG.md.\n\n"
     " -- ${MAINTAINER}  ${DATE}\n")
execute_process(COMMAND gzip -9nf ${documents}/changelog COMMAND_ERROR_IS_FATAL ANY)
# Where lintian is overruled, with the reason.
set(overrides ${SOURCE}/debian/${PACKAGE}.lintian-overrides)
if(EXISTS ${overrides})
    file(COPY ${overrides} DESTINATION ${root}/share/lintian/overrides)
    file(RENAME ${root}/share/lintian/overrides/${PACKAGE}.lintian-overrides ${root}/share/lintian/overrides/${PACKAGE})
endif()
