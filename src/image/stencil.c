// Areas of overlap between great-circle polygons and the texels of a panorama. In: a grid of texels
// of a cube or an octahedron, and the height of a panorama. Out: for each texel of the grid a
// stencil, the box of panorama texels that overlap the texel and their weights. Method: exact areas
// by Green's theorem, as follows.
//
// On the sphere, area is dphi dz with z = cos theta: rows and columns of a panorama are rectangles
// in (phi, z), and a great circle that is no meridian is a curve z(phi),
//
//     cot theta = c(phi) = A cos phi + B sin phi,     z = c / sqrt(1 + c^2).
//
// By Green's theorem the area of a polygon within the texel of column i and row j is the sum over
// the polygon's arcs, with sign, of the area north of the arc within that texel. For each column
// and arc, that area is the whole texel for rows north of the arc, 0 for rows south of the arc, and
// for rows that the arc crosses a difference of
//
//     G(Z) = integral of max(0, Z - z) dphi
//
// at the rows' borders Z. With s(phi) = -c'(phi) = A sin phi - B cos phi, q = sqrt(1 + c^2) and K =
// sqrt(1 + A^2 + B^2),
//
//     integral of z dphi = I = arcsin(s / K),     cos I = q / K.
//
// The difference I(b) - I(a) = arcsin((s_b q_a - s_a q_b) / K^2) has almost no cancellation. Small
// angles are computed by a short series instead of arcsin and arctan.
#include "image/stencil.h"
#include "math/math.h"

#include <math.h>
#include <string.h>

// A corner of a texel of the grid. The axis x points in the grid's first direction on the horizon,
// y a quarter turn east of x, and z up. phi is the angle from x towards y.
typedef struct corner {
    double x, y, z;      // direction of the corner, not normalised
    double cosine, sine; // cosine and sine of the corner's phi
    double height;       // z of the corner's direction as a unit vector
    double radius;       // length of (x, y)
    int column, row;     // column and row of the panorama that hold the corner
} corner;

// What one arc contributes to the areas of one panorama column: `area` in (column, row), and in
// every row north of `row` the arc's `width` in phi times the row's height in z.
typedef struct entry {
    int column, row;
    double area, width;
} entry;

typedef struct trace {
    entry *entries;
    int count;
    int first_column, end_column, first_row, end_row;
} trace;

// A great circle that is no meridian: points at angle theta from the north pole and longitude phi
// with cot theta = a cos phi + b sin phi. kappa2 = a^2 + b^2, inverse_k2 = 1 / (1 + kappa2).
typedef struct circle {
    double a, b; // coefficients of cot theta = a cos phi + b sin phi
    double kappa2, inverse_k2;
    double sign; // 1 if the arc runs east, -1 if it runs west; factor of the areas north of it
} circle;

// A point at which an arc of a great circle is divided while it is traced. s, q and z are defined
// at the head of this file.
typedef struct node {
    double cosine, sine; // cosine and sine of the point's longitude phi
    double s, q, z;
} node;

typedef struct builder {
    kiln_context *context;
    const ki_stencil_grid *grid;
    // Cosine and cotangent of theta, the angle from the north pole, at the borders between the
    // panorama's rows, poles included: height + 1 numbers each.
    const double *height, *cotangent;
    // Cosine and sine of the longitude phi at the borders between the panorama's columns, from the
    // border first_border on.
    const double *cosine, *sine;
    int first_border, end_border;
    bool small; // true: the columns of the panorama are at most 45 degrees wide
    ki_stencil_chunk *chunk;
    // for each texel of the stencil's box, the sums of `area` and `width` of the arcs' entries
    double *area, *width;
    size_t box_room;
} builder;

int ki_stencil_grid_rows(const ki_stencil_grid *grid)
{
    switch (grid->kind) {
    case KI_STENCIL_OCTAHEDRON:
        return grid->halved ? grid->half / 2 : grid->half - 1;
    case KI_STENCIL_RIM:
        return grid->halved ? (grid->half + 1) / 2 : grid->half;
    default:
        return grid->half;
    }
}

