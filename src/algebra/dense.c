// SPDX-License-Identifier: GPL-2.0-or-later
// LAPACK's Fortran entry points come with OpenBLAS; they are declared here because Debian's
// LAPACK headers belong to another package. Character arguments carry hidden lengths.
//
// Matrices are column-major without gaps: entry (i, j) of an n x n one is a[j n + i]. Sizes of 0
// occur (nothing slips, no rod) and are looked after here, as BLAS wants a leading dimension of 1
// at least. Nothing allocates, so that the loop of steps may call all of it.
#include "algebra/dense.h"

#include "base/parallel.h"
#include "base/system.h"

#include <cblas.h>
#include <math.h>
#include <stdatomic.h>
#include <string.h>

// Rows that dense_apply_each takes at a time: half a megabyte, and whole vectors of the processor,
// so that all rows are rounded alike.
enum { ROWS_CACHED = 65536, ROWS_STEP = 16 };

void dpotrf_(const char *uplo, const int *n, double *a, const int *lda, int *info,
             size_t uplo_size);
void spotrf_(const char *uplo, const int *n, float *a, const int *lda, int *info, size_t uplo_size);
void dgetrf_(const int *m, const int *n, double *a, const int *lda, int *pivots, int *info);
void dgetrs_(const char *trans, const int *n, const int *nrhs, const double *a, const int *lda,
             const int *pivots, double *b, const int *ldb, int *info, size_t trans_size);
void sgetrf_(const int *m, const int *n, float *a, const int *lda, int *pivots, int *info);
void sgetrs_(const char *trans, const int *n, const int *nrhs, const float *a, const int *lda,
             const int *pivots, float *b, const int *ldb, int *info, size_t trans_size);
void slaswp_(const int *n, float *a, const int *lda, const int *from, const int *to,
             const int *pivots, const int *step);
void dtrtri_(const char *uplo, const char *diag, const int *n, double *a, const int *lda, int *info,
             size_t uplo_size, size_t diag_size);
void dsygst_(const int *itype, const char *uplo, const int *n, double *a, const int *lda,
             const double *b, const int *ldb, int *info, size_t uplo_size);
void dlauum_(const char *uplo, const int *n, double *a, const int *lda, int *info,
             size_t uplo_size);
void dsygvd_(const int *itype, const char *jobz, const char *uplo, const int *n, double *a,
             const int *lda, double *b, const int *ldb, double *w, double *work, const int *lwork,
             int *iwork, const int *liwork, int *info, size_t jobz_size, size_t uplo_size);
void dsytrd_(const char *uplo, const int *n, double *a, const int *lda, double *d, double *e,
             double *tau, double *work, const int *lwork, int *info, size_t uplo_size);
void dsterf_(const int *n, double *d, double *e, int *info);
void dstedc_(const char *compz, const int *n, double *d, double *e, double *z, const int *ldz,
             double *work, const int *lwork, int *iwork, const int *liwork, int *info,
             size_t compz_size);
void dormtr_(const char *side, const char *uplo, const char *trans, const int *m, const int *n,
             const double *a, const int *lda, const double *tau, double *c, const int *ldc,
             double *work, const int *lwork, int *info, size_t side_size, size_t uplo_size,
             size_t trans_size);
void dgeev_(const char *jobvl, const char *jobvr, const int *n, double *a, const int *lda,
            double *wr, double *wi, double *vl, const int *ldvl, double *vr, const int *ldvr,
            double *work, const int *lwork, int *info, size_t jobvl_size, size_t jobvr_size);

