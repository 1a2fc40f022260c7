#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# man_pages.sh PROGRAM HELP2MAN VERSION FOLDER (whole paths): amontons.1, and amontons-COMMAND.1 of each command that it lists.
set -eu
program=$1 help2man=$2 version=$3 folder=$4
mkdir -p "$folder"
commands=$("$program" --help | sed -n 's/^  \([a-z0-9]*\)  .*/\1/p')
make_page() {   # name, one sentence, the words that are the command
    page=$folder/$1.1 name=$1 sentence=$2
    shift 2
    # help2man knows "Usage:" by its capital.
    printf '#!/bin/sh\n"%s" %s "$@" | sed "s/^usage:/Usage:/"\n' "$program" "$*" >"$folder/$name"
    chmod +x "$folder/$name"
    # help2man calls it without quotes: a name alone, as the folder may have a space.
    cd "$folder"
    "$help2man" --no-info --no-discard-stderr --version-string="$version" --name="$sentence" \
        --source="amontons $version" --manual='User Commands' "./$name" >"$page"
    rm "$folder/$name"
}
for command in $commands; do
    sentence=$("$program" --help | sed -n "s/^  $command   *\([A-Z]* \)\? *//p")
    make_page "amontons-$command" "$sentence" "$command"
done
make_page amontons 'when and how an elastic block starts to slide'
