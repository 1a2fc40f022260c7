// SPDX-License-Identifier: GPL-2.0-or-later
// Pads in rows of quadrilaterals are what gmsh makes of the same script, to the bit and to the
// number, and refused where gmsh refuses them; what is not in rows is left to gmsh.
#include "plain_by_gmsh.h"
#include "random_numbers.h"

#include <math.h>

enum { PARAMETERS_MAX = 20, SETS = 200 };

static int begin(void **state)
{
    (void)state;
    return plain_begin("pads.geo");
}

// --- random sets --------------------------------------------------------------------------------

typedef struct Set {
    MeshParameter list[PARAMETERS_MAX];
    int32_t count;
} Set;

static void add(Set *set, const char *name, double value)
{
    MeshParameter *parameter = &set->list[set->count++];
    *parameter = (MeshParameter){.value = value};
    snprintf(parameter->name, sizeof parameter->name, "%s", name);
}

static void add_text(Set *set, const char *name, const char *text)
{
    add(set, name, 0);
    MeshParameter *parameter = &set->list[set->count - 1];
    snprintf(parameter->text, sizeof parameter->text, "%s", text);
}

static bool chance(Random *random, double share)
{
    return random_between(random, 0, 1) < share;
}

static void add_lengths(Random *random, Set *set, double scale, double pads)
{
    double length = scale * random_between(random, 0.5, 2),
           fill = random_between(random, 0.2, 1.02);
    add(set, "n", pads);
    add(set, "length", length);
    add(set, "fill", fill);
    add(set, "pad_height", scale * pow(10, random_between(random, -3, -0.7)));
    if (chance(random, 0.5))
        add(set, "height", scale * random_between(random, 0.1, 1));
    else
        add(set, "total_height", scale * random_between(random, 0.1, 1));
    if (chance(random, 0.2)) add(set, "contact_length", length * random_between(random, 0.2, 1.02));
    if (chance(random, 0.4)) add(set, "pad_ratio", random_between(random, 0.3, 3));
    if (chance(random, 0.3)) add(set, "gap", length / pads * random_between(random, 0, 0.5));
    if (chance(random, 0.5)) add_text(set, "ends", "open");
    if (chance(random, 0.5))
        add(set, "size_contact", length * fill / pads / random_between(random, 1.5, 8));
    if (chance(random, 0.5)) add(set, "size_bulk", scale * random_between(random, 0.03, 0.3));
}

static void make_set(Random *random, Set *set)
{
    double scale = chance(random, 0.4) ? 1 : pow(10, random_between(random, -3, 2));
    set->count = 0;
    add_lengths(random, set, scale, 1 + random_index(random, chance(random, 0.1) ? 30 : 6));
    if (chance(random, 0.3)) add_text(set, "layout", "regular");
    if (chance(random, 0.5)) add(set, "cells_pad", 1 + random_index(random, 9));
    if (chance(random, 0.5)) add(set, "cells_gap", 1 + random_index(random, 9));
    if (chance(random, 0.5)) add(set, "cells_pad_height", 1 + random_index(random, 5));
    if (chance(random, 0.5)) add(set, "nz", 1 + random_index(random, 30));
    if (chance(random, 0.4)) add(set, "grade_z", random_between(random, 0.2, 8));
    if (chance(random, 0.3)) add(set, "grade_contact", random_between(random, 1, 10));
    if (chance(random, 0.3)) add(set, "refine", random_between(random, 0.4, 2));
}

static void test_random(void **state)
{
    (void)state;
    Random random = {1};
    Set set;
    int32_t made = 0;
    for (int32_t k = 0; k < SETS; k++) {
        make_set(&random, &set);
        made += plain_is_gmshs(set.list, set.count);
    }
    print_message("%d of %d sets made, the others refused\n", made, SETS);
    assert_in_range(made, SETS / 2, SETS - 10);
}

// --- chosen sets --------------------------------------------------------------------------------

static int32_t count_of(const MeshParameter *list)
{
    int32_t count = 0;
    while (count < PARAMETERS_MAX && list[count].name[0]) count++;
    return count;
}

static void test_known_file(void **state)
{
    (void)state;
    plain_test_known();
}