static int32_t smaller(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

// OpenBLAS itself calls this before a fork. Its builds without threads do not have it.
int blas_thread_shutdown_(void) __attribute__((weak));

// OpenBLAS starts its threads when it is loaded, and an idle one looks for work at full speed for
// 2^26 clock ticks (26 ms) before it sleeps: more than a short run takes.
void dense_use_one_thread(void)
{
    if (openblas_get_num_threads() == 1) return;   // to set it again would start them again
    openblas_set_num_threads(1);
    if (blas_thread_shutdown_) blas_thread_shutdown_();
}

static const size_t BUFFER = (size_t)128 << 20;   // of OpenBLAS for processors of today
static atomic_bool has_buffer;   // OpenBLAS keeps it as long as the process lasts

bool dense_begin(Error *err)
{
    double one = 1;
    dense_use_one_thread();
    if (has_buffer) return true;
    if (!system_has_room(BUFFER))
        return FAULT(err, ERROR_MEMORY,
                     "no memory for products of matrices: OpenBLAS needs %zu MB in one piece "
                     "(ulimit -v)",
                     BUFFER >> 20);
    has_buffer = dense_cholesky(&one, 1);
    return true;
}

// A = L L'. LAPACK stops at the first pivot that is not above 0, which is the test for definiteness
// itself: no tolerance is involved.
bool dense_cholesky(double *a, int32_t n)
{
    int info = 0;
    if (n > 0) dpotrf_("L", &n, a, &n, &info, 1);
    if (info != 0) return false;
    for (int64_t k = 0; k < n; k++) {   // LAPACK lets NaN pass
        if (!(a[k * n + k] > 0)) return false;
    }
    return true;
}

// Where a factor breaks down in column j, L of the columns before and the row l of it give
// x = (-L^-T l, 1, 0 ...), along which the matrix is not positive. Whether this holds of `a` itself
// its own x'a x says. (LAPACK promises no l: without it x is some direction, and tells little.)
static bool is_negative_where_it_breaks_down(const double *a, int64_t n, int64_t j,
                                             const float *lower, float *x)
{
    const float *scale = lower + n * n;
    double square = 0;
    for (int64_t k = 0; k < j; k++) x[k] = -lower[k * n + j];
    x[j] = 1;
    cblas_strsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, (int)j, lower, (int)n, x, 1);
    for (int64_t k = 0; k <= j; k++) {
        double sum = 0, own = (double)x[k] * scale[k];
        for (int64_t i = k + 1; i <= j; i++) sum += a[k * n + i] * ((double)x[i] * scale[i]);
        square += own * (a[k * (n + 1)] * own + 2 * sum);
    }
    return square < 0;
}

// A is scaled to a diagonal of 1 first, so that no entry is too large or too small for single
// precision, and rounds to a part in 2^24 of it wherever it stands.
DenseAnswer dense_definite_single(const double *a, int32_t n, double shift, float *work)
{
    int info = 0;
    int64_t size = n;
    float *scale = work + size * size;
    for (int64_t k = 0; k < size; k++) {
        if (!(a[k * (size + 1)] > 0)) return DENSE_NO;
        scale[k] = (float)(1 / sqrt(a[k * (size + 1)]));
    }
    for (int64_t j = 0; j < size; j++) {
        for (int64_t i = j; i < size; i++)
            work[j * size + i] = (float)a[j * size + i] * scale[i] * scale[j];
        work[j * (size + 1)] = (float)(1 + shift);
    }
    if (n > 0) spotrf_("L", &n, work, &n, &info, 1);
    for (int64_t k = 0; k < size && info == 0; k++)
        if (!(work[k * (size + 1)] > 0)) return DENSE_UNSURE;
    if (info == 0) return shift < 0 ? DENSE_YES : DENSE_UNSURE;
    return info > 0 && is_negative_where_it_breaks_down(a, size, info - 1, work, scale + size)
               ? DENSE_NO
               : DENSE_UNSURE;
}

// P A = L U by rows (dgetrf). A pivot of exactly 0 is what LAPACK calls singular; a matrix that is
// nearly so passes, and its caller sees it in the residual.
bool dense_lu(double *a, int32_t n, int32_t *pivots)
{
    int info = 0;
    if (n > 0) dgetrf_(&n, &n, a, &n, pivots, &info);
    return info == 0;
}