void ki_stencil_grid_range(const ki_stencil_grid *grid, int j, int *first, int *end)
{
    switch (grid->kind) {
    case KI_STENCIL_SIDE:
        *first = grid->halved ? 0 : -grid->half;
        *end = grid->half;
        break;
    case KI_STENCIL_TOP:
        *first = grid->halved ? j : 0;
        *end = grid->half;
        break;
    case KI_STENCIL_OCTAHEDRON:
        *first = grid->halved ? j : 0;
        *end = grid->half - 1 - j;
        break;
    default:
        *first = grid->half - 1 - j;
        *end = grid->half - j;
        break;
    }
}

// -------------------------------------------------------------------------------------------- arcs

// Returns the angle in [-pi, pi] with this sine and cosine. `small` says that all angles are at
// most 45 degrees, as in a panorama of eight columns or more. Angles near 0 are then computed by
// the series of arcsin, whose first omitted term is below 1e-16 of the first term.
static inline double angle(double sine, double cosine, bool small)
{
    double y = sine * sine, p;
    if (small && y < 1e-4) {
        p = 15.0 / 336;
    } else if (small && y < 1e-2) {
        p = 135135.0 / 9676800;
        p = p * y + 10395.0 / 599040;
        p = p * y + 945.0 / 42240;
        p = p * y + 105.0 / 3456;
        p = p * y + 15.0 / 336;
    } else {
        return ki_atan2(sine, cosine);
    }
    p = p * y + 3.0 / 40;
    p = p * y + 1.0 / 6;
    return sine + sine * (y * p);
}

static inline double angle_between(const builder *b, const node *from, const node *to)
{
    return angle(to->sine * from->cosine - to->cosine * from->sine,
                 to->cosine * from->cosine + to->sine * from->sine, b->small);
}

static inline double integral_between(const builder *b, const node *from, const node *to,
                                      double inverse_k2)
{
    return angle((to->s * from->q - from->s * to->q) * inverse_k2,
                 (from->q * to->q + from->s * to->s) * inverse_k2, b->small);
}

static inline node node_at(const circle *on, double cosine, double sine)
{
    double a = on->a, b = on->b;
    double c = a * cosine + b * sine, q = sqrt(1 + c * c);
    return (node){cosine, sine, a * sine - b * cosine, q, c / q};
}

// Returns the panorama row that holds the z of a unit direction, by a search that begins at `row`.
// The result is the row with height[row] >= z > height[row + 1].
static inline int find_row(const builder *b, double z, int row)
{
    while (row > 0 && z > b->height[row])
        row--;
    while (row < b->grid->height - 1 && z <= b->height[row + 1])
        row++;
    return row;
}

// Returns the panorama column that holds the longitude with this cosine and sine, by a search that
// begins at `column`.
static inline int find_column(const builder *b, double cosine, double sine, int column)
{
    // The search below moves to the next column by the sign of a cross product, which is ambiguous
    // for columns wider than 45 degrees. Those are found by arctan.
    if (!b->small)
        return (int)floor(ki_atan2(sine, cosine) * (b->grid->height / KI_PI) + b->grid->offset);
    const double *bc = b->cosine - b->first_border, *bs = b->sine - b->first_border;
    while (column > b->first_border && sine * bc[column] - cosine * bs[column] < 0)
        column--;
    while (column < b->end_border - 2 && sine * bc[column + 1] - cosine * bs[column + 1] >= 0)
        column++;
    return column;
}

static inline void add_entry(trace *arc, int column, int row, double area, double width)
{
    arc->entries[arc->count++] = (entry){column, row, area, width};
}