// The design of validation/pads; as the defaults are; one pad, with and without free ends; cells by
// one; pads alone in a row of many; the shortest pad first, or last; two sizes alike, or so large
// that one cell is enough; a margin that only rounding makes; pads so small that gmsh finds their
// plane by other points, or by singular values; columns far from the origin for their width.
static void test_gmshs_own(void **state)
{
    (void)state;
    static const MeshParameter cases[][PARAMETERS_MAX] = {
        {NUMBER("n", 4), NUMBER("total_height", 0.5), NUMBER("pad_height", 0.05),
         NUMBER("fill", 0.6), TEXT("ends", "open"), NUMBER("size_contact", 0.0125),
         NUMBER("size_bulk", 0.05)},
        {NUMBER("fillet", 0), TEXT("shape", "quad"), NUMBER("order", 1), NUMBER("incomplete", 0)},
        {NUMBER("n", 1), NUMBER("fill", 1)},
        {NUMBER("n", 1), NUMBER("fill", 0.3), NUMBER("gap", 0.1)},
        {NUMBER("n", 2), NUMBER("cells_pad", 1), NUMBER("cells_gap", 1),
         NUMBER("cells_pad_height", 1), NUMBER("nz", 1), NUMBER("grade_z", 3),
         NUMBER("grade_contact", 3)},
        {NUMBER("n", 150), NUMBER("cells_pad", 2), NUMBER("cells_gap", 1), NUMBER("nz", 3)},
        {NUMBER("n", 5), NUMBER("pad_ratio", 4), TEXT("ends", "open")},
        {NUMBER("n", 5), NUMBER("pad_ratio", 0.25), NUMBER("gap", 0.07)},
        {NUMBER("size_contact", 0.05), NUMBER("size_bulk", 0.05)},
        {NUMBER("size_contact", 0.09), NUMBER("size_bulk", 7), NUMBER("height", 0.01)},
        {NUMBER("size_contact", 0.03), NUMBER("size_bulk", 0.001), NUMBER("height", 0.01)},
        {NUMBER("n", 3), NUMBER("contact_length", 0.7), NUMBER("gap", 0.15)},
        {NUMBER("n", 3), NUMBER("length", 0.013), NUMBER("height", 0.02),
         NUMBER("pad_height", 0.0007)},
        {NUMBER("n", 9), NUMBER("pad_height", 0.004), NUMBER("grade_contact", 20)},
        {NUMBER("n", 2), NUMBER("fill", 0.002), NUMBER("cells_gap", 3), NUMBER("gap", 1e-4)},
        {NUMBER("refine", 0.01)},
        {NUMBER("refine", 2), NUMBER("grade_contact", 1.5), NUMBER("size_contact", 0.02)}};
    assert_true(plain_is_gmshs(NULL, 0));
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
        assert_true(plain_is_gmshs(cases[k], count_of(cases[k])));
}

// What the .geo refuses: its own message is what the user reads.
static void test_refused(void **state)
{
    (void)state;
    static const MeshParameter cases[][2] = {{NUMBER("n", 0)},
                                             {NUMBER("n", 2.5)},
                                             {NUMBER("n", 10001)},
                                             {NUMBER("length", 0)},
                                             {NUMBER("height", -1), NUMBER("total_height", 1)},
                                             {NUMBER("pad_height", 0)},
                                             {NUMBER("total_height", 0.05)},
                                             {NUMBER("total_height", -1)},
                                             {NUMBER("fill", 0)},
                                             {NUMBER("fill", 1)},
                                             {NUMBER("fill", 1.01), NUMBER("n", 1)},
                                             {NUMBER("contact_length", -0.1)},
                                             {NUMBER("contact_length", 1)},
                                             {NUMBER("contact_length", 1.01), NUMBER("n", 1)},
                                             {NUMBER("pad_ratio", 0)},
                                             {NUMBER("gap", -0.1)},
                                             {NUMBER("gap", 0.21)},
                                             {NUMBER("size_contact", -1)},
                                             {NUMBER("size_contact", 0.11)},
                                             {NUMBER("size_bulk", -1)},
                                             {NUMBER("cells_pad", 0)},
                                             {NUMBER("cells_gap", 1.5)},
                                             {NUMBER("cells_pad_height", -2)},
                                             {NUMBER("nz", 0)},
                                             {NUMBER("grade_z", 0)},
                                             {NUMBER("grade_contact", 0.9)},
                                             {NUMBER("refine", 0)},
                                             {NUMBER("refine", 1e3)},
                                             {TEXT("ends", "shut")},
                                             {TEXT("layout", "rows")},
                                             {TEXT("shape", "hexagon")}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
        assert_false(plain_is_gmshs(cases[k], cases[k][1].name[0] ? 2 : 1));
}

// What gmsh alone can make.
static void test_left_to_gmsh(void **state)
{
    (void)state;
    static const MeshParameter other[] = {
        TEXT("shape", "triangle"), TEXT("layout", "free"),  NUMBER("order", 2),
        NUMBER("fillet", 0.01),    NUMBER("grade_z", 2000), NUMBER("grade_contact", 2000),
        NUMBER("pad_ratio", 1e13), NUMBER("length", 1e7),   NUMBER("pad_height", 1e-9),
        NUMBER("unknown", 1),      NUMBER("incomplete", 1)};
    MeshFile mesh;
    for (size_t k = 0; k < sizeof other / sizeof other[0]; k++)
        if (plain_make(ours, &other[k], 1, &mesh)) fail_msg("%s is made", other[k].name);
    assert_false(plain_make(gmshs, NULL, 0, &mesh));
}

static void test_without_memory(void **state)
{
    (void)state;
    static const MeshParameter pads[] = {NUMBER("n", 2), NUMBER("nz", 2)};
    plain_test_without_memory(pads, 2);
}

static void test_read_without_gmsh(void **state)
{
    (void)state;
    static const MeshParameter pads[] = {NUMBER("n", 2), NUMBER("nz", 2)};
    assert_int_equal(plain_read_alone(pads, 2), 2 * 8 * (3 + 2) + 6 * 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_file),    cmocka_unit_test(test_read_without_gmsh),
        cmocka_unit_test(test_gmshs_own),     cmocka_unit_test(test_random),
        cmocka_unit_test(test_refused),       cmocka_unit_test(test_left_to_gmsh),
        cmocka_unit_test(test_without_memory)};
    return cmocka_run_group_tests(tests, begin, plain_end);
}
