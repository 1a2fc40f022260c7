// SPDX-License-Identifier: GPL-2.0-or-later
// Nodes and their images, by hand: those a little apart are put in the middle, one without an image
// leaves all as it was.
#include "reduction/mirror.h"

#include "base/memory.h"

#include "near.h"

enum { NODES = 7 };
static const double APART = 3e-9;   // of a length of 1

// Three rows about x = 1.5, unordered; the last node stands in the middle.
static const double PLACES[2 * NODES] = {1, 0, 2, 0.5, 2, 0, 1, 0.5, 1.25, 1, 1.75, 1, 1.5, 0.25};
static const int32_t IMAGES[NODES] = {2, 3, 0, 1, 5, 4, 6};

TEST(test_images)
{
    Error err = {0};
    double places[2 * NODES];
    int32_t *image;
    memcpy(places, PLACES, sizeof places);
    places[0] += 0.5 * APART;   // the least x: the middle moves with it
    places[7] -= 0.75 * APART;
    places[12] += 0.25 * APART;
    assert_true(mirror_nodes_find(2, 0, places, NODES, &image, &err));
    assert_non_null(image);
    assert_memory_equal(image, IMAGES, sizeof IMAGES);
    double sum = places[0] + places[4];
    for (int32_t i = 0; i < NODES; i++) {
        assert_true(places[2 * i] + places[2 * image[i]] == sum);
        assert_true(places[2 * i + 1] == places[2 * image[i] + 1]);
        assert_near("x", places[2 * i], PLACES[2 * i], APART);
        assert_near("z", places[2 * i + 1], PLACES[2 * i + 1], APART);
    }
    memory_free(image);
}

TEST(test_one_has_none)
{
    Error err = {0};
    for (int32_t moved = 0; moved < 2 * NODES; moved++) {
        double places[2 * NODES], before[2 * NODES];
        int32_t *image;
        if (moved == 13) continue;   // the middle node may stand anywhere on its line
        memcpy(places, PLACES, sizeof places);
        places[moved] += 0.05;
        memcpy(before, places, sizeof places);
        assert_true(mirror_nodes_find(2, 0, places, NODES, &image, &err));
        assert_null(image);
        assert_memory_equal(places, before, sizeof places);
    }
}
