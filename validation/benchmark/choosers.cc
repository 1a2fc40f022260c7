// SPDX-License-Identifier: GPL-2.0-or-later
// Which library's search is best for `amontons optimise`? On a function of four keys in the manner of mu_hold of pads (number,
// part in contact, height, height of the rod; ridges, ripples, 1 % of noise that is the same for the same design), how far the
// true value at the best design found is below the optimum, by designs tried. Forty seeds each. Built and run by hand:
//
//     apt-get install libdlib-dev libnlopt-dev
//     g++ -O1 validation/benchmark/choosers.cc -ldlib -lnlopt -o /tmp/choosers && /tmp/choosers
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <dlib/global_optimization/global_function_search.h>
#include <nlopt.h>
#include <random>
#include <vector>

namespace
{

constexpr int designs = 120, seeds = 40, keys = 4;
const double least[keys] = {1, 0.3, -2, 0.1}, most[keys] = {12, 0.9, -0.7, 0.9};   // the height as its logarithm
unsigned seed;
double best_seen, best_true;
std::vector<double> course;   // true value at the best so far

double truth(const double *x)
{
    const double n = std::round(x[0]), fill = x[1], height = std::pow(10, x[2]), rod = x[3], pad = std::log(fill / n / 0.07);
    return 0.25 + 0.06 * std::exp(-pad * pad / 0.8) * (1 - std::exp(-height / 0.03)) +
           0.03 * std::exp(-std::pow((rod - 0.35) / 0.2, 2)) - 0.02 * std::pow((fill - 0.62) / 0.3, 2) -
           0.03 * std::max(0.0, height * n - 0.5) + 0.004 * std::sin(9 * n) * std::sin(20 * fill);
}

double look(const double *x)
{
    std::seed_seq same{unsigned(std::round(x[0])), unsigned(x[1] * 1e6), unsigned((x[2] + 3) * 1e6), unsigned(x[3] * 1e6), seed};
    std::mt19937 generator(same);
    const double seen = truth(x) + std::normal_distribution<>(0, 0.0025)(generator);
    if (seen > best_seen) best_seen = seen, best_true = truth(x);
    course.push_back(best_true);
    return seen;
}

void by_dlib(double noise)
{
    dlib::matrix<double, 0, 1> low(keys), high(keys);
    for (int k = 0; k < keys; k++) low(k) = least[k], high(k) = most[k];
    dlib::global_function_search search(dlib::function_spec(low, high, {true, false, false, false}));
    search.set_seed(seed);
    search.set_relative_noise_magnitude(noise);
    for (int k = 0; k < designs; k++) {
        auto request = search.get_next_x();
        request.set(look(&request.x()(0)));
    }
}

void random_point(double *x)
{
    static std::mt19937 generator;
    for (int k = 0; k < keys; k++) x[k] = std::uniform_real_distribution<>(least[k], most[k])(generator);
}

void by_nlopt(nlopt_algorithm algorithm)
{
    nlopt_opt search = nlopt_create(algorithm, keys);
    double x[keys], value;
    random_point(x);
    nlopt_srand(seed + 1);
    nlopt_set_lower_bounds(search, least);
    nlopt_set_upper_bounds(search, most);
    nlopt_set_max_objective(search, [](unsigned, const double *at, double *, void *) { return look(at); }, nullptr);
    nlopt_set_maxeval(search, designs);
    nlopt_optimize(search, x, &value);
    nlopt_destroy(search);
}

double optimum()
{
    double top = 0, x[keys];
    for (x[0] = 1; x[0] <= 12; x[0]++)
        for (x[1] = 0.3; x[1] <= 0.9; x[1] += 0.01)
            for (x[2] = -2; x[2] <= -0.7; x[2] += 0.02)
                for (x[3] = 0.1; x[3] <= 0.9; x[3] += 0.02) top = std::max(top, truth(x));
    return top;
}

template <typename Search> void tell(const char *name, double top, const Search &run)
{
    const int after[] = {30, 60, 120};
    std::vector<double> below[3];
    for (seed = 0; seed < seeds; seed++) {
        best_seen = -1;
        course.clear();
        run();
        course.resize(designs, course.back());
        for (int k = 0; k < 3; k++) below[k].push_back(100 * (1 - course[after[k] - 1] / top));
    }
    std::printf("%-18s", name);
    for (auto &found : below) {
        std::sort(found.begin(), found.end());
        std::printf("  %.2f (at most %.2f)", (found[19] + found[20]) / 2, found.back());
    }
    std::printf("\n");
}

}   // namespace

int main()
{
    const double top = optimum();
    std::printf("below the optimum, %%, after 30, 60 and 120 designs: median of forty seeds\n");
    tell("dlib", top, [] { by_dlib(0.05); });
    tell("dlib, noise 0.001", top, [] { by_dlib(0.001); });
    tell("dlib, noise 0.2", top, [] { by_dlib(0.2); });
    tell("NLopt CRS2", top, [] { by_nlopt(NLOPT_GN_CRS2_LM); });
    tell("NLopt DIRECT-L", top, [] { by_nlopt(NLOPT_GN_DIRECT_L_NOSCAL); });
    tell("NLopt ISRES", top, [] { by_nlopt(NLOPT_GN_ISRES); });
    tell("random", top, [] {
        double x[keys];
        for (int k = 0; k < designs; k++) random_point(x), look(x);
    });
}