// det A = (-1)^(row swaps) times the product of U's diagonal: only signs are multiplied, since the
// product itself would overflow.
int dense_lu_sign(const double *lu, int32_t n, const int32_t *pivots)
{
    int sign = 1;
    for (int64_t k = 0; k < n; k++) {
        double pivot = lu[k * n + k];
        if (pivot == 0) return 0;
        if (pivot < 0) sign = -sign;
        if (pivots[k] != k + 1) sign = -sign;   // LAPACK counts rows from 1
    }
    return sign;
}

// b: [n], overwritten with the solution.
void dense_lu_solve(const double *lu, int32_t n, const int32_t *pivots, double *b)
{
    int info = 0, one = 1;
    if (n > 0) dgetrs_("N", &n, &one, lu, &n, pivots, b, &n, &info, 1);
}

// --- LU in single precision, by columns side by side ---------------------------------------------

// Columns of a panel, which one thread factors, and of a piece beside it; the rows from which on
// threads are worth it, at 10 ms for one.
enum { PANEL = 96, PIECE = 192, LU_ROWS = 1000 };

typedef struct PanelUpdate {
    float *a;   // [n * n]
    int32_t n, first;   // the first column of the panel, which is factored
    int32_t *pivots;   // [n], counted from 1
    bool *regular;   // all panels so far
} PanelUpdate;

// Factors the columns first .. first + width - 1 from row `first` down.
static void factor_panel(float *a, int32_t n, int32_t first, int32_t width, int32_t *pivots,
                         bool *regular)
{
    int rows = n - first, info = 0;
    sgetrf_(&rows, &width, a + (int64_t)first * n + first, &n, pivots + first, &info);
    for (int32_t k = first; k < first + width; k++) pivots[k] += first;
    *regular = *regular && info == 0;
}

// Brings a panel's swaps and what it takes away to `count` columns on its right.
static void update_columns(const PanelUpdate *by, int32_t column, int32_t count)
{
    int n = by->n, from = by->first + 1, to = by->first + PANEL, one = 1, below = n - to;
    const float *panel = by->a + (int64_t)by->first * n + by->first;
    float *top = by->a + (int64_t)column * n + by->first;
    slaswp_(&count, by->a + (int64_t)column * n, &n, &from, &to, by->pivots, &one);
    cblas_strsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasUnit, PANEL, count, 1,
                panel, n, top, n);
    if (below > 0)
        cblas_sgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, below, count, PANEL, -1,
                    panel + PANEL, n, top, n, 1, top + PANEL, n);
}

// Piece 0 is the next panel, which is factored at once while others go on beside it.
static void update_piece(void *context, int32_t k, int32_t worker)
{
    const PanelUpdate *by = context;
    int32_t next = by->first + PANEL, width = smaller(PANEL, by->n - next);
    int32_t column = k == 0 ? next : next + width + (k - 1) * PIECE;
    (void)worker;
    update_columns(by, column, k == 0 ? width : smaller(PIECE, by->n - column));
    if (k == 0) factor_panel(by->a, by->n, next, width, by->pivots, by->regular);
}

// The swaps of all panels on its right.
static void swap_panel(void *context, int32_t k, int32_t worker)
{
    const PanelUpdate *by = context;
    int n = by->n, width = PANEL, from = (k + 1) * PANEL + 1, one = 1;
    (void)worker;
    slaswp_(&width, by->a + (int64_t)k * PANEL * n, &n, &from, &n, by->pivots, &one);
}

bool dense_lu_single(float *a, int32_t n, int32_t *pivots)
{
    int info = 0;
    bool regular = true;
    if (n < LU_ROWS) {
        if (n > 0) sgetrf_(&n, &n, a, &n, pivots, &info);
        return info == 0;
    }
    PanelUpdate by = {a, n, 0, pivots, &regular};
    factor_panel(a, n, 0, PANEL, pivots, &regular);
    for (; by.first + PANEL < n; by.first += PANEL) {
        int32_t next = by.first + PANEL, beside = n - next - smaller(PANEL, n - next);
        parallel_for(1 + (beside + PIECE - 1) / PIECE, update_piece, &by);
    }
    parallel_for((n - 1) / PANEL, swap_panel, &by);
    return regular;
}

