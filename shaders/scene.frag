// Draws the scenes of `kiln render` and `kiln view`, balls under a light or a baked environment.
// In: the uniform block View, filled by viewer/, environment cubemaps and tables. Out: the colour
// of a pixel. Each pixel casts n x n rays, shades the nearest ball that each ray meets, and
// tone-maps the mean of their radiance once. docs/theory/realtime.md describes the shading.

#include "brdf.glsl"
#include "kulla_conty.glsl"
#include "ibl.glsl"
#include "lobes.glsl"
#include "disc.glsl"
#include "tone.glsl"

// Names of scenes, methods of compensation, debug views, tone curves and ways to look reflections
// up. The values are those of viewer/viewer.h.
const int SCENE_ASSIGNMENT = 0, SCENE_FURNACE = 2, SCENE_COMPARE = 4;
const int METHOD_KULLA_CONTY = 1, METHOD_HANDOUT = 2, METHOD_FDEZ_AGUERA = 3, METHOD_TURQUIN = 4;
const int DEBUG_LEVEL = 1, DEBUG_TABLE_E = 2, DEBUG_TABLE_E_AVERAGE = 3, DEBUG_TABLE_SPLIT = 4,
          DEBUG_E = 5, DEBUG_F = 6;
const int TONE_LINEAR = 0, TONE_ASSIGNMENT = 2;
const int REFLECTIONS_STRAIGHT = 0, REFLECTIONS_BENT = 1, REFLECTIONS_ONE = 2;
const int MAX_BALLS = 64, MAX_DISCS = 64, CANDIDATES = 8;

layout(std140) uniform View
{
    vec4 eye;                 // position of the camera
    vec4 right;               // unit vector; w: tan(fov / 2) times width / height
    vec4 up;                  // unit vector; w: tan(fov / 2), fov being the vertical field of view
    vec4 back;                // unit vector against the view; w: the exposure, a factor to radiance
    vec4 light;               // direction to the light; w: its radiance
    vec4 turn;                // cosine and sine of the environment's rotation; place of the handle
                              // between two compared halves, 0 to 1; roughness of the background
    vec4 screen;              // width, height; z: one of the names REFLECTIONS
    vec4 handout_average; // copper's albedo, which figure 6 of the GAMES202 handout uses as E_avg
    ivec4 mode;               // scene, debug view, rays along a pixel's side, number of balls
    ivec4 flags;              // tone curve; 1 to draw figure 6 as printed; 1 with occlusion; 1 to
                              // take diffuse light from a cubemap instead of harmonics
    ivec4 levels;             // number of levels of the two environments; level that DEBUG_LEVEL
                              // shows; 1 to show debug tables of the handout's model
    vec4 table_layout[8];     // layouts (see table_place) of E, E_avg and the split sum of the
                              // handout's model, of the same three of the environment's model, of
                              // edge_sum, and of the tables of lobes
    vec4 level_roughness[8];  // roughness of the levels of the two environments, 16 numbers each
    vec4 harmonics[18];       // 9 coefficients of each of the two environments
    vec4 balls[5 * MAX_BALLS]; // of each ball: centre, radius; f0, roughness; F_avg, method;
                               // albedo, metallic; f82
    vec4 discs[2 * MAX_DISCS]; // of each disc of light: direction, sine of the angular radius;
                               // radiance
    vec4 ground;               // height and albedo of the ground; 1 with a ground; number of discs
};

uniform highp samplerCube environment, environment_textbook, irradiance;
uniform highp sampler2D handout_e, handout_e_average, handout_split;
uniform highp sampler2D e, e_average, split_sum, edge_sum;
// tables of lobes for the levels of the two environments
uniform highp sampler2D lobes, lobes_textbook;

out vec4 color;

struct Ball
{
    vec3 centre;
    float radius;
    vec3 f0;
    float roughness;
    vec3 f_average;
    int method;
    vec3 albedo;
    vec3 f82;
};

