// SPDX-License-Identifier: GPL-2.0-or-later
// A cell of a grid, or the disc of a point where points form none, shows what was computed there; a
// point without a value shows the paper.
#include "render/plot/plot_map.h"

#include "base/memory.h"
#include "render/plot/map_cells.h"
#include "render/plot/marks.h"

#include <math.h>
#include <stdio.h>

enum { LEVELS_WANTED = 6, MARKS_MINDED = 2000, CELL_PARTS = 6, RING_SIDES = 24 };
enum { VECTOR_MOST = 10000 };   // cells that are shapes in a file of shapes

static const double CONTOUR_WIDTH = 0.55, HALO_WIDTH = 1.5;   // points
static const double RING_SHARE = 0.26, DISC_SHARE = 0.4;   // of the distance of points
static const double RING_MAX = 1.7, DISC_MAX = 3;   // points: radii
static const double RING_WIDTH = 0.45, DISC_RIM = 0.3;   // points
static const double DISTANCE_MIN = 3;   // points: marks of points nearer than this are left out
static const double MARKS_APART = 5;   // points: those that stand for others
static const double CROSS_ARM = 1.5;   // points
static const double LABEL_CLEARANCE = 6, HIDING_WORTH = 0.4;   // points: number to mark
static const double LEVEL_INSIDE = 1e-3;   // of the range: a level this near its end is no line
static const double LABEL_DISTANCE = 9;   // points: least, of a level's number to others and frame

static const Color HALO = {1, 1, 1, 0.75f};

typedef struct MapDrawing {
    const Page *page;
    const Axes *axes;
    const PlotMap *map;
    const MapScale *scale;
    MapGrid grid;   // owned, as the next
    Point *place;   // [map->count] on the picture, pixels; not finite: the axes cannot show it
} MapDrawing;

MapScale map_scale_fit(const Plot *plot)
{
    MapScale scale = {.bar.factor = plot->color.factor, .contours = plot->contours};
    double range[2] = {plot->color.low * scale.bar.factor, plot->color.high * scale.bar.factor};
    colorbar_fit(&scale.bar, range);
    scale.bar.clipped = plot->found[0] * scale.bar.factor < scale.bar.low;
    scale.bar.clipped_above = plot->found[1] * scale.bar.factor > scale.bar.high;
    snprintf(scale.bar.label, sizeof scale.bar.label, "%s", plot->color.label);
    return scale;
}

// --- colours ------------------------------------------------------------------------------------

static float color_value(const MapDrawing *drawing, int32_t point)
{
    return colorbar_level(&drawing->scale->bar, drawing->map->value[point]);
}

// The edges of the cells in pixels of the frame: [count] of them from `edges` on.
static void edges_place(const Axis *axis, const double *edges, int32_t count, double length,
                        float *placed)
{
    double low = axis->is_log ? log10(axis->low) : axis->low;
    double high = axis->is_log ? log10(axis->high) : axis->high;
    for (int32_t k = 0; k < count; k++)
        placed[k] = (float)(length * (edges[k] - low) / (high - low));
}