// b over its largest entry, so that nothing is too small for single precision.
void dense_lu_single_solve(const float *lu, int32_t n, const int32_t *pivots, double *b,
                           float *work)
{
    int info = 0, one = 1;
    double largest = dense_max_abs(b, n);
    if (largest == 0) return;
    for (int32_t k = 0; k < n; k++) work[k] = (float)(b[k] / largest);
    sgetrs_("N", &n, &one, lu, &n, pivots, work, &n, &info, 1);
    for (int32_t k = 0; k < n; k++) b[k] = largest * (double)work[k];
}

// Reads the lower triangle only: half the memory of a general product.
void dense_symmetric_apply(const double *a, int32_t n, const double *x, double *y)
{
    if (n > 0) cblas_dsymv(CblasColMajor, CblasLower, n, 1.0, a, n, x, 1, 0.0, y, 1);
}

// dlauum leaves L^-T L^-1 in the lower triangle: the upper one is mirrored from it.
bool dense_invert_factored(double *a, int32_t n)
{
    int info = 0;
    if (n > 0) dtrtri_("L", "N", &n, a, &n, &info, 1, 1);
    if (n > 0 && info == 0) dlauum_("L", &n, a, &n, &info, 1);
    dense_mirror(a, n);
    return info == 0;
}

void dense_add_scaled(double factor, const double *x, int32_t n, double *y)
{
    if (n > 0) cblas_daxpy(n, factor, x, 1, y, 1);
}

// Tridiagonal form, its values by QL, its vectors by divide and conquer (LAPACK Users' Guide, 3rd
// ed., 2.4.4), of which those that are wanted are turned back.
bool dense_eigen_above(double *a, int32_t n, double least, double *values, double *work)
{
    int64_t size = n;
    double *reflectors = work, *diagonal = work + size, *beside = diagonal + size;
    double *vectors = beside + size, *rest = vectors + size * size;
    int info = 0, wanted = 0, room = 1 + 4 * n + n * n, whole = 3 + 5 * n;
    if (n == 0) return true;
    dsytrd_("L", &n, a, &n, diagonal, beside, reflectors, rest, &room, &info, 1);
    memcpy(values, diagonal, (size_t)n * sizeof *values);
    memcpy(rest, beside, (size_t)n * sizeof *rest);
    if (info == 0) dsterf_(&n, values, rest, &info);
    while (info == 0 && wanted < n && values[n - 1 - wanted] > least) wanted++;
    if (wanted == 0) return info == 0;
    dstedc_("I", &n, diagonal, beside, vectors, &n, rest, &room, (int *)(void *)(rest + room),
            &whole, &info, 1);
    double *first = vectors + (size - wanted) * size;
    if (info != 0) return false;
    dormtr_("L", "L", "N", &n, &wanted, a, &n, reflectors, first, &n, rest, &room, &info, 1, 1, 1);
    memcpy(a + (size - wanted) * size, first, (size_t)(size * wanted) * sizeof *a);
    return info == 0;
}

bool dense_eigen(double *a, int32_t n, double *values, double *work)
{
    return dense_eigen_above(a, n, -INFINITY, values, work) && (n == 0 || isfinite(values[n - 1]));
}

bool dense_eigen_pair(double *a, double *b, int32_t n, double *values, double *work)
{
    int info = 0, size = 1 + 6 * n + 2 * n * n, whole = 3 + 5 * n, kind = 1;
    if (n > 0)
        dsygvd_(&kind, "V", "L", &n, a, &n, b, &n, values, work, &size,
                (int *)(void *)(work + size), &whole, &info, 1, 1);
    return info == 0;
}

