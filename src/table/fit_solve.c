// Fits one polynomial P or quotient P / Q of given shape to values at nodes. In: the nodes, the
// shape (numbers of coefficients in x and y), the number of rounds. Out: coefficients as floats.
// Method: each round solves a weighted linear least-squares problem in products of Chebyshev
// polynomials. Sanathanan and Koerner's iteration makes the residual of a quotient linear, and
// Lawson's weights turn least squares into a small greatest error. A last step proves Q > 0.
// docs/theory/fits.md.
#include "math/math.h"
#include "table/fit.h"

#include <math.h>

enum { MAX_TERMS = KILN_MAX_FIT_TERMS };

// The value that the denominator Q of a fit must exceed for all x and y in [-1, 1]. Q has a
// constant term of 1.
static const double LEAST_Q = 0.01;

// Sets t[] to the Chebyshev polynomials T_0(x) to T_{count-1}(x).
static void chebyshev(double x, int count, double *t)
{
    for (int i = 0; i < count; i++)
        t[i] = i == 0 ? 1 : i == 1 ? x : 2 * x * t[i - 1] - t[i - 2];
}

// Converts the Chebyshev series sum c[i * stride] T_i(x) to coefficients of powers of x, in place,
// by Clenshaw's recurrence on polynomials.
static void to_powers(double *c, int count, size_t stride)
{
    // the polynomials b_{k+1} and b_{k+2} of the recurrence
    double b1[MAX_TERMS + 1] = {0}, b2[MAX_TERMS + 1] = {0};
    for (int k = count - 1; k >= 0; k--) {
        double b[MAX_TERMS + 1];
        for (int i = 0; i <= MAX_TERMS; i++)
            b[i] = (i ? (k ? 2 : 1) * b1[i - 1] : 0) - b2[i];
        b[0] += c[(size_t)k * stride];
        for (int i = 0; i <= MAX_TERMS; i++) {
            b2[i] = b1[i];
            b1[i] = b[i];
        }
    }
    for (int i = 0; i < count; i++)
        c[(size_t)i * stride] = b1[i];
}

// Converts a series in products of Chebyshev polynomials, T_i(x) T_j(y), to coefficients of powers
// of x and y, multiplies them by `scale` and rounds them to floats.
static void round_powers(const kiln_fit_part *part, double *c, float *rounded, double scale)
{
    size_t stride = (size_t)part->x_count;
    for (int j = 0; j < part->y_count; j++)
        to_powers(c + (size_t)j * stride, part->x_count, 1);
    for (int i = 0; i < part->x_count; i++)
        to_powers(c + i, part->y_count, stride);
    for (int i = 0; i < part->x_count * part->y_count; i++)
        rounded[i] = (float)(c[i] * scale);
}

// The weighted linear least-squares problem that one round of the fit solves, with the coefficients
// of the quotient P / Q as unknowns.
typedef struct equations {
    const ki_fit_points *nodes;
    int terms;      // number of coefficients of P, and of Q together with its constant 1
    int columns;    // number of unknowns: the coefficients of P, and of Q without its constant 1
    int rows;       // number of equations: one for each node, and one for each unknown of Q
    double *matrix; // coefficients of the unknowns in the equations, column after column
    // first the right-hand side of each equation; after a round, the absolute error at each node
    double *right;
    double *weight;      // weight of each node's squared error, with sum 1
    double *denominator; // denominator Q of the previous round at each node
    double *basis;       // products of Chebyshev polynomials T_i(x) T_j(y), `terms` for each node
    double ridge; // weight of equations that draw the coefficients of Q to 0, to keep Q positive
} equations;

// Sets up the equations of a round. That of a node with value f is sqrt(weight) / Q_previous * (P -
// f Q) = 0, where Q = 1 + ... Dividing by Q_previous, the Q of the round before, turns P - f Q into
// the true residual P / Q - f once the rounds have converged (Sanathanan and Koerner 1963).
static void fill(const equations *s)
{
    const ki_fit_points *nodes = s->nodes;
    for (int i = 0; i < nodes->count; i++) {
        double w = sqrt(s->weight[i]) / s->denominator[i];
        const double *t = s->basis + (size_t)i * (size_t)s->terms;
        for (int k = 0; k < s->terms; k++)
            s->matrix[k * s->rows + i] = w * t[k];
        for (int k = s->terms; k < s->columns; k++)
            s->matrix[k * s->rows + i] = -w * nodes->value[i] * t[k - s->terms + 1];
        s->right[i] = w * nodes->value[i];
    }
    for (int i = nodes->count; i < s->rows; i++) {
        for (int k = 0; k < s->columns; k++)
            s->matrix[k * s->rows + i] = k - s->terms == i - nodes->count ? s->ridge : 0;
        s->right[i] = 0;
    }
}

// Evaluates P / Q with the coefficients x at the nodes: writes each node's error to `right` and its
// Q to `denominator`. Returns the greatest error. If Q is not above 2 LEAST_Q at every node,
// returns infinity and writes nothing.
static double judge(const equations *s, const double *x)
{
    const ki_fit_points *nodes = s->nodes;
    double largest = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < nodes->count; i++) {
            const double *t = s->basis + (size_t)i * (size_t)s->terms;
            double p = 0, q = 1;
            for (int k = s->terms; k < s->columns; k++)
                q += x[k] * t[k - s->terms + 1];
            if (!(q > 2 * LEAST_Q))
                return HUGE_VAL;
            if (pass == 0)
                continue;
            for (int k = 0; k < s->terms; k++)
                p += x[k] * t[k];
            s->denominator[i] = q;
            s->right[i] = fabs(p / q - nodes->value[i]);
            largest = s->right[i] > largest ? s->right[i] : largest;
        }
    return largest;
}

