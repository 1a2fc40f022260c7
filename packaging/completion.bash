# SPDX-License-Identifier: GPL-2.0-or-later
# Completion for amontons in bash. Commands, options and keys are asked of the program itself.
_amontons_words() {   # what a help text lists: commands, or the options of $1
    if (($#)); then
        amontons "$1" --help 2>/dev/null | grep -oE -e '--[a-z]+=?'
    else
        amontons --help 2>/dev/null | sed -n 's/^  \([a-z0-9]*\)  .*/\1/p'
        echo help --help --version
    fi
}

_amontons() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]} keys
    COMPREPLY=()
    compopt +o nospace 2>/dev/null
    if ((COMP_CWORD == 1)) || [[ $command == help ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_amontons_words)" -- "$word")
    elif [[ $before == --set ]]; then
        # A `=` ends the word for bash: the value is the user's to write.
        keys=$(amontons info keys 2>/dev/null | grep -oE '^. .[a-z_0-9]+\.[A-Za-z_0-9.]+' | cut -c 4-)
        mapfile -t COMPREPLY < <(compgen -S = -W "$keys" -- "$word")
        compopt -o nospace 2>/dev/null
    elif [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_amontons_words "$command")" -- "$word")
        [[ ${COMPREPLY[0]-} == *= ]] && compopt -o nospace 2>/dev/null
    elif [[ $before == -o || $before == --output ]]; then
        mapfile -t COMPREPLY < <(compgen -d -- "$word")
    else
        mapfile -t COMPREPLY < <(compgen -f -- "$word" | grep -E '\.(yaml|geo|msh)$'; compgen -d -- "$word")
    fi
}
complete -o filenames -F _amontons amontons