// dgeev: Hessenberg form, then shifted QR. Left eigenvectors are not asked for.
bool dense_eigen_general(double *a, int32_t n, double *re, double *im, double *vectors,
                         double *work)
{
    int info = 0, size = (int)DENSE_EIGEN_WORK(n), one = 1;
    if (n > 0)
        dgeev_("N", "V", &n, a, &n, re, im, NULL, &one, vectors, &n, work, &size, &info, 1, 1);
    return info == 0;
}

void dense_multiply_by_transposed(DenseView a, DenseView b, double *c)
{
    if (a.columns == 0 || a.rows == 0 || b.rows == 0) return;
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, a.rows, b.rows, a.columns, 1, a.values,
                a.rows, b.values, b.rows, 1, c, a.rows);
}

void dense_subtract_square(DenseView a, double *c)
{
    if (a.rows > 0 && a.columns > 0)
        cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, a.columns, a.rows, -1, a.values, a.rows,
                    1, c, a.columns);
    dense_mirror(c, a.columns);
}

void dense_apply(DenseView a, const double *x, double factor, double keep, double *y)
{
    if (a.columns == 0 || a.rows == 0) return;
    cblas_dgemv(CblasColMajor, CblasNoTrans, a.rows, a.columns, factor, a.values, a.rows, x, 1,
                keep, y, 1);
}

typedef struct NonzeroProduct {
    DenseView a;
    const double *x;
    double factor, *y;
    int32_t rows;   // of a piece
} NonzeroProduct;

// The rows of a piece. A run ends at a 0; one of every second column also before it would leave out
// what is none.
static void add_nonzero_rows(void *context, int32_t piece, int32_t worker)
{
    const NonzeroProduct *all = context;
    const double *x = all->x;
    int64_t rows = all->a.rows, from = (int64_t)piece * all->rows;
    int32_t columns = all->a.columns, here = smaller(all->rows, (int32_t)(rows - from));
    (void)worker;
    for (int32_t first = 0, end; first < columns && rows > 0; first++) {
        if (x[first] == 0) continue;
        int32_t stride = first + 1 < columns && x[first + 1] != 0 ? 1 : 2;
        for (end = first + stride; end < columns && x[end] != 0; end += stride)
            if (stride == 2 && x[end - 1] != 0) break;
        cblas_dgemv(CblasColMajor, CblasNoTrans, here, (end - first) / stride, all->factor,
                    all->a.values + first * rows + from, stride * all->a.rows, x + first, stride, 1,
                    all->y + from, 1);
        first = end - stride;
    }
}

static int64_t count_nonzero(const double *x, int32_t n)
{
    int64_t nonzero = 0;
    for (int32_t k = 0; k < n; k++) nonzero += x[k] != 0;
    return nonzero;
}

void dense_add_symmetric(const double *a, int32_t n, const double *x, double factor, double *y)
{
    // Both are bound by memory: half of the columns are as much as a triangle.
    if (2 * count_nonzero(x, n) <= n)
        dense_add_nonzero((DenseView){a, n, n}, x, factor, y);
    else
        cblas_dsymv(CblasColMajor, CblasLower, n, factor, a, n, x, 1, 1.0, y, 1);
}

void dense_add_nonzero(DenseView a, const double *x, double factor, double *y)
{
    int64_t nonzero = count_nonzero(x, a.columns);
    NonzeroProduct all = {a, x, factor, y, a.rows};
    if (nonzero * a.rows < PARALLEL_ENTRIES) {
        add_nonzero_rows(&all, 0, 0);
        return;
    }
    all.rows = (a.rows / 2 + ROWS_STEP) / ROWS_STEP * ROWS_STEP;   // halves
    parallel_for(2, add_nonzero_rows, &all);
}

// A few rows at a time, which stay in the processor's cache for the next vector.
void dense_apply_each(DenseView a, int32_t count, const double *const *x, double *const *y)
{
    int32_t block = ROWS_CACHED / (a.columns + 1) / ROWS_STEP * ROWS_STEP + ROWS_STEP;
    for (int32_t row = 0; row < a.rows && a.columns > 0; row += block) {
        int32_t rows = a.rows - row < block ? a.rows - row : block;
        for (int32_t k = 0; k < count; k++)
            cblas_dgemv(CblasColMajor, CblasNoTrans, rows, a.columns, 1, a.values + row, a.rows,
                        x[k], 1, 0, y[k] + row, 1);
    }
}