// Lawson's rule (1961): multiplies the weight of each node by the square root of the node's error,
// and scales the weights to the sum 1.
static void reweight(const equations *s)
{
    double sum = 0;
    for (int i = 0; i < s->nodes->count; i++)
        sum += s->weight[i] * s->right[i];
    double all = 0;
    for (int i = 0; i < s->nodes->count && sum > 0; i++)
        s->weight[i] *= sqrt(s->right[i] / sum), all += s->weight[i];
    for (int i = 0; i < s->nodes->count && sum > 0; i++)
        s->weight[i] /= all;
}

// number of reweighted rounds after which a shape whose error is still too large is given up
enum { PATIENCE = 12 };

double ki_fit_solve(const ki_fit_points *nodes, int rounds, double wanted, double *scratch,
                    kiln_fit_part *part)
{
    int count = nodes->count, terms = part->x_count * part->y_count;
    int columns = part->rational ? 2 * terms - 1 : terms;
    equations s = {.nodes = nodes,
                   .terms = terms,
                   .columns = columns,
                   .rows = count + columns - terms,
                   .basis = scratch};
    s.matrix = s.basis + (size_t)terms * (size_t)count;
    s.right = s.matrix + (size_t)columns * (size_t)s.rows;
    s.weight = s.right + s.rows;
    s.denominator = s.weight + count;
    for (int i = 0; i < count; i++) {
        double tx[MAX_TERMS] = {0}, ty[MAX_TERMS] = {0};
        chebyshev(nodes->x[i], part->x_count, tx);
        chebyshev(nodes->y[i], part->y_count, ty);
        for (int k = 0; k < terms; k++)
            s.basis[i * terms + k] = tx[k % part->x_count] * ty[k / part->x_count];
        s.weight[i] = 1.0 / count;
        s.denominator[i] = 1;
    }
    double x[2 * KILN_MAX_FIT] = {0}, best[2 * KILN_MAX_FIT] = {0}, least = HUGE_VAL, floor = 0;
    int first = part->rational ? 6 : 1; // number of rounds in which all nodes have equal weights
    for (int round = 0; round < first + rounds; round++) {
        if (round == first + PATIENCE && least > 1.7 * wanted)
            break;
        fill(&s);
        if (!ki_least_squares(s.matrix, s.right, s.rows, columns, x))
            break;
        double largest = judge(&s, x);
        if (largest == HUGE_VAL) {
            floor = s.ridge * 1.5;
            s.ridge = s.ridge > 0 ? 3 * s.ridge : 1e-4;
            continue;
        }
        s.ridge = 0.9 * s.ridge > floor ? 0.9 * s.ridge : floor;
        if (round >= first - 1)
            reweight(&s);
        if (largest < least) {
            least = largest;
            for (int k = 0; k < columns; k++)
                best[k] = x[k];
        }
    }
    if (!(least < HUGE_VAL))
        return HUGE_VAL;
    double q[KILN_MAX_FIT] = {1}, scale = 1;
    for (int k = 1; part->rational && k < terms; k++)
        q[k] = best[terms + k - 1];
    if (part->rational) {
        round_powers(part, q, part->q, 1);
        scale = 1 / q[0];
        for (int k = 0; k < terms; k++)
            part->q[k] = (float)(q[k] * scale);
    }
    round_powers(part, best, part->p, scale);
    return least;
}

// ---------------------------------------------------------------------------------------- no poles

enum { DEPTH = 12 };

// Returns true if the denominator q = Q(x, y) > LEAST_Q is proven on the square of half width h
// about (x, y). `slope` is an upper bound of |dq/dx| + |dq/dy|. A square for which the bound does
// not suffice is divided in four, up to `depth` times.
static bool proven(const kiln_fit_part *part, double slope, double x, double y, double h, int depth)
{
    double q = 0;
    for (int j = part->y_count - 1; j >= 0; j--) {
        double row = 0;
        for (int i = part->x_count - 1; i >= 0; i--)
            row = row * x + (double)part->q[j * part->x_count + i];
        q = q * y + row;
    }
    if (q - slope * h > LEAST_Q)
        return true;
    if (depth == 0 || !(q > LEAST_Q))
        return false;
    double k = h / 2;
    return proven(part, slope, x - k, y - k, k, depth - 1) &&
           proven(part, slope, x + k, y - k, k, depth - 1) &&
           proven(part, slope, x - k, y + k, k, depth - 1) &&
           proven(part, slope, x + k, y + k, k, depth - 1);
}

bool ki_fit_positive(const kiln_fit_part *part)
{
    if (!part->rational)
        return true;
    double slope = 0; // upper bound of |dQ/dx| + |dQ/dy| for |x|, |y| <= 1
    for (int k = 0; k < part->x_count * part->y_count; k++) {
        int degrees = k % part->x_count + k / part->x_count;
        slope += degrees * fabs((double)part->q[k]);
    }
    return proven(part, slope, 0, 0, 1, DEPTH);
}