Ball ball_at(int i)
{
    vec4 a = balls[5 * i], b = balls[5 * i + 1], c = balls[5 * i + 2], d = balls[5 * i + 3];
    return Ball(a.xyz, a.w, b.xyz, b.w, c.xyz, int(c.w), d.xyz, balls[5 * i + 4].xyz);
}

// ---------------------------------------------------------------------------------------- the light

// Rotates a direction d of the scene into the environment's own frame.
vec3 turned(vec3 d)
{
    return vec3(d.x * turn.x - d.z * turn.y, d.y, d.z * turn.x + d.x * turn.y);
}

// Radiance of a mip level of environment `slot`, 0 or 1, in direction d of the environment's frame.
vec3 level_seen(int slot, vec3 d, float level)
{
    if (mode.x == SCENE_FURNACE)
        return vec3(1.0);
    return slot == 0 ? textureLod(environment, d, level).rgb
                     : textureLod(environment_textbook, d, level).rgb;
}

// Radiance of environment `slot` in direction d of the scene, filtered for a roughness.
vec3 environment_seen(int slot, vec3 d, float roughness)
{
    vec4 of_level[4];
    for (int i = 0; i < 4; i++)
        of_level[i] = level_roughness[4 * slot + i];
    return level_seen(slot, turned(d), environment_level(of_level, levels[slot], roughness));
}

// Harmonics of the radiance of environment `slot`.
void harmonics_of(int slot, out vec3 c[9])
{
    for (int i = 0; i < 9; i++)
        c[i] = harmonics[9 * slot + i].rgb;
    if (mode.x == SCENE_FURNACE) {
        c[0] = vec3(2.0 * sqrt(PI));
        for (int i = 1; i < 9; i++)
            c[i] = vec3(0.0);
    }
}

// Irradiance over pi of a surface with the normal n.
vec3 irradiance_at(int slot, vec3 n)
{
    if (mode.x == SCENE_FURNACE)
        return vec3(1.0);
    vec3 to = turned(n);
    if (flags.w != 0)
        return textureLod(irradiance, to, 0.0).rgb;
    vec3 c[9];
    harmonics_of(slot, c);
    return max(sh_irradiance(c, to), 0.0);
}

// The share of diffuse light that reaches point p of ball `self` past the other balls.
float occlusion_at(int self, vec3 p, vec3 n)
{
    float open = 1.0;
    for (int i = 0; i < mode.w; i++)
        if (i != self)
            open *= ball_occlusion(n, balls[5 * i].xyz - p, balls[5 * i].w);
    return open;
}

// Radiance of the discs of light that are seen in direction d.
vec3 discs_seen(vec3 d)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < int(ground.w); i++) {
        vec4 disc = discs[2 * i];
        float chord2 = 2.0 * disc.w * disc.w / (1.0 + sqrt((1.0 - disc.w) * (1.0 + disc.w)));
        vec3 from = d - disc.xyz;
        if (dot(from, from) < chord2)
            sum += discs[2 * i + 1].rgb;
    }
    return sum;
}

// The part of a disc of light that point p of ball `self` sees past the other balls. Where several
// balls hide parts, the parts are taken as independent, as in occlusion_at: docs/lights.md has the
// error.
float disc_open(vec4 disc, int self, vec3 p)
{
    float open = 1.0;
    for (int i = 0; i < mode.w; i++)
        if (i != self)
            open *= 1.0 - disc_hidden(disc.xyz, disc.w, balls[5 * i].xyz - p, balls[5 * i].w);
    return open;
}

// --------------------------------------------------------------------------------------- reflection