// Adds the areas north of the piece of an arc that lies in one column and crosses the rows `north`
// to `south`. `area_left` is G, as defined at the head of this file, at the upper border of row
// `north`, and `low` is the end of the piece with the smaller z.
static void trace_rows(const builder *b, trace *arc, const circle *on, const node *low, double side,
                       int column, int north, int south, double area_left, double width)
{
    double a_ = on->a, b_ = on->b;
    for (int j = north; j <= south; j++) {
        double next = 0;
        if (j < south) {
            // Computes the node at which the arc crosses the southern border of row j.
            double c = b->cotangent[j + 1], s2 = on->kappa2 - c * c;
            double s = copysign(s2 > 0 ? sqrt(s2) : 0, side);
            node cut = {(a_ * c - b_ * s) / on->kappa2, (b_ * c + a_ * s) / on->kappa2, s,
                        sqrt(1 + c * c), b->height[j + 1]};
            double w = angle_between(b, &cut, low);
            double i = integral_between(b, &cut, low, on->inverse_k2);
            next = fabs(b->height[j + 1] * w - i);
        }
        add_entry(arc, column, j, on->sign * (area_left - next), j == north ? on->sign * width : 0);
        area_left = next;
    }
}

// Adds the areas north of a piece of an arc, from `start` to `end` within one column. z only rises
// or only falls along the piece. Returns the panorama row of `end`.
static inline int trace_piece(const builder *b, trace *arc, const circle *on, const node *start,
                              const node *end, int column, int row)
{
    double width = angle_between(b, start, end);
    double integral = integral_between(b, start, end, on->inverse_k2);
    int last = find_row(b, end->z, row), north = ki_min(row, last), south = ki_max(row, last);
    double area_left = b->height[north] * width - integral;
    if (row == last)
        add_entry(arc, column, row, on->sign * area_left, on->sign * width);
    else
        trace_rows(b, arc, on, row < last ? end : start, start->s + end->s, column, north, south,
                   area_left, width);
    arc->first_row = ki_min(arc->first_row, north);
    arc->end_row = ki_max(arc->end_row, south + 1);
    return last;
}

// Follows the great circle from one corner to another and lists the areas north of it, positive
// where phi grows along the arc. Meridians contribute no area.
static void trace_arc(const builder *b, const corner *from, const corner *to, trace *arc)
{
    arc->count = 0;
    arc->first_column = arc->first_row = INT32_MAX;
    arc->end_column = arc->end_row = INT32_MIN;
    double cross = from->x * to->y - from->y * to->x, sign = 1;
    if (!(fabs(cross) > 1e-14 * from->radius * to->radius))
        return;
    if (cross < 0) {
        const corner *swap = from;
        from = to;
        to = swap;
        sign = -1;
        cross = -cross;
    }
    circle on = {.a = (from->z * to->y - from->y * to->z) / cross,
                 .b = (from->x * to->z - from->z * to->x) / cross,
                 .sign = sign};
    on.kappa2 = on.a * on.a + on.b * on.b;
    on.inverse_k2 = 1 / (1 + on.kappa2);
    node at = node_at(&on, from->cosine, from->sine);
    int column = from->column, row = from->row;
    arc->first_column = column;
    for (;;) {
        bool last = column >= to->column;
        if (last && column > from->column && to->sine * at.cosine - to->cosine * at.sine < 1e-14) {
            // the end of the arc lies on the western border of its column, so that the arc ends in
            // the column before
            column--;
            break;
        }
        int border = column + 1 - b->first_border;
        node next = last ? node_at(&on, to->cosine, to->sine)
                         : node_at(&on, b->cosine[border], b->sine[border]);
        if (at.s * next.s < 0) {
            // s, the slope of cot theta, changes its sign between `at` and `next`: the highest or
            // lowest point of the arc lies between them, and the arc is divided there.
            double kappa = sqrt(on.kappa2);
            double c = on.a / kappa, s = on.b / kappa;
            if (c * at.cosine + s * at.sine < 0) {
                c = -c;
                s = -s;
            }
            node top = node_at(&on, c, s);
            top.s = 0;
            row = trace_piece(b, arc, &on, &at, &top, column, row);
            at = top;
        }
        row = trace_piece(b, arc, &on, &at, &next, column, row);
        if (last)
            break;
        at = next;
        column++;
    }
    arc->end_column = column + 1;
}

// ------------------------------------------------------------------------------------------ texels

