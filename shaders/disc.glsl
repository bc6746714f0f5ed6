// Light from discs, such as the sun: the part of a disc above the horizon, the reflection of a disc
// by GGX microfacets, and the part of a disc that a ball hides. A disc is a spherical cap of uniform
// radiance; `sine` is the sine of its angular radius. The functions use only their arguments, and
// docs/lights.md derives them.
// SPDX-License-Identifier: MIT

// acos for x in [0, 1], with an error below 2e-8 times sqrt(1 - x) (Abramowitz and Stegun 1964,
// 4.4.46). Drivers' own acos may err by 1e-4.
float arc_cosine(float x)
{
    float p = 1.5707963050 + x * (-0.2145988016 + x * (0.0889789874 + x * (-0.0501743046 +
              x * (0.0308918810 + x * (-0.0170881256 + x * (0.0066700901 - x * 0.0012624911))))));
    return sqrt(1.0 - x) * p;
}

// Area of the smaller segment of the unit circle beyond a chord at the distance u >= 0 from the
// centre: acos(u) - u x, with half the chord's length x = sqrt(1 - u^2). A power series in x
// replaces the difference, which cancels, for small x.
float circle_segment(float u, float x)
{
    float y = x * x;
    if (y > 0.25)
        return arc_cosine(u) - u * x;
    return x * y * (2.0 / 3.0 + y * (0.2 + y * (3.0 / 28.0 + y * (5.0 / 72.0 +
           y * (35.0 / 704.0 + y * (63.0 / 1664.0 + y * (77.0 / 2560.0)))))));
}

// The part of the unit disc's area above the line that lies u below the disc's centre; u in [-1, 1].
float disc_part(float u)
{
    float minor = circle_segment(abs(u), sqrt((1.0 - u) * (1.0 + u))) / 3.14159265;
    return u < 0.0 ? minor : 1.0 - minor;
}

// The mean of the cosine n.l over a disc whose centre has the cosine nol, where directions below the
// horizon count as 0. The disc is taken as flat when the horizon cuts through it.
float disc_cosine(float nol, float sine)
{
    float u = clamp(nol / sine, -1.0, 1.0), root = sqrt((1.0 - u) * (1.0 + u));
    float arc = u < 0.0 ? arc_cosine(-u) : 3.14159265 - arc_cosine(u);
    return nol >= sine ? nol : sine * (u * arc + root * (2.0 + u * u) / 3.0) / 3.14159265;
}

// The part of GGX microfacets, by projected area, that mirror light from the disc around l towards
// v: the integral of D (n.h) / (4 v.h) over the disc. v and l are unit vectors in a frame whose z
// axis is the normal, and the disc lies above the horizon. In the plane of slopes x = h.xy / h.z the
// integrand is alpha^2 / (pi (alpha^2 + x^2)^2), the curl of (-y, x) / (2 pi (alpha^2 + x^2)), so
// that the integral is one along the disc's border. e is the border's slope relative to the slope q
// of the centre; terms whose sum is 0 are left out because they would cancel in rounding.
float ggx_disc(float alpha, vec3 v, vec3 l, float sine)
{
    const int nodes = 48;
    const vec2 turn = vec2(0.9914448614, 0.1305261922); // cosine and sine of 2 pi / nodes
    float side = l.z < 0.0 ? -1.0 : 1.0, a = -1.0 / (side + l.z), a2 = alpha * alpha, sum = 0.0;
    vec3 t = sine * vec3(1.0 + side * l.x * l.x * a, side * l.x * l.y * a, -side * l.x);
    vec3 b = sine * vec3(l.x * l.y * a, side + l.y * l.y * a, -l.y);
    vec3 c = v + l * sqrt((1.0 - sine) * (1.0 + sine));
    vec2 q = c.xy / c.z, at = vec2(1.0, 0.0);
    float q2 = a2 + dot(q, q);
    for (int i = 0; i < nodes; i++) {
        vec3 o = at.x * t + at.y * b, along = at.x * b - at.y * t;
        vec2 e = (o.xy - q * o.z) / (c.z + o.z), x = q + e;
        vec2 d = (along.xy - x * along.z) / (c.z + o.z);
        float more = dot(e, e) + 2.0 * dot(q, e), x2 = q2 + more;
        sum += (e.x * d.y - e.y * d.x - (q.x * d.y - q.y * d.x) * more / q2) / x2;
        at = vec2(at.x * turn.x - at.y * turn.y, at.x * turn.y + at.y * turn.x);
    }
    return abs(sum) / float(nodes);
}

// The part of the disc around the unit vector l that a ball of radius r hides, whose centre is at
// `offset` from the point in the shadow. The stereographic projection from -l maps the borders of
// the disc and of the ball to circles: the disc's has the radius a = tan(half the angular radius),
// the ball's meets the line through both centres at `near` and `far`.
float disc_hidden(vec3 l, float sine, vec3 offset, float r)
{
    float d = length(offset), a = sine / (1.0 + sqrt((1.0 - sine) * (1.0 + sine)));
    float ball = r / (d + sqrt(max(d - r, 0.0) * (d + r)));
    float centre = length(offset - d * l) / max(length(offset + d * l), 1e-6 * d);
    float near = (centre - ball) / (1.0 + centre * ball);
    if (near >= a)
        return 0.0;
    float far = (centre + ball) / max(1.0 - centre * ball, 1e-3);
    float middle = 0.5 * (near + far), size = 0.5 * (far - near);
    if (near <= -a && far >= a)
        return 1.0;
    if (far <= a && near >= -a)
        return size * size / (a * a);
    // the chord through the two points where the circles meet, at `chord` from the disc's centre
    float chord = (a * a + near * far) / (2.0 * middle), u = clamp(chord / a, -1.0, 1.0);
    float from = (middle - chord) / size, w = a * sqrt((1.0 - u) * (1.0 + u)) / size;
    float minor = circle_segment(min(abs(from), 1.0), min(w, 1.0));
    float of_ball = from > 0.0 ? minor : 3.14159265 - minor;
    return disc_part(-u) + of_ball * size * size / (3.14159265 * a * a);
}