// Radiance towards v from one directional light: by the microfacet lobe and, with two of the
// methods, by Kulla and Conty's lobe added to it.
vec3 lit_by_light(Ball ball, vec3 n, vec3 v, float nov)
{
    vec3 l = light.xyz, h = normalize(v + l);
    float nol = max(dot(n, l), 0.0), noh = max(dot(n, h), 0.0), voh = max(dot(v, h), 0.0);
    float alpha = ball.roughness * ball.roughness;
    vec3 f = ball.f0 + (1.0 - ball.f0) * schlick_fresnel(voh);
    float g = smith_g_schlick(schlick_k_ibl(alpha), nov, nol);
    vec3 lobe = f * (ggx_d(alpha, noh) * g / max(4.0 * nol * nov, 0.001));
    if (ball.method == METHOD_KULLA_CONTY || ball.method == METHOD_HANDOUT) {
        float o = table_missing(handout_e, table_layout[0], nov, ball.roughness);
        float i = table_missing(handout_e, table_layout[0], nol, ball.roughness);
        float a = table_missing(handout_e_average, table_layout[1], 0.0, ball.roughness);
        int form = ball.method == METHOD_HANDOUT ? F_ADD_ASSIGNMENT : F_ADD_BOUNCES;
        if (flags.y != 0) {
            // Figure 6 of the handout as printed: its sampler of E_avg is unbound and reads the
            // albedo.
            vec3 wrong = handout_average.rgb;
            lobe += o * i / (PI * (1.0 - wrong)) * kulla_conty_fresnel(form, ball.f_average, wrong);
        } else {
            lobe += kulla_conty_missing(o, i, a) *
                    kulla_conty_fresnel(form, ball.f_average, vec3(1.0 - a));
        }
    }
    return lobe * nol * light.w;
}

// The parts of uniform light that a ball reflects towards a direction.
struct Albedo
{
    vec3 single;   // by one bounce between microfacets: f0 A + B - edge C, C being for metals
    vec3 gain;     // the factor on one bounce that `single` contains, from Turquin's method
    vec3 multiple; // by further bounces
    vec3 base;     // by the diffuse base, which light reaches that is not reflected before
    vec3 lobe;     // of Kulla and Conty's methods: F of the further bounces
};

Albedo albedo_at(Ball ball, float nov)
{
    vec2 ab = table_read(split_sum, table_layout[5], nov, ball.roughness).rg;
    float missing = table_missing(e, table_layout[3], nov, ball.roughness);
    float edge = table_read(edge_sum, table_layout[6], nov, ball.roughness).r;
    Albedo to;
    to.single = ball.f0 * ab.x + ab.y - f82_edge(ball.f0, ball.f82) * edge;
    to.multiple = to.lobe = vec3(0.0);
    to.gain = vec3(1.0);
    if (ball.method == METHOD_KULLA_CONTY || ball.method == METHOD_HANDOUT) {
        float a = table_missing(e_average, table_layout[4], 0.0, ball.roughness);
        int form = ball.method == METHOD_HANDOUT ? F_ADD_ASSIGNMENT : F_ADD_BOUNCES;
        to.lobe = kulla_conty_fresnel(form, ball.f_average, vec3(1.0 - a));
        to.multiple = to.lobe * missing;
    } else if (ball.method == METHOD_FDEZ_AGUERA) {
        // The formula of fdez_aguera() with this metal's F_avg in place of Schlick's average.
        vec3 bounces = kulla_conty_fresnel(F_ADD_ASSIGNMENT, ball.f_average, vec3(ab.x + ab.y));
        to.multiple = to.single * bounces * ((1.0 - ab.x - ab.y) / (ab.x + ab.y));
    } else if (ball.method == METHOD_TURQUIN) {
        to.gain = turquin(ball.f0, 1.0 - missing);
        to.single *= to.gain;
    }
    to.base = ball.albedo * (1.0 - to.single - to.multiple);
    return to;
}