// Reserves room for `more` weights in a chunk. Returns false when memory runs out.
static bool grow(kiln_context *context, ki_stencil_chunk *chunk, size_t more)
{
    size_t wanted = chunk->weight_count + more, room = chunk->weight_room;
    if (wanted <= room)
        return true;
    room = room + room / 2 < wanted ? wanted : room + room / 2;
    float *larger = ki_alloc_raw(context, room, sizeof *larger);
    if (!larger)
        return false;
    memcpy(larger, chunk->weights, chunk->weight_count * sizeof *larger);
    ki_free(chunk->weights);
    chunk->weights = larger;
    chunk->weight_room = room;
    return true;
}

static void add_arc(const builder *b, const trace *arc, double sign, int column, int row,
                    size_t columns)
{
    for (int k = 0; k < arc->count; k++) {
        const entry *e = &arc->entries[k];
        size_t at = (size_t)(e->row - row) * columns + (size_t)(e->column - column);
        b->area[at] += sign * e->area;
        b->width[at] += sign * e->width;
    }
}

// Adds the stencil of one texel of the map. The texel's boundary, counter-clockwise with the sphere
// seen from inside, is arcs[0], arcs[1], then arcs[2] and arcs[3] backwards. `pole` says that the
// texel touches the north pole, so that its stencil begins at row 0.
static bool add_stencil(builder *b, const trace *const arcs[4], bool pole)
{
    int column = INT32_MAX, row = INT32_MAX, end_column = INT32_MIN, end_row = INT32_MIN;
    for (int k = 0; k < 4; k++) {
        column = ki_min(column, arcs[k]->first_column);
        row = ki_min(row, arcs[k]->first_row);
        end_column = ki_max(end_column, arcs[k]->end_column);
        end_row = ki_max(end_row, arcs[k]->end_row);
    }
    if (pole)
        row = 0;
    ki_stencil_chunk *chunk = b->chunk;
    size_t columns = ((size_t)(end_column - column) + 3) & ~(size_t)3;
    size_t rows = (size_t)(end_row - row), cells = rows * columns;
    if (cells > b->box_room) {
        size_t room = cells + cells / 2;
        ki_free(b->area);
        b->area = ki_alloc_raw(b->context, 2 * room, sizeof *b->area);
        b->box_room = b->area ? room : 0;
        if (!b->area)
            return false;
    }
    b->width = b->area + cells;
    memset(b->area, 0, 2 * cells * sizeof *b->area);
    static const double signs[4] = {1, 1, -1, -1};
    for (int k = 0; k < 4; k++)
        add_arc(b, arcs[k], signs[k], column, row, columns);

    if (!grow(b->context, chunk, cells))
        return false;
    double total = 0;
    for (size_t r = rows; r-- > 0;) {
        double *area = b->area + r * columns, *width = b->width + r * columns;
        double tall = b->height[(size_t)row + r] - b->height[(size_t)row + r + 1];
        const double *below = r + 1 < rows ? width + columns : NULL;
        for (size_t c = 0; c < columns; c++) {
            if (below) {
                area[c] += tall * below[c];
                width[c] += below[c];
            }
            area[c] = area[c] > 0 ? area[c] : 0;
            total += area[c];
        }
    }
    float *weights = chunk->weights + chunk->weight_count;
    double scale = total > 0 ? 1 / total : 0;
    for (size_t k = 0; k < cells; k++)
        weights[k] = (float)(b->area[k] * scale);
    chunk->weight_count += cells;
    chunk->first_row = ki_min(chunk->first_row, row);
    chunk->end_row = ki_max(chunk->end_row, end_row);
    chunk->stencils[chunk->stencil_count++] =
        (ki_stencil){column, row, (uint16_t)(columns / 4), (uint16_t)rows, (float)total};
    return true;
}