// Two triangles a cell, all corners of its value; in a file of shapes each cell is a shape of its
// own.
static bool grid_draw(const MapDrawing *drawing, Error *err)
{
    static const uint8_t order[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
    const MapGrid *grid = &drawing->grid;
    const Box *box = &drawing->axes->box;
    Canvas *canvas = drawing->page->canvas;
    int64_t cells = (int64_t)grid->rows * grid->columns, count = 0;
    bool shapes = canvas_is_vector(canvas) && cells <= VECTOR_MOST;
    float *x = NULL;
    GlCorner *corners = NULL;
    TRY(x = NEW_ARRAY(float, (int64_t)grid->columns + grid->rows + 2, err));
    TRY(corners = NEW_ARRAY(GlCorner, 6 * cells, err));
    float *y = x + grid->columns + 1;
    double height = box->bottom - box->top;
    edges_place(&drawing->axes->x, grid->x, grid->columns + 1, box->right - box->left, x);
    edges_place(&drawing->axes->y, grid->y, grid->rows + 1, height, y);
    for (int32_t k = 0; k <= grid->rows; k++) y[k] = (float)height - y[k];
    for (int64_t k = 0; k < cells; k++) {
        int32_t row = (int32_t)(k / grid->columns), column = (int32_t)(k % grid->columns);
        int32_t point = grid->point[k];
        if (point < 0 || !isfinite(drawing->map->value[point])) continue;
        float value = color_value(drawing, point);
        Box cell = {box->left + (double)x[column], box->top + (double)y[row + 1],
                    box->left + (double)x[column + 1], box->top + (double)y[row]};
        if (shapes) canvas_heat_cell(canvas, &cell, value);
        for (int32_t i = 0; i < 6; i++)
            corners[count++] = (GlCorner){x[column + order[i][0]], y[row + order[i][1]], value, 0};
    }
    if (!shapes) canvas_heat_triangles(canvas, box, corners, count, NULL);
cleanup:
    memory_free_all(x, corners);
    return error_is_clean(err);
}

// Distance between points, pixels.
static double point_distance(const MapDrawing *drawing)
{
    const Box *box = &drawing->axes->box;
    double width = box->right - box->left, height = box->bottom - box->top;
    if (drawing->grid.columns > 0)
        return fmin(width / drawing->grid.columns, height / drawing->grid.rows);
    return sqrt(width * height / fmax(drawing->map->count, 1));
}

// Discs with a rim of ink; of very many points ones that cover the paper between them.
static void discs_draw(const MapDrawing *drawing)
{
    Canvas *canvas = drawing->page->canvas;
    double point = drawing->page->point, distance = point_distance(drawing);
    bool many = distance < DISTANCE_MIN * point;
    double radius = many ? distance : fmin(DISC_SHARE * distance, DISC_MAX * point);
    double inside = many ? radius : radius - DISC_RIM * point;
    for (int32_t k = 0; k < drawing->map->count; k++) {
        Point at = drawing->place[k];
        if (!isfinite(at.x + at.y + drawing->map->value[k])) continue;
        if (!many) draw_disc(canvas, INK, at, radius);
        canvas_heat_disc(canvas, at, inside, color_value(drawing, k));
    }
}

// --- lines --------------------------------------------------------------------------------------

static double least_distance(Point at, const Point *others, int32_t count)
{
    double least = INFINITY;
    for (int32_t k = 0; k < count; k++)
        least = fmin(least, hypot(at.x - others[k].x, at.y - others[k].y));
    return least;
}

// The level's number where it stands best, far from other numbers and the frame, and not where it
// hides the mark of a point; none where all of the line is near. pieces: [count] as draw_line takes
// them. labels: [*labelled] places of others.
static void level_label(const MapDrawing *drawing, double level, const Point *pieces, int64_t count,
                        Point *labels, int32_t *labelled)
{
    const Page *page = drawing->page;
    const PlotMap *map = drawing->map;
    const Box *frame = &drawing->axes->box;
    TextStyle style = {.size = SMALL_SIZE * page->point, .color = INK, .across = 0.5, .up = 0.5};
    double best = LABEL_DISTANCE * page->point;
    Point place = {NAN, NAN};
    char words[TICK_LABEL_SIZE];
    for (int64_t k = 0; k + 1 < count; k += 3) {
        Point at = {(pieces[k].x + pieces[k + 1].x) / 2, (pieces[k].y + pieces[k + 1].y) / 2};
        double worth = fmin(fmin(at.x - frame->left, frame->right - at.x),
                            fmin(at.y - frame->top, frame->bottom - at.y));
        worth = fmin(worth, least_distance(at, labels, *labelled));
        if (map->count <= MARKS_MINDED &&
            least_distance(at, drawing->place, map->count) < LABEL_CLEARANCE * page->point)
            worth *= HIDING_WORTH;
        if (worth > best) place = at;
        best = fmax(best, worth);
    }
    if (!isfinite(place.x)) return;
    double number = level * drawing->scale->contours.factor;
    snprintf(words, sizeof words, "%s%.6g", number < 0 ? "\u2212" : "", fabs(number));
    double half = text_width(page->text, style.size, words) / 2 + page->point;
    Box box = {place.x - half, place.y - 0.6 * style.size, place.x + half,
               place.y + 0.6 * style.size};
    draw_fill(page->canvas, HALO, &box);
    text_draw(page->text, &style, place, words);
    labels[(*labelled)++] = place;
}

// Pieces of the line at `level`, into `pieces` as draw_line takes them; returns how many points.
// Between four points of the grid that meet, the quantity is bilinear: that square is cut into
// `parts` along each side and those into two triangles, of which the line crosses two sides.
static int64_t level_find(const MapDrawing *drawing, const double *values, double level,
                          int32_t parts, Point *pieces)
{
    static const int8_t across[2][3] = {{0, 1, 1}, {0, 1, 0}}, up[2][3] = {{0, 0, 1}, {0, 1, 1}};
    const MapGrid *grid = &drawing->grid;
    int64_t count = 0;
    for (int64_t k = 0; k < (int64_t)grid->columns * (grid->rows - 1); k++) {
        const int32_t *low = grid->point + k, *high = low + grid->columns;
        if (k % grid->columns == grid->columns - 1) continue;
        if (low[0] < 0 || low[1] < 0 || high[0] < 0 || high[1] < 0) continue;
        double value[4] = {values[low[0]], values[low[1]], values[high[0]], values[high[1]]};
        Point from = drawing->place[low[0]], to = drawing->place[high[1]];
        if (!isfinite(value[0] + value[1] + value[2] + value[3])) continue;
        for (int32_t part = 0; part < 2 * parts * parts; part++) {
            double s[3], r[3], v[3];
            int32_t found = 0;
            for (int32_t i = 0; i < 3; i++) {
                s[i] = (double)(part / 2 % parts + across[part % 2][i]) / parts;
                r[i] = (double)(part / 2 / parts + up[part % 2][i]) / parts;
                v[i] = (1 - r[i]) * ((1 - s[i]) * value[0] + s[i] * value[1]) +
                       r[i] * ((1 - s[i]) * value[2] + s[i] * value[3]);
            }
            for (int32_t a = 0, b = 1; a < 3; a++, b = (a + 1) % 3) {
                if ((v[a] < level) == (v[b] < level)) continue;
                double way = (level - v[a]) / (v[b] - v[a]);
                pieces[count + found++] =
                    (Point){from.x + (s[a] + way * (s[b] - s[a])) * (to.x - from.x),
                            from.y + (r[a] + way * (r[b] - r[a])) * (to.y - from.y)};
            }
            if (found != 2) continue;
            pieces[count + 2] = (Point){NAN, NAN};
            count += 3;
        }
    }
    return count;
}

// Lines where the contours' quantity has handy values, dark on a pale band, to be seen on every
// colour.
static bool contours_draw(const MapDrawing *drawing, Error *err)
{
    const Page *page = drawing->page;
    const MapGrid *grid = &drawing->grid;
    const double *values = drawing->map->contour;
    double *medians = NULL;
    Point *pieces = NULL;
    if (drawing->map->count > MAP_MANY) {
        TRY(values = medians = NEW_ARRAY(double, drawing->map->count, err));
        map_medians(grid, drawing->map->contour, medians);
    }

    const Axis *range = &drawing->scale->contours;
    double slack = LEVEL_INSIDE * (range->high - range->low);
    Ticks ticks = ticks_choose(range->low, range->high, LEVELS_WANTED);
    Point labels[LEVELS_WANTED + 1];
    int32_t labelled = 0;
    Stroke halo = {.color = HALO, .width = HALO_WIDTH * page->point};
    Stroke line = {.color = INK, .width = CONTOUR_WIDTH * page->point};
    int32_t parts = medians ? 1 : CELL_PARTS;
    int64_t most = 6 * (int64_t)parts * parts * grid->columns * grid->rows;
    TRY(pieces = NEW_ARRAY(Point, most, err));
    for (int32_t t = 0; t < ticks.count; t++) {
        double level = tick_value(&ticks, t);
        if (level < range->low + slack || level > range->high - slack) continue;
        int64_t count = level_find(drawing, values, level, parts, pieces);
        draw_line(page->canvas, &halo, pieces, count);
        draw_line(page->canvas, &line, pieces, count);
        level_label(drawing, level, pieces, count, labels, &labelled);
    }
cleanup:
    memory_free_all(medians, pieces);
    return error_is_clean(err);
}

// --- points -------------------------------------------------------------------------------------

// distance: to the next mark. Marks get smaller as they come nearer to each other. A cell is a run
// and needs no mark, but where it is doubtful or has no value.
static void point_draw(const MapDrawing *drawing, int32_t k, double distance)
{
    const Page *page = drawing->page;
    double point = page->point, ring = fmin(RING_SHARE * distance, RING_MAX * point);
    Point at = drawing->place[k];
    if (!isfinite(at.x) || !isfinite(at.y)) return;
    if (!isfinite(drawing->map->value[k])) {
        cross_draw(page, INK, at, fmin(RING_SHARE * distance, CROSS_ARM * point));
    } else if (drawing->map->open && drawing->map->open[k] > 0) {
        // A ring or a square: the colour inside shows, and ink inside of paper is seen on any.
        int32_t sides = drawing->map->open[k] > 1 ? 4 : RING_SIDES;
        Stroke stroke = {.color = PAPER, .width = fmin(3 * RING_WIDTH * page->point, 0.6 * ring)};
        Point line[RING_SIDES + 1];
        for (int32_t i = 0; i <= sides; i++) {
            double angle = 8 * atan(1) * (i + 0.5) / sides;
            line[i] = (Point){at.x + ring * cos(angle), at.y + ring * sin(angle)};
        }
        draw_line(page->canvas, &stroke, line, sides + 1);
        stroke.color = INK;
        stroke.width /= 3;
        draw_line(page->canvas, &stroke, line, sides + 1);
    }
}

bool plot_map_draw(const Page *page, const Axes *axes, const PlotPanel *panel,
                   const MapScale *scale, Error *err)
{
    MapDrawing drawing = {.page = page, .axes = axes, .map = &panel->map, .scale = scale};
    const PlotMap *map = &panel->map;
    TRY(map_grid_find(map, axes->x.is_log, axes->y.is_log, &drawing.grid, err));
    TRY(drawing.place = NEW_ARRAY(Point, map->count, err));
    for (int32_t k = 0; k < map->count; k++)
        drawing.place[k] = axes_place(axes, map->x[k], map->y[k]);
    if (drawing.grid.columns > 0) TRY(grid_draw(&drawing, err));
    canvas_clip(page->canvas, &axes->box);
    if (drawing.grid.columns == 0) discs_draw(&drawing);
    if (map->contour && drawing.grid.columns > 0) TRY(contours_draw(&drawing, err));

    // Marks of the points. Where cells of a grid are smaller than marks that one can tell apart,
    // those of some points stand for the ones around them.
    const MapGrid *grid = &drawing.grid;
    double distance = point_distance(&drawing), least = DISTANCE_MIN * page->point;
    bool thinned = grid->columns > 0 && distance < least;
    if (!thinned) {
        for (int32_t k = 0; k < map->count; k++) point_draw(&drawing, k, distance);
    } else {
        int32_t step = (int32_t)ceil(MARKS_APART * page->point / distance);
        for (int32_t row = step / 2; row < grid->rows; row += step)
            for (int32_t column = step / 2; column < grid->columns; column += step) {
                int32_t k = grid->point[row * grid->columns + column];
                if (k >= 0) point_draw(&drawing, k, least);
            }
    }
cleanup:
    canvas_clip(page->canvas, NULL);
    map_grid_destroy(&drawing.grid);
    memory_free(drawing.place);
    return error_is_clean(err);
}