// Radiance that a mirror-like surface of this roughness shows: the factor of the split sum's albedo.
vec3 reflected(int slot, vec3 n, vec3 v, float nov, float roughness)
{
    int way = int(screen.z), count = way - REFLECTIONS_ONE + 1;
    vec3 r = 2.0 * nov * n - v;
    if (way == REFLECTIONS_BENT)
        r = bent_reflection(n, r, roughness);
    if (count < 1)
        return environment_seen(slot, r, roughness);
    Lobes found; // WebGL has no ternary operator for structures
    if (slot == 0)
        found = lobes_at(lobes, table_layout[7], count, nov, roughness);
    else
        found = lobes_at(lobes_textbook, table_layout[7], count, nov, roughness);
    vec3 t = turned(lobe_tangent(n, v, nov)), normal = turned(n), sum = vec3(0.0), c[9];
    vec3 lowest = vec3(1e30);
    harmonics_of(slot, c);
    for (int k = 0; k < count; k++) {
        vec4 tap = found.tap[k];
        vec3 seen = level_seen(slot, lobe_direction(normal, t, nov, tap.x), tap.y);
        sum += tap.z * seen;
        lowest = min(lowest, seen);
    }
    return lobes_sum(sum, lobes_rest(c, normal, t, found.rest), lowest, found.rest[5]);
}

// Radiance towards v from the environment. The specular part is the split sum: prefiltered radiance
// times the lobe's albedo. Light of further bounces is added as diffuse light. `open` is the share
// of diffuse light that other balls leave.
vec3 lit_by_environment(int slot, Ball ball, Albedo to, vec3 n, vec3 v, float nov, float open)
{
    vec3 mirrored = reflected(slot, n, v, nov, ball.roughness);
    vec3 around = irradiance_at(slot, n) * open;
    float specular_open = open < 1.0 ? specular_occlusion(nov, open, ball.roughness) : 1.0;
    return mirrored * to.single * specular_open + around * (to.multiple + to.base);
}

// The single-scattering lobe times n.l, integrated over a disc around l, which is cut by the
// horizon. v and l are given in a frame whose z axis is the normal. GGX is integrated over the disc;
// the other factors are taken at one direction, which is the mirror direction or the disc's point
// nearest to it where the lobe is narrower than the disc, and the disc's centre where the lobe is
// wider. A disc that the horizon cuts is replaced by one that touches the horizon, has the height of
// the part above the horizon, and shines as much as that part.
vec3 disc_specular(Ball ball, vec3 v, vec3 l, float sine)
{
    float size = 0.5 * (min(l.z, sine) + sine), share = 1.0;
    if (l.z < sine) {
        share = disc_part(l.z / sine) * (sine * sine) / (size * size);
        float low = 1.0 - l.z * l.z;
        l = vec3(l.xy * sqrt((1.0 - size * size) / low), size);
    }
    // a lobe much narrower than the disc is widened to what ggx_disc can resolve
    float alpha = max(ball.roughness * ball.roughness, 0.06 * size);
    vec3 mirror = vec3(-v.xy, v.z), to = mirror - dot(mirror, l) * l, point = mirror;
    float off = length(to);
    if (off > size || dot(mirror, l) < 0.0)
        point = l * sqrt(1.0 - size * size) + to * (size / max(off, 1e-6));
    point = normalize(mix(l, point, size * size / (size * size + 4.0 * alpha * alpha)));
    vec3 h = normalize(v + point);
    float voh = dot(v, h), nol = max(point.z, 1e-5);
    vec3 f = fresnel_f82(ball.f0, ball.f82, clamp(voh, 0.0, 1.0));
    return f * (share * ggx_disc(alpha, v, l, size) * visibility(SMITH, ball.roughness, v.z, nol) *
                nol * voh / h.z);
}

