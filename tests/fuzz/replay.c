// SPDX-License-Identifier: GPL-2.0-or-later
// Runs a target on files: the corpus, or what made it crash.
#include "tests/fuzz/fuzz.h"

enum { SIZE_MAX_READ = 1 << 20 };

int main(int argc, char **argv)
{
    uint8_t *data = malloc(SIZE_MAX_READ);
    for (int k = 1; data && k < argc; k++) {
        FILE *file = fopen(argv[k], "rb");
        if (!file) return 1;
        size_t size = fread(data, 1, SIZE_MAX_READ, file);
        fclose(file);
        LLVMFuzzerTestOneInput(data, size);
    }
    printf("%d inputs\n", argc - 1);
    free(data);
    return argc > 1 ? 0 : 1;
}
