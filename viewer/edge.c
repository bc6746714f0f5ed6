// The third term C of the split sum. Metals need it: their Fresnel reflectance is Schlick's minus
// edge voh (1 - voh)^6, which dips near 82 degrees. Their directional albedo is then F0 A + B -
// edge C with
//
//     C(n.v) = int D G / (4 n.v n.l) voh (1 - voh)^6 (n.l) dl
//            = int Dv(h) G / G1(v) voh (1 - voh)^6 dh
//
// Dv is the density of the visible normals h. A uniform grid on the spherical cap of Dupuy and
// Benyoub (2023) has that density.
#include "internal.h"

#include <math.h>

// SIZE: texels along each side of the table of C. ACROSS x DOWN: quadrature nodes on one half of
// the spherical cap, whose other half is its mirror image.
enum { SIZE = 48, ACROSS = 16, DOWN = 32 };

static double root(double alpha, double x)
{
    return sqrt(x * x + alpha * alpha * (1 - x) * (1 + x));
}

double view_edge(double roughness, double nov)
{
    double alpha = roughness * roughness, sum = 0;
    double sine = sqrt((1 - nov) * (1 + nov)), root_v = root(alpha, nov);
    if (alpha < 1e-6 || root_v <= 0)
        return nov * pow(1 - nov, 6);
    // the view v after the stretch that turns the surface's visible normals into those of a
    // hemisphere
    double sx = alpha * sine / root_v, sz = nov / root_v;
    for (int i = 0; i < DOWN; i++) {
        double z = (i + 0.5) / DOWN * (1 + sz) - sz, around = sqrt(fmax(0, (1 - z) * (1 + z)));
        for (int j = 0; j < ACROSS; j++) {
            double phi = 3.14159265358979324 * (j + 0.5) / ACROSS;
            double x = alpha * (around * cos(phi) + sx), y = alpha * around * sin(phi), up = z + sz;
            double size = sqrt(x * x + y * y + up * up);
            double voh = fmin((x * sine + up * nov) / size, 1), nol = 2 * voh * up / size - nov;
            if (nol <= 0)
                continue;
            double shown = nol * (nov + root_v) / (nol * root_v + nov * root(alpha, nol));
            double c = 1 - voh, c2 = c * c;
            sum += shown * voh * (c2 * c2 * c2);
        }
    }
    return sum / (ACROSS * DOWN);
}

kiln_result view_edge_create(kiln_context *context, kiln_table *table, kiln_error *error)
{
    const kiln_table_def def = {
        .width = SIZE, .height = SIZE, .axis = KILN_AXIS_SQRT, .corners = true};
    kiln_result result = kiln_table_create(context, &def, table, error);
    for (int i = 0; i < SIZE * SIZE && result == KILN_OK; i++) {
        double nov, roughness, none;
        kiln_table_texel(table, i % SIZE, i / SIZE, 0, &nov, &roughness, &none);
        table->image.pixels[i] = (float)view_edge(roughness, nov);
    }
    return result;
}