// Radiance towards v from the discs of light. `self` is the index of the ball, which other balls
// shade with occlusion.
vec3 lit_by_discs(Ball ball, Albedo to, int self, vec3 n, vec3 p, vec3 v, float nov)
{
    vec3 sum = vec3(0.0), t = normalize(abs(n.y) < 0.9 ? vec3(n.z, 0.0, -n.x) : vec3(0.0, n.z, -n.y));
    vec3 b = cross(n, t), diffuse = to.base;
    bool lobe = ball.method == METHOD_KULLA_CONTY || ball.method == METHOD_HANDOUT;
    if (ball.method == METHOD_FDEZ_AGUERA)
        diffuse += to.multiple;
    for (int i = 0; i < int(ground.w); i++) {
        vec4 disc = discs[2 * i];
        vec3 l = vec3(dot(t, disc.xyz), dot(b, disc.xyz), dot(n, disc.xyz));
        if (l.z <= -disc.w)
            continue;
        float cosine = disc_cosine(l.z, disc.w);
        vec3 f = diffuse;
        if (lobe) {
            float o = table_missing(e, table_layout[3], nov, ball.roughness);
            float i = table_missing(e, table_layout[3], cosine, ball.roughness);
            float a = table_missing(e_average, table_layout[4], 0.0, ball.roughness);
            f += PI * kulla_conty_missing(o, i, a) * to.lobe;
        }
        f *= cosine * disc.w * disc.w;
        vec3 w = vec3(dot(t, v), dot(b, v), nov);
        f += to.gain * disc_specular(ball, w, l, disc.w);
        sum += f * discs[2 * i + 1].rgb * (flags.z != 0 ? disc_open(disc, self, p) : 1.0);
    }
    return sum;
}

// Radiance of point p of the matte ground, which the balls shade.
vec3 ground_at(int slot, vec3 p)
{
    const vec3 up = vec3(0.0, 1.0, 0.0);
    vec3 sum = irradiance_at(slot, up) * occlusion_at(-1, p, up);
    for (int i = 0; i < int(ground.w); i++) {
        vec4 disc = discs[2 * i];
        if (disc.y > -disc.w)
            sum += discs[2 * i + 1].rgb *
                   (disc.w * disc.w * disc_cosine(disc.y, disc.w) * disc_open(disc, -1, p));
    }
    return ground.y * sum;
}

// ------------------------------------------------------------------------------------------ picture

// Returns the index of the first ball in `list` that a ray from the eye along d meets, or -1 if the
// ray meets none of them. Sets n to the normal, p to the point and nov to the cosine at the meeting
// point.
int nearest(int list[CANDIDATES], int count, vec3 d, out vec3 n, out vec3 p, out float nov)
{
    int found = -1;
    float reach = 1e30;
    for (int i = 0; i < count; i++) {
        vec4 ball = balls[5 * list[i]];
        vec3 from = eye.xyz - ball.xyz;
        float along = dot(from, d);
        vec3 closest = from - along * d;
        float rest = ball.w * ball.w - dot(closest, closest);
        if (rest <= 0.0)
            continue;
        float half_chord = sqrt(rest), t = -along - half_chord;
        if (t <= 0.0 || t >= reach)
            continue;
        reach = t;
        found = list[i];
        vec3 offset = closest - half_chord * d;
        n = offset / ball.w;
        p = ball.xyz + offset;
        nov = half_chord / ball.w;
    }
    return found;
}

// Radiance, or the value of a debug view, of point p of ball `index`.
vec3 shaded(int slot, int index, vec3 d, vec3 n, vec3 p, float nov)
{
    Ball ball = ball_at(index);
    if (mode.y == DEBUG_E) {
        float missing = levels.w != 0
                            ? table_missing(handout_e, table_layout[0], nov, ball.roughness)
                            : table_missing(e, table_layout[3], nov, ball.roughness);
        return vec3(1.0 - missing);
    }
    if (mode.y == DEBUG_F)
        return fresnel_f82(ball.f0, ball.f82, nov);
    if (mode.x == SCENE_ASSIGNMENT)
        return lit_by_light(ball, n, -d, nov);
    float open = flags.z != 0 ? occlusion_at(index, p, n) : 1.0;
    Albedo to = albedo_at(ball, nov);
    vec3 c = lit_by_environment(slot, ball, to, n, -d, nov, open);
    return ground.w > 0.0 ? c + lit_by_discs(ball, to, index, n, p, -d, nov) : c;
}

// The direction from the eye through the point `at` of the screen, in pixels.
vec3 direction_at(vec2 at)
{
    vec2 s = 2.0 * at / screen.xy - 1.0;
    return normalize(s.x * right.w * right.xyz + s.y * up.w * up.xyz - back.xyz);
}