// Computes the corners first <= i <= end at the lower edge of row j of the grid.
static void fill_corners(const builder *b, int j, int first, int end, corner *corners)
{
    const ki_stencil_grid *grid = b->grid;
    int column = b->first_border, row = grid->height / 4;
    for (int i = first; i <= end; i++) {
        corner *c = &corners[i - first];
        double p = (double)i / grid->half, q = (double)j / grid->half;
        if (grid->kind == KI_STENCIL_SIDE)
            *c = (corner){.x = 1, .y = p, .z = q};
        else if (grid->kind == KI_STENCIL_TOP)
            *c = (corner){.x = p, .y = q, .z = 1};
        else
            *c = (corner){.x = p, .y = q, .z = (double)(grid->half - i - j) / grid->half};
        double r2 = c->x * c->x + c->y * c->y;
        c->radius = sqrt(r2);
        c->cosine = r2 > 0 ? c->x / c->radius : 1;
        c->sine = r2 > 0 ? c->y / c->radius : 0;
        c->height = c->z / sqrt(r2 + c->z * c->z);
        column = c->column = find_column(b, c->cosine, c->sine, column);
        row = c->row = find_row(b, c->height, row);
    }
}

static corner below_horizon(const builder *b, const corner *above)
{
    corner c = *above;
    c.z = -c.z;
    c.height = -c.height;
    c.row = find_row(b, c.height, b->grid->height - 1 - c.row);
    return c;
}

// Computes the stencils of the octahedron's texels that the horizon cuts, in the rows begin ..
// stop - 1. Such a texel has two sides above the horizon and two below.
static bool build_rim(builder *b, int begin, int stop, entry *entries, size_t line)
{
    for (int j = begin; j < stop; j++) {
        int first, end;
        ki_stencil_grid_range(b->grid, j, &first, &end);
        corner low[2], high[2];
        fill_corners(b, j, first, end, low);
        fill_corners(b, j + 1, first, end, high);
        corner under = below_horizon(b, &low[0]);
        trace bottom = {.entries = entries}, right = {.entries = entries + line};
        trace top = {.entries = entries + 2 * line}, left = {.entries = entries + 3 * line};
        trace_arc(b, &low[0], &low[1], &bottom);
        trace_arc(b, &low[1], &under, &right);
        trace_arc(b, &high[0], &under, &top);
        trace_arc(b, &low[0], &high[0], &left);
        if (!add_stencil(b, (const trace *[4]){&bottom, &right, &top, &left}, false))
            return false;
    }
    return true;
}

// The corners of texels along the lower or upper edge of a row of a grid, and the great-circle arcs
// between neighbouring corners.
typedef struct grid_line {
    corner *corners;
    trace *arcs;
    entry *entries;
} grid_line;

static void trace_line(const builder *b, int j, int first, int end, grid_line *line)
{
    fill_corners(b, j, first, end, line->corners);
    entry *entries = line->entries;
    for (int i = 0; i < end - first; i++) {
        line->arcs[i].entries = entries;
        trace_arc(b, &line->corners[i], &line->corners[i + 1], &line->arcs[i]);
        entries += line->arcs[i].count;
    }
}

// Computes the stencils of the grid's rows begin .. stop - 1. The arcs between two rows are traced
// once, as the top of a row and the bottom of the next row. The arc between two texels of a row is
// traced once too, as the right side of a texel and the left side of the next texel.
static bool build_rows(builder *b, int begin, int stop, grid_line bottom, grid_line top,
                       entry *entries, size_t line)
{
    int skip = 0; // number of texels at the start of the row below that have no texel above them
    for (int j = begin; j < stop; j++) {
        int first, end;
        ki_stencil_grid_range(b->grid, j, &first, &end);
        if (j == begin)
            trace_line(b, j, first, end, &bottom);
        trace_line(b, j + 1, first, end, &top);
        const corner *low = bottom.corners + skip, *high = top.corners;
        trace sides[2] = {{.entries = entries}, {.entries = entries + line}};
        trace_arc(b, &low[0], &high[0], &sides[0]);
        for (int i = 0; i < end - first; i++) {
            trace *left = &sides[i & 1], *right = &sides[(i + 1) & 1];
            trace_arc(b, &low[i + 1], &high[i + 1], right);
            const trace *around[4] = {&bottom.arcs[skip + i], right, &top.arcs[i], left};
            if (!add_stencil(b, around, low[i].radius == 0))
                return false;
        }
        if (j + 1 < stop) {
            int next_first;
            ki_stencil_grid_range(b->grid, j + 1, &next_first, &end);
            skip = next_first - first;
        }
        grid_line swap = bottom;
        bottom = top;
        top = swap;
    }
    return true;
}

