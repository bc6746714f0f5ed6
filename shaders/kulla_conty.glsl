// Compensation of the energy that a specular lobe of a single bounce loses (Kulla and Conty 2017,
// Turquin 2019, Fdez-Aguera 2019), and functions that read the tables that `kiln tables` writes.
// Include brdf.glsl before this file. The functions of compensation have the names, without prefix,
// of kiln's C functions in src/brdf/compensate.c.
// SPDX-License-Identifier: MIT

// Names of the factor that colours Kulla and Conty's lobe, where f is F_avg, the average
// reflectance of a microfacet, and E is E_avg, the average albedo of the lobe with F = 1. The
// values are those of kiln's enum kiln_f_add.
const int F_ADD_BOUNCES = 0;    // f^2 E / (1 - f (1 - E)): the bounces from the second on
const int F_ADD_ASSIGNMENT = 1; // f E / (1 - f (1 - E)), as GAMES202 teaches: counts the first
                                // bounce too

// Kulla and Conty's lobe for F = 1, a view o and a light i, from the albedo E of the specular lobe.
// The arguments are 1 - E(o), 1 - E(i) and 1 - E_avg, because a table of 1 - E keeps its precision
// where E is near 1.
float kulla_conty_missing(float missing_o, float missing_i, float missing_average)
{
    return missing_average > 0.0 ? missing_o * missing_i / (PI * missing_average) : 0.0;
}

// Kulla and Conty's lobe for F = 1, from the albedos E(o) and E(i) of the specular lobe for view
// and light, and E_avg.
float kulla_conty(float e_o, float e_i, float e_average)
{
    return kulla_conty_missing(1.0 - e_o, 1.0 - e_i, 1.0 - e_average);
}

// The factor on Kulla and Conty's lobe for a material whose average reflectance F_avg is f.
vec3 kulla_conty_fresnel(int form, vec3 f, vec3 e_average)
{
    vec3 sum = f * e_average / max((1.0 - f) + f * e_average, 1e-30);
    return form == F_ADD_ASSIGNMENT ? sum : f * sum;
}

// Turquin's factor on the specular lobe, where e is the lobe's albedo E(n.v) for F = 1.
vec3 turquin(vec3 f0, float e)
{
    return 1.0 + f0 * (1.0 - e) / e;
}

// Fdez-Aguera's factors: `single` on prefiltered radiance, for the first bounce, and `multiple` on
// irradiance / pi, for the further bounces. a and b are A and B of the split sum.
void fdez_aguera(vec3 f0, float a, float b, out vec3 single, out vec3 multiple)
{
    vec3 f = (1.0 + 20.0 * f0) / 21.0;
    float e = a + b;
    single = f0 * a + b;
    multiple = single * f * (1.0 - e) / max((1.0 - f) + f * e, 1e-30);
}

// ------------------------------------------------------------------------------------------ tables

// Names of the axis along which a table has n.v. The first four values are those of kiln's enum
// kiln_axis; AXIS_GRAZING_TEXT is KILN_AXIS_GRAZING of a table for SCHLICK_TEXT.
const int AXIS_LINEAR = 0, AXIS_SQRT = 1, AXIS_CBRT = 2, AXIS_GRAZING = 3, AXIS_GRAZING_TEXT = 4;

// The place u in [0, 1] of n.v along a table's axis, which is named by an AXIS_ constant.
float table_axis(int axis, float nov, float roughness)
{
    if (axis == AXIS_LINEAR)
        return nov;
    if (axis == AXIS_SQRT)
        return sqrt(nov);
    if (axis == AXIS_CBRT)
        return pow(nov, 1.0 / 3.0);
    float k = schlick_k_direct(roughness);
    float c = axis == AXIS_GRAZING_TEXT ? k / (1.0 - k) : roughness * roughness;
    return nov > 0.0 ? sqrt(nov * (1.0 + c) / (nov + c)) : 0.0;
}

// The place of n.v and roughness in a table, in units of texels whose centres are whole numbers.
// layout_ has four fields of the table's kiln_table_def as numbers: vec4(axis, corners, complement,
// flip). n.v runs along x, roughness along y.
vec2 table_place(vec4 layout_, ivec2 size, float nov, float roughness)
{
    float u = table_axis(int(layout_.x), nov, roughness);
    float v = layout_.w > 0.5 ? 1.0 - roughness : roughness;
    vec2 last = vec2(size - 1);
    vec2 at = layout_.y > 0.5 ? vec2(u, v) * last : vec2(u, v) * vec2(size) - 0.5;
    return clamp(at, vec2(0.0), last);
}

// Reads the first two channels of a table by linear interpolation between the four nearest texels.
// The interpolation is done here because a GL sampler may interpolate with 8 bits only, and need
// not filter 32-bit floats.
vec2 table_read(sampler2D table, vec4 layout_, float nov, float roughness)
{
    ivec2 size = textureSize(table, 0);
    vec2 at = table_place(layout_, size, nov, roughness);
    ivec2 a = ivec2(at), b = min(a + 1, size - 1);
    vec2 t = at - vec2(a);
    vec2 low = mix(texelFetch(table, a, 0).rg, texelFetch(table, ivec2(b.x, a.y), 0).rg, t.x);
    vec2 high = mix(texelFetch(table, ivec2(a.x, b.y), 0).rg, texelFetch(table, b, 0).rg, t.x);
    return mix(low, high, t.y);
}

// Reads 1 - E, E being the albedo of the specular lobe, from a table of E or, if its flag
// complement is set, of 1 - E.
float table_missing(sampler2D table, vec4 layout_, float nov, float roughness)
{
    float value = table_read(table, layout_, nov, roughness).r;
    return layout_.z > 0.5 ? value : 1.0 - value;
}
