// SPDX-License-Identifier: GPL-2.0-or-later
// dlib's global_function_search behind four C functions, which catch every exception.
extern "C" {
#include "study/search/chooser.h"
}

#include <dlib/global_optimization/global_function_search.h>

#include <algorithm>
#include <exception>
#include <map>
#include <stdexcept>

namespace
{

using Vector = dlib::matrix<double, 0, 1>;

// Noise of a value over the differences between designs: error bars are some per cent of these.
// With 0.001 or 0.2 a search of 30 designs ends further from the best
// (validation/benchmark/choosers.cc).
constexpr double relative_noise = 0.05;

// dlib takes squares and slopes of values, and ends the process where one of them is no number.
constexpr double largest = 1e60;

double value_of(double value)
{
    if (value != value) throw std::invalid_argument("a design's value is no number");
    return std::clamp(value, -largest, largest);
}

Vector vector_of(const double *values, int32_t count)
{
    Vector x(count);
    for (int32_t k = 0; k < count; k++) x(k) = values[k];
    return x;
}

dlib::function_spec space_of(const ChooserSpace &space)
{
    return dlib::function_spec(vector_of(space.least, space.count),
                               vector_of(space.most, space.count),
                               std::vector<bool>(space.whole, space.whole + space.count));
}

std::vector<dlib::function_evaluation> known_of(const ChooserSpace &space)
{
    std::vector<dlib::function_evaluation> known;
    for (int32_t k = 0; k < space.known; k++)
        known.emplace_back(vector_of(&space.places[k * space.count], space.count),
                           value_of(space.values[k]));
    return known;
}

}   // namespace

struct Chooser {
    dlib::global_function_search search;
    std::map<int32_t, dlib::function_evaluation_request> waiting;
    int32_t chosen = 0;
    explicit Chooser(const ChooserSpace &space)
        : search({space_of(space)}, {known_of(space)}, relative_noise)
    {
        search.set_seed(space.seed);
    }
};

namespace
{

// Runs `work`, and turns what it throws into an error.
template <typename Work>
bool guarded(Error *err, const Work &work)
{
    try {
        work();
        return true;
    } catch (const std::exception &thrown) {
        error_set(err, ERROR_LIBRARY, __FILE__, __LINE__, "dlib: %s", thrown.what());
    }
    return false;
}

Chooser *create(const ChooserSpace *space, Error *err)
{
    Chooser *chooser = nullptr;
    guarded(err, [&] { chooser = new Chooser(*space); });
    return chooser;
}

bool choose(Chooser *chooser, double *x, int32_t *number, Error *err)
{
    return guarded(err, [&] {
        auto request = chooser->search.get_next_x();
        for (int32_t k = 0; k < request.x().size(); k++) x[k] = request.x()(k);
        *number = chooser->chosen++;
        chooser->waiting.emplace(*number, std::move(request));
    });
}

bool tell(Chooser *chooser, int32_t number, double value, Error *err)
{
    return guarded(err, [&] {
        chooser->waiting.at(number).set(value_of(value));
        chooser->waiting.erase(number);
    });
}

void destroy(Chooser *chooser)
{
    delete chooser;
}

const ChooserModule module = {create, choose, tell, destroy};

}   // namespace

extern "C" const ChooserModule *amontons_chooser_module(void);
const ChooserModule *amontons_chooser_module(void)
{
    return &module;
}