static void build_chunk(void *data, int index)
{
    builder b = *(const builder *)data;
    const ki_stencil_grid *grid = b.grid;
    ki_stencil_chunk *chunk = b.chunk = &grid->chunks[index];
    int begin = index * KI_STENCIL_ROWS;
    int stop = ki_min(begin + KI_STENCIL_ROWS, ki_stencil_grid_rows(grid));
    size_t texels = 0;
    for (int j = begin; j < stop; j++) {
        int first, end;
        ki_stencil_grid_range(grid, j, &first, &end);
        texels += (size_t)(end - first);
    }
    // `line` is an upper bound for the number of entries of the arcs along one edge of a row of
    // texels. Together these arcs cross each column of the panorama once and each row at most
    // twice, and each arc adds at most 3 entries for its ends and for its highest or lowest point.
    size_t count = 2 * (size_t)grid->half + 2;
    size_t line = (size_t)(b.end_border - b.first_border) + 2 * (size_t)grid->height + 3 * count;
    chunk->failed = true;
    chunk->first_row = INT32_MAX;
    chunk->weight_room = 20 * texels;
    chunk->stencils = ki_alloc_raw(b.context, texels, sizeof *chunk->stencils);
    chunk->weights = ki_alloc_raw(b.context, chunk->weight_room, sizeof *chunk->weights);
    corner *corners = ki_alloc_raw(b.context, 2 * count, sizeof *corners);
    trace *arcs = ki_alloc_raw(b.context, 2 * count, sizeof *arcs);
    entry *entries = ki_alloc_raw(b.context, 4 * line, sizeof *entries);
    if (!chunk->stencils || !chunk->weights || !corners || !arcs || !entries)
        goto done;
    if (grid->kind == KI_STENCIL_RIM) {
        chunk->failed = !build_rim(&b, begin, stop, entries, line);
    } else {
        grid_line bottom = {corners, arcs, entries};
        grid_line top = {corners + count, arcs + count, entries + line};
        chunk->failed = !build_rows(&b, begin, stop, bottom, top, entries + 2 * line, line);
    }
done:
    ki_free(b.area);
    ki_free(entries);
    ki_free(arcs);
    ki_free(corners);
}

kiln_result ki_stencil_grid_build(kiln_context *context, ki_stencil_grid *grid, kiln_error *error)
{
    kiln_result result = KILN_OK;
    int rows = grid->height, width = 2 * rows;
    // The borders between panorama columns that a grid can cover, and one more on either end: from
    // -45 to 45 degrees around the grid's axis for a cube's side, else from 0 to 90 degrees.
    double step = 2 * KI_PI / width, eighth = width / 8.0;
    double low = grid->kind == KI_STENCIL_SIDE ? -eighth : 0;
    double high = grid->kind == KI_STENCIL_SIDE ? eighth : 2 * eighth;
    builder build = {.context = context, .grid = grid, .small = rows >= 4};
    build.first_border = (int)floor(low + grid->offset) - 1;
    build.end_border = (int)floor(high + grid->offset) + 3;
    size_t borders = (size_t)(build.end_border - build.first_border), edges = (size_t)rows + 1;
    double *table = ki_alloc_raw(context, 2 * (borders + edges), sizeof *table);
    grid->chunk_count = (ki_stencil_grid_rows(grid) + KI_STENCIL_ROWS - 1) / KI_STENCIL_ROWS;
    grid->chunks = ki_alloc(context, (size_t)grid->chunk_count, sizeof *grid->chunks);
    if (!table || !grid->chunks) {
        result = ki_fail_memory(context, error, "resampling",
                                2 * (borders + edges) * sizeof *table +
                                    (size_t)grid->chunk_count * sizeof *grid->chunks);
        goto done;
    }
    double *height = table, *cotangent = height + edges, *cosine = cotangent + edges;
    double *sine = cosine + borders;
    for (int j = 0; 2 * j <= rows; j++) {
        double s, c;
        ki_sincos(KI_PI * j / rows, &s, &c);
        c = 2 * j == rows ? 0 : c;
        height[j] = c;
        height[rows - j] = -c;
        cotangent[j] = j ? c / s : 1e300;
        cotangent[rows - j] = -cotangent[j];
    }
    for (size_t k = 0; k < borders; k++)
        ki_sincos((build.first_border + (double)k - grid->offset) * step, &sine[k], &cosine[k]);
    build.height = height;
    build.cotangent = cotangent;
    build.cosine = cosine;
    build.sine = sine;
    if (!ki_parallel_steps(context, NULL, grid->chunk_count, build_chunk, &build))
        result = ki_fail_cancelled(error, "planning");
    for (int k = 0; k < grid->chunk_count; k++)
        if (grid->chunks[k].failed && !result)
            result = ki_fail_memory(context, error, "resampling",
                                    grid->chunks[k].weight_room * sizeof(float));
done:
    ki_free(table);
    if (result)
        ki_stencil_grid_free(grid);
    return result;
}