// Radiance of what a ray from the eye along d sees past the balls.
vec3 behind(int slot, vec3 d)
{
    float above = eye.y - ground.x;
    if (ground.z > 0.0 && above > 0.0 && d.y < 0.0)
        return ground_at(slot, eye.xyz - d * (above / d.y));
    return environment_seen(slot, d, turn.w) + discs_seen(d);
}

// The mean over the rays of the pixel whose lower left corner is `corner`.
vec3 balls_at(vec2 corner, int slot)
{
    // Lists the balls that a ray of the pixel can meet: those that touch a cone about the pixel's
    // centre which is somewhat wider than the pixel.
    vec3 middle = direction_at(corner + 0.5);
    float spread = 2.0 * max(up.w / screen.y, right.w / screen.x);
    int list[CANDIDATES], count = 0;
    for (int i = 0; i < mode.w && count < CANDIDATES; i++) {
        vec3 from = eye.xyz - balls[5 * i].xyz;
        float along = dot(from, middle);
        float reach = balls[5 * i].w - along * spread;
        vec3 closest = from - along * middle;
        if (along < 0.0 && dot(closest, closest) < reach * reach)
            list[count++] = i;
    }
    vec3 sum = vec3(0.0);
    int side = mode.z;
    for (int i = 0; i < side * side; i++) {
        vec2 at = (vec2(i % side, i / side) + 0.5) / float(side);
        vec3 d = direction_at(corner + at), n, p;
        float nov;
        int hit = nearest(list, count, d, n, p, nov);
        if (hit >= 0)
            sum += shaded(slot, hit, d, n, p, nov);
        else if (mode.x != SCENE_ASSIGNMENT && mode.y == 0)
            sum += behind(slot, d);
    }
    return sum / float(side * side);
}

// Debug views that fill the screen: a level of the environment as a panorama, or a table. `at` is
// in [0, 1]^2.
vec3 chart_at(vec2 at)
{
    bool handout = levels.w != 0;
    if (mode.y == DEBUG_LEVEL) {
        float phi = 2.0 * PI * (at.x - 0.5), theta = PI * (1.0 - at.y);
        vec3 d = vec3(sin(theta) * sin(phi), cos(theta), -sin(theta) * cos(phi));
        return textureLod(environment, turned(d), float(levels.z)).rgb;
    }
    if (mode.y == DEBUG_TABLE_E)
        return vec3(1.0 - (handout ? table_missing(handout_e, table_layout[0], at.x, at.y)
                                   : table_missing(e, table_layout[3], at.x, at.y)));
    if (mode.y == DEBUG_TABLE_E_AVERAGE)
        return vec3(1.0 - (handout
                               ? table_missing(handout_e_average, table_layout[1], 0.0, at.y)
                               : table_missing(e_average, table_layout[4], 0.0, at.y)));
    vec2 ab = handout ? table_read(handout_split, table_layout[2], at.x, at.y)
                      : table_read(split_sum, table_layout[5], at.x, at.y);
    return vec3(ab, 0.0);
}

void main()
{
    vec2 corner = gl_FragCoord.xy - 0.5;
    bool chart = mode.y >= DEBUG_LEVEL && mode.y <= DEBUG_TABLE_SPLIT;
    bool values = mode.y > DEBUG_LEVEL; // values of tables are shown without a tone curve
    float handle = floor(turn.z * screen.x);
    int slot = mode.x == SCENE_COMPARE && corner.x >= handle ? 1 : 0;
    vec3 c = chart ? chart_at(gl_FragCoord.xy / screen.xy) : balls_at(corner, slot);
    if (flags.x != TONE_LINEAR && !values) {
        c *= back.w;
        c = flags.x == TONE_ASSIGNMENT ? tone_assignment(c) : srgb_encode(tone_neutral(c));
        if (mode.x == SCENE_COMPARE && !chart && abs(gl_FragCoord.x - handle) < 1.0)
            c = vec3(1.0);
    }
    color = vec4(c, 1.0);
}
