// SPDX-License-Identifier: GPL-2.0-or-later
// The program's commands in one file with the library, whose functions are replaced here.
#include "cli/commands.h"

#include <stdlib.h>

int main(int argc, char **argv)
{
    setenv("AMONTONS_APART", "yes", 0);   // as cli/main.c has it
    return amontons_command(argc, argv);
}
