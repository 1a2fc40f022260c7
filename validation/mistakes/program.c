// SPDX-License-Identifier: GPL-2.0-or-later
// The program's commands in one file with the library, whose functions are replaced here.
#include "cli/commands.h"

int main(int argc, char **argv)
{
    return amontons_command(argc, argv);
}
