// SPDX-License-Identifier: GPL-2.0-or-later
// Polynomials through designs, their least misfit and its curvature, against results that are
// polynomials themselves, worked out by hand.
#include "study/search/response.h"

#include "near.h"

enum { DESIGNS = 30, DATA = 3 };

// Results of two keys. The last one is measured where its design (0.4, 0.7) is.
static double result(int32_t datum, double x, double y)
{
    return datum == 0 ? 1 + 2 * x : datum == 1 ? 2 - y + 0.5 * x * y : x * x + 3 * y;
}

typedef struct Data {
    ResponseDesign designs[DESIGNS];
    double found[DATA * DESIGNS], own[DATA * DESIGNS];
    Datum measured[DATA];
} Data;

static ResponseDef make_data(Data *data, int32_t designs)
{
    *data = (Data){.measured = {{.error = 0.01}, {.error = 0.02}, {.error = 0.05}}};
    for (int32_t k = 0; k < DATA; k++) data->measured[k].value = result(k, 0.4, 0.7);
    for (int32_t d = 0; d < designs; d++) {
        ResponseDesign *design = &data->designs[d];
        design->place[0] = fmod(0.37 * d, 1);
        design->place[1] = fmod(0.61 * d, 1);
        design->found = &data->found[DATA * d];
        design->own = &data->own[DATA * d];
        for (int32_t k = 0; k < DATA; k++) {
            double found = result(k, design->place[0], design->place[1]);
            data->found[DATA * d + k] = found;
            design->misfit += pow((found - data->measured[k].value) / data->measured[k].error, 2);
        }
    }
    return (ResponseDef){2, designs, DATA, data->designs, data->measured, 20, 0, NULL};
}

TEST(test_second_order)
{
    Data data;
    Response response;
    Error err = {0};
    ResponseDef def = make_data(&data, DESIGNS);
    double place[2] = {0.9, 0.1}, curvature[4];
    if (!response_make(&def, &response, &err)) fail_msg("%s", err.message);
    assert_near("between designs", response_at(&response, 2, (double[]){0.33, 0.21}),
                result(2, 0.33, 0.21), 1e-6);
    assert_near("no scatter", response.own[1], 0, 1e-6);
    assert_near("least", response_least(&response, NULL, place), 0, 1e-6);
    assert_near("x", place[0], 0.4, 1e-4);
    assert_near("y", place[1], 0.7, 1e-4);
    response_curvature(&response, (double[]){0.4, 0.7}, curvature);
    // slopes there: (2, 0), (0.35, -0.8), (0.8, 3)
    assert_near("xx", curvature[0], 4e4 + 0.1225 / 4e-4 + 0.64 / 25e-4, 1);
    assert_near("xy", curvature[1], -0.28 / 4e-4 + 2.4 / 25e-4, 1);
    assert_near("yy", curvature[3], 0.64 / 4e-4 + 9 / 25e-4, 1);
    response_destroy(&response);
}

// Along x = 0.5 the least misfit is a line's; beyond the range of y it stays at its end.
TEST(test_profile)
{
    Data data;
    Response response;
    Error err = {0};
    ResponseDef def = make_data(&data, DESIGNS);
    const bool fixed[] = {true, false};
    double place[2] = {0.5, 0.5}, least = INFINITY;
    assert_true(response_make(&def, &response, &err));
    double misfit = response_least(&response, fixed, place);
    assert_near("held", place[0], 0.5, 0);
    for (int32_t k = 0; k <= 20000; k++) {
        double sum = 0, y = k / 20000.0;
        for (int32_t i = 0; i < DATA; i++)
            sum += pow((result(i, 0.5, y) - data.measured[i].value) / data.measured[i].error, 2);
        least = fmin(least, sum);
    }
    assert_near("profile", misfit, least, 1e-3);
    response_destroy(&response);
    for (int32_t k = 0; k < DATA; k++) data.measured[k].value = result(k, 0.4, 1.6);
    assert_true(response_make(&def, &response, &err));
    response_least(&response, NULL, place);
    assert_near("end of the range", place[1], 1, 0);
    response_destroy(&response);
}

// Runs that scatter by 0.05 are smoothed, which is told; with few designs the order falls.
TEST(test_scatter_and_order)
{
    Data data;
    Response response;
    Error err = {0};
    ResponseDef def = make_data(&data, DESIGNS);
    for (int32_t d = 0; d < DESIGNS; d++) {
        data.found[DATA * d] += d % 2 ? 0.05 : -0.05;
        data.designs[d].misfit = 1;
    }
    assert_true(response_make(&def, &response, &err));
    assert_near("smoothed", response_at(&response, 0, (double[]){0.5, 0.5}), 2, 0.03);
    assert_near("scatter", response.own[0], 0.05, 0.012);
    response_destroy(&response);
    static const struct {
        int32_t designs, terms;
    } few[] = {{9, 6}, {8, 5}, {7, 3}, {4, 3}};
    for (size_t k = 0; k < sizeof few / sizeof few[0]; k++) {
        def = make_data(&data, few[k].designs);
        assert_true(response_make(&def, &response, &err));
        assert_int_equal(response.terms, few[k].terms);
        response_destroy(&response);
    }
    def = make_data(&data, 3);
    assert_false(response_make(&def, &response, &err));
    assert_non_null(strstr(err.message, "only 3 designs"));
    response_destroy(&response);
}