void dense_apply_transposed(DenseView a, const double *x, double factor, double keep, double *y)
{
    if (a.rows == 0)   // BLAS takes no matrix without rows
        dense_multiply_transposed(a, dense_view(x, 0, 1), factor, keep, y);
    else if (a.columns > 0)
        cblas_dgemv(CblasColMajor, CblasTrans, a.rows, a.columns, factor, a.values, a.rows, x, 1,
                    keep, y, 1);
}

// Sums in BLAS's order: the bits are the same on one machine, not on every one.
double dense_dot(const double *x, const double *y, int32_t n)
{
    return cblas_ddot(n, x, 1, y, 1);
}

// fmax would be a call; it passes NaN by, as this does.
double dense_max_abs(const double *x, int32_t n)
{
    double largest = 0;
    for (int32_t i = 0; i < n; i++)
        if (fabs(x[i]) > largest) largest = fabs(x[i]);
    return largest;
}

// --- transposes ---------------------------------------------------------------------------------

// Rows become columns in tiles that stay in the cache: column by column each number of a large
// matrix would come from another page.
enum { TILE = 32 };

static int64_t tile_end(int64_t from, int64_t size)
{
    return from + TILE < size ? from + TILE : size;
}

void dense_transpose(DenseView a, double *out, int64_t stride)
{
    for (int64_t left = 0; left < a.columns; left += TILE)
        for (int64_t top = 0; top < a.rows; top += TILE)
            for (int64_t i = top; i < tile_end(top, a.rows); i++)
                for (int64_t j = left; j < tile_end(left, a.columns); j++)
                    out[i * stride + j] = a.values[j * a.rows + i];
}

void dense_mirror(double *a, int64_t n)
{
    for (int64_t left = 0; left < n; left += TILE)
        for (int64_t top = left; top < n; top += TILE)
            for (int64_t i = top; i < tile_end(top, n); i++)
                for (int64_t j = left; j < tile_end(left, n) && j < i; j++)
                    a[i * n + j] = a[j * n + i];
}

// --- triangular matrices ------------------------------------------------------------------------

// The strictly upper triangle of `lower` is not looked at, here and in what follows but for its
// square.
void dense_lower_apply(const double *lower, int32_t n, double *x)
{
    if (n > 0)
        cblas_dtrmv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit, n, lower, n, x, 1);
}

void dense_lower_apply_transposed(const double *lower, int32_t n, double *x)
{
    if (n > 0) cblas_dtrmv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, n, lower, n, x, 1);
}

void dense_lower_solve_transposed(const double *lower, int32_t n, double *x)
{
    if (n > 0) cblas_dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, n, lower, n, x, 1);
}

void dense_lower_solve(const double *lower, int32_t n, double *x)
{
    if (n > 0)
        cblas_dtrsv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit, n, lower, n, x, 1);
}

void dense_lower_square(const double *lower, int32_t n, double *c)
{
    if (n > 0) cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, n, n, 1, lower, n, 0, c, n);
    dense_mirror(c, n);
}

void dense_lower_divide(const double *lower, int32_t n, int32_t columns, double *b)
{
    if (n > 0 && columns > 0)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, n, columns,
                    1.0, lower, n, b, n);
}

void dense_lower_divide_transposed(const double *lower, int32_t n, int32_t columns, double *b)
{
    if (n > 0 && columns > 0)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans, CblasNonUnit, n, columns, 1.0,
                    lower, n, b, n);
}

void dense_lower_multiply(const double *lower, int32_t n, int32_t columns, double *b)
{
    if (n > 0 && columns > 0)
        cblas_dtrmm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, n, columns,
                    1.0, lower, n, b, n);
}

