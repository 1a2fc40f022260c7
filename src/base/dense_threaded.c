// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/dense_threaded.h"

#include "base/share.h"

// Products below which a thread takes as long to begin as it saves: 1 ms.
static const double ALONE = 2e7;

typedef struct Product {
    void (*multiply)(DenseView a, DenseView b, double factor, double keep, double *c);
    DenseView a, b;
    double factor, keep;
    double *c;
    int64_t c_rows;
} Product;

static void multiply_half(void *context, int32_t which)
{
    const Product *all = context;
    int64_t columns = all->b.columns, first = which ? columns / 2 : 0;
    int64_t count = which ? columns - columns / 2 : columns / 2;
    all->multiply(all->a, dense_view(all->b.values + first * all->b.rows, all->b.rows, count),
                  all->factor, all->keep, all->c + first * all->c_rows);
}

static void multiply(Product *all)
{
    if ((double)all->a.rows * all->a.columns * all->b.columns < ALONE)
        all->multiply(all->a, all->b, all->factor, all->keep, all->c);
    else
        share_in_two(multiply_half, all);
}

void dense_multiply_transposed_threaded(DenseView a, DenseView b, double factor, double keep,
                                        double *c)
{
    multiply(&(Product){dense_multiply_transposed, a, b, factor, keep, c, a.columns});
}

void dense_multiply_threaded(DenseView a, DenseView b, double factor, double keep, double *c)
{
    multiply(&(Product){dense_multiply, a, b, factor, keep, c, a.rows});
}