// Task of one thread: lists the stencils of one chunk by their depths, unless they are listed.
static void order_chunk(void *data, int index)
{
    const builder *b = data;
    ki_stencil_chunk *chunk = &b->grid->chunks[index];
    const ki_stencil *stop = chunk->stencils + chunk->stencil_count;
    int height = b->grid->height, least = height, most = 0;
    if (chunk->by_depth)
        return;
    for (const ki_stencil *s = chunk->stencils; s < stop; s++) {
        int depth = ki_stencil_depth(s->row, s->rows, height);
        least = ki_min(least, depth);
        most = ki_max(most, depth);
    }
    // place[depth - least]: the number of stencils that come before the next one of this depth
    size_t depths = (size_t)(most - least) + 1;
    size_t *place = ki_alloc(b->context, depths + 1, sizeof *place);
    chunk->by_depth = ki_alloc_raw(b->context, chunk->stencil_count, sizeof *chunk->by_depth);
    chunk->failed = !place || !chunk->by_depth;
    if (chunk->failed) {
        ki_free(place);
        ki_free(chunk->by_depth);
        chunk->by_depth = NULL;
        return;
    }
    for (const ki_stencil *s = chunk->stencils; s < stop; s++)
        place[ki_stencil_depth(s->row, s->rows, height) - least + 1]++;
    for (size_t k = 0; k < depths; k++)
        place[k + 1] += place[k];
    uint32_t blocks = 0;
    const ki_stencil *s = chunk->stencils;
    for (int j = index * KI_STENCIL_ROWS; s < stop; j++) {
        int i, end;
        ki_stencil_grid_range(b->grid, j, &i, &end);
        for (; i < end; i++, s++) {
            chunk->by_depth[place[ki_stencil_depth(s->row, s->rows, height) - least]++] =
                (ki_stencil_entry){(uint32_t)(s - chunk->stencils), blocks, i, j};
            blocks += (uint32_t)s->rows * s->blocks;
        }
    }
    ki_free(place);
}

kiln_result ki_stencil_grid_order(kiln_context *context, ki_stencil_grid *grid, kiln_error *error)
{
    builder build = {.context = context, .grid = grid};
    if (!ki_parallel_steps(context, NULL, grid->chunk_count, order_chunk, &build))
        return ki_fail_cancelled(error, "planning");
    for (int k = 0; k < grid->chunk_count; k++)
        if (grid->chunks[k].failed)
            return ki_fail_memory(context, error, "resampling",
                                  grid->chunks[k].stencil_count * sizeof(ki_stencil_entry));
    return KILN_OK;
}

void ki_stencil_grid_free(ki_stencil_grid *grid)
{
    for (int k = 0; grid->chunks && k < grid->chunk_count; k++) {
        ki_free(grid->chunks[k].stencils);
        ki_free(grid->chunks[k].weights);
        ki_free(grid->chunks[k].by_depth);
    }
    ki_free(grid->chunks);
    grid->chunks = NULL;
    grid->chunk_count = 0;
}