// The panel is not empty. Right sides are rows here.
void dense_panel_forward(const double *panel, int32_t height, int32_t count, int32_t columns,
                         double *own, double *below)
{
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, columns, count, 1,
                panel, height, own, columns);
    if (height > count)
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, columns, height - count, count, 1, own,
                    columns, panel + count, height, 0, below, columns);
}

void dense_panel_backward(const double *panel, int32_t height, int32_t count, int32_t columns,
                          double *own, const double *below)
{
    if (height > count)
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, columns, count, height - count, -1,
                    below, columns, panel + count, height, 1, own, columns);
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasNoTrans, CblasNonUnit, columns, count,
                1, panel, height, own, columns);
}

// dsygst: half the operations of two triangular solves, as it keeps to one triangle. Turns a x =
// lambda L L' x into a symmetric problem of its own.
void dense_divide_both_sides(const double *lower, int32_t n, double *a)
{
    int info = 0, from_both_sides = 1;
    if (n > 0) dsygst_(&from_both_sides, "L", &n, a, &n, lower, &n, &info, 1);
}

// --- products of matrices, by columns in pieces where they are large ----------------------------

enum { PIECES_MAX = 8, PIECE_COLUMNS = 32 };   // at least: narrower ones read `a` for little

// c = factor op(a) b + keep c, op(a) = a or a'.
typedef struct Product {
    bool turned;
    DenseView a, b;
    int64_t b_stride;
    double factor, keep;
    double *c;
    int64_t c_stride;
    int32_t pieces;
} Product;

static void multiply_piece(void *context, int32_t k, int32_t worker)
{
    const Product *all = context;
    const DenseView *a = &all->a, *b = &all->b;
    int64_t from = (int64_t)b->columns * k / all->pieces;
    int64_t end = (int64_t)b->columns * (k + 1) / all->pieces;
    (void)worker;
    cblas_dgemm(CblasColMajor, all->turned ? CblasTrans : CblasNoTrans, CblasNoTrans,
                all->turned ? a->columns : a->rows, (int)(end - from),
                all->turned ? a->rows : a->columns, all->factor, a->values, a->rows,
                b->values + from * all->b_stride, (int)all->b_stride, all->keep,
                all->c + from * all->c_stride, (int)all->c_stride);
}

static void multiply(Product all)
{
    double operations = 2.0 * all.a.rows * all.a.columns * all.b.columns;
    int64_t pieces = operations < PARALLEL_OPERATIONS ? 1 : all.b.columns / PIECE_COLUMNS;
    if (!(operations > 0)) return;
    all.pieces = (int32_t)(pieces < 1 ? 1 : pieces < PIECES_MAX ? pieces : PIECES_MAX);
    parallel_for(all.pieces, multiply_piece, &all);
}

void dense_multiply_transposed_rows(DenseView a, DenseView b, double factor, double keep, double *c,
                                    int64_t stride)
{
    multiply((Product){true, a, b, b.rows, factor, keep, c, stride, 0});
}

void dense_multiply_transposed(DenseView a, DenseView b, double factor, double keep, double *c)
{
    if (a.rows == 0)   // BLAS takes no matrix without rows
        for (int64_t k = 0; k < (int64_t)a.columns * b.columns; k++)
            c[k] = keep == 0 ? 0 : keep * c[k];
    dense_multiply_transposed_rows(a, b, factor, keep, c, a.columns);
}

// Where there is nothing to sum over (a.columns 0) `c` is left as it is, not even scaled.
void dense_multiply(DenseView a, DenseView b, double factor, double keep, double *c)
{
    multiply((Product){false, a, b, b.rows, factor, keep, c, a.rows, 0});
}

void dense_multiply_rows(DenseView a, const double *b, int64_t stride, int64_t columns,
                         double factor, double *c)
{
    multiply(
        (Product){false, a, dense_view(b, a.columns, columns), stride, factor, 1, c, a.rows, 0});
}
