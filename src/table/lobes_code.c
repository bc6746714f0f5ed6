// Writes source code in C, GLSL or WGSL that reads a table of KILN_TABLE_LOBES and turns its
// numbers into directions and weights. In: a complete kiln_table_def, a name, the language. Out:
// text. Each text below is the code for a table NAME with K taps, with $ in place of the name and @
// in place of K; the table's size stands in constants before the text. docs/theory/lobes.md derives
// the code.
#include "table/lobes_code.h"

#include <string.h>

static const char c_text[] =
    "enum { $_taps = @ };\n"
    "\n"
    "// Sets `values` to the table's 4 (taps + 1) numbers at n.v and roughness, interpolated "
    "linearly:\n"
    "// for each tap the lean, the level, the weight and one coefficient, then four coefficients.\n"
    "// `texels` are slices of rows of texels, each of 4 floats. Arguments out of range are "
    "clamped.\n"
    "static inline void $_lookup(const float *texels, double nov, double roughness,\n"
    "                            double values[4 * $_taps + 4])\n"
    "{\n"
    "    double x = (nov > 0 ? nov < 1 ? nov : 1 : 0) * ($_columns - 1);\n"
    "    double y = (roughness > 0 ? roughness < 1 ? roughness : 1 : 0) * ($_rows - 1);\n"
    "    int column = x < $_columns - 2 ? (int)x : $_columns - 2;\n"
    "    int row = y < $_rows - 2 ? (int)y : $_rows - 2;\n"
    "    double fx = x - column, fy = y - row;\n"
    "    for (int i = 0; i < 4 * $_taps + 4; i++) {\n"
    "        const float *t = texels + ((i / 4 * $_rows + row) * $_columns + column) * 4 + i % 4;\n"
    "        const float *b = t + 4 * $_columns;\n"
    "        double top = (double)t[0] + ((double)t[4] - (double)t[0]) * fx;\n"
    "        double bottom = (double)b[0] + ((double)b[4] - (double)b[0]) * fx;\n"
    "        values[i] = top + (bottom - top) * fy;\n"
    "    }\n"
    "}\n"
    "\n"
    "// Sets the directions, levels and weights of the taps and the weights of nine harmonics, "
    "from\n"
    "// `values` and the unit vectors n and v. Reflected light, before it is multiplied by F0 A + "
    "B,\n"
    "// is the sum of the taps' radiance times `weight` and of the radiance's nine orthonormal\n"
    "// harmonics times `harmonics`, at least 0.\n"
    "static inline void $_reflect(const double values[4 * $_taps + 4], const double n[3],\n"
    "                             const double v[3], double direction[$_taps][3],\n"
    "                             double level[$_taps], double weight[$_taps], double "
    "harmonics[9])\n"
    "{\n"
    "    double nov = n[0] * v[0] + n[1] * v[1] + n[2] * v[2], t[3], b[3], c[5], m[3][3], rest = "
    "1;\n"
    "    for (int i = 0; i < 3; i++)\n"
    "        t[i] = nov * n[i] - v[i];\n"
    "    double sine = sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);\n"
    "    if (sine > 1e-6) {\n"
    "        for (int i = 0; i < 3; i++)\n"
    "            t[i] /= sine;\n"
    "    } else {\n"
    "        // Any tangent serves.\n"
    "        int x = fabs(n[0]) < 0.5, y = !x;\n"
    "        double along = n[!x], length = sqrt(1 - along * along);\n"
    "        for (int i = 0; i < 3; i++)\n"
    "            t[i] = ((i == 0 ? x : i == 1 ? y : 0) - along * n[i]) / length;\n"
    "        sine = 0;\n"
    "    }\n"
    "    for (int i = 0; i < 3; i++)\n"
    "        b[i] = n[(i + 1) % 3] * t[(i + 2) % 3] - n[(i + 2) % 3] * t[(i + 1) % 3];\n"
    "    for (int k = 0; k < $_taps; k++) {\n"
    "        const double *tap = values + 4 * k;\n"
    "        double cosine = cos(tap[0]), lean = sin(tap[0]);\n"
    "        for (int i = 0; i < 3; i++)\n"
    "            direction[k][i] =\n"
    "                (nov * cosine + sine * lean) * n[i] + (sine * cosine - nov * lean) * t[i];\n"
    "        level[k] = tap[1];\n"
    "        weight[k] = tap[2];\n"
    "        c[k] = tap[3];\n"
    "        rest -= tap[2];\n"
    "    }\n"
    "    for (int i = $_taps; i < 5; i++)\n"
    "        c[i] = values[3 * $_taps + i];\n"
    "    for (int i = 0; i < 3; i++)\n"
    "        for (int j = 0; j < 3; j++)\n"
    "            m[i][j] = c[2] * n[i] * n[j] + 0.5 * c[3] * (n[i] * t[j] + t[i] * n[j]) +\n"
    "                      c[4] * (t[i] * t[j] - b[i] * b[j]);\n"
    "    harmonics[0] = 0.28209479177387814 * rest;\n"
    "    for (int i = 0; i < 3; i++)\n"
    "        harmonics[1 + i] =\n"
    "            0.48860251190291992 * (c[0] * n[(i + 1) % 3] + c[1] * t[(i + 1) % 3]);\n"
    "    harmonics[4] = 1.0925484305920792 * m[0][1];\n"
    "    harmonics[5] = 1.0925484305920792 * m[1][2];\n"
    "    harmonics[6] = 0.31539156525252005 * (2 * m[2][2] - m[0][0] - m[1][1]);\n"
    "    harmonics[7] = 1.0925484305920792 * m[0][2];\n"
    "    harmonics[8] = 0.54627421529603959 * (m[0][0] - m[1][1]);\n"
    "}\n";

static const char glsl_text[] =
    "const int $_taps = @;\n"
    "\n"
    "// Reads slice k of the table at n.v and roughness. Slices are at (k + 1/2) / (taps + 1).\n"
    "vec4 $_slice(highp sampler3D table, float nov, float roughness, int k)\n"
    "{\n"
    "    vec2 at = (clamp(vec2(nov, roughness), 0.0, 1.0) * ($_size - 1.0) + 0.5) / $_size;\n"
    "    return textureLod(table, vec3(at, (float(k) + 0.5) / float($_taps + 1)), 0.0);\n"
    "}\n"
    "\n"
    "// Returns reflected light, before it is multiplied by F0 A + B. n and v are unit vectors,\n"
    "// `levels` is the prefiltered environment and `sh` its radiance in nine orthonormal "
    "harmonics.\n"
    "vec3 $_reflect(highp sampler3D table, highp samplerCube levels, vec3 sh[9], vec3 n, vec3 v,\n"
    "               float roughness)\n"
    "{\n"
    "    float nov = dot(n, v), c[5], rest = 1.0;\n"
    "    vec3 t = nov * n - v, sum = vec3(0.0), lowest = vec3(1e30);\n"
    "    float sine = length(t);\n"
    "    vec3 other = abs(n.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);\n"
    "    t = sine > 1e-4 ? t / sine : normalize(other - dot(other, n) * n);\n"
    "    for (int k = 0; k < $_taps; k++) {\n"
    "        vec4 tap = $_slice(table, nov, roughness, k);\n"
    "        float cosine = cos(tap.x), lean = sin(tap.x);\n"
    "        vec3 d = (nov * cosine + sine * lean) * n + (sine * cosine - nov * lean) * t;\n"
    "        vec3 light = textureLod(levels, d, tap.y).rgb;\n"
    "        sum += tap.z * light;\n"
    "        lowest = min(lowest, light);\n"
    "        rest -= tap.z;\n"
    "        c[k] = tap.w;\n"
    "    }\n"
    "    vec4 last = $_slice(table, nov, roughness, $_taps);\n"
    "    for (int i = $_taps; i < 5; i++)\n"
    "        c[i] = last[i - $_taps];\n"
    "    vec3 b = cross(n, t), p = c[0] * n + c[1] * t;\n"
    "    mat3 m = c[2] * outerProduct(n, n) + 0.5 * c[3] * (outerProduct(n, t) + outerProduct(t, "
    "n)) +\n"
    "             c[4] * (outerProduct(t, t) - outerProduct(b, b));\n"
    "    sum += 0.28209479 * rest * sh[0];\n"
    "    sum += 0.48860251 * (p.y * sh[1] + p.z * sh[2] + p.x * sh[3]);\n"
    "    sum += 1.09254843 * (m[0][1] * sh[4] + m[1][2] * sh[5] + m[0][2] * sh[7]);\n"
    "    sum += 0.31539157 * (2.0 * m[2][2] - m[0][0] - m[1][1]) * sh[6];\n"
    "    sum += 0.54627422 * (m[0][0] - m[1][1]) * sh[8];\n"
    "    // The sum can be negative beside bright light. It is kept above 0.6 times what the "
    "darkest\n"
    "    // tap would give with the weights of all.\n"
    "    return max(sum, 0.6 * clamp(1.0 - rest, 0.0, 1.0) * lowest);\n"
    "}\n";

static const char wgsl_text[] =
    "const $_taps = @;\n"
    "\n"
    "// Reads slice k of the table at n.v and roughness. Slices are at (k + 1/2) / (taps + 1).\n"
    "fn $_slice(table: texture_3d<f32>, linear: sampler, nov: f32, roughness: f32, k: i32)\n"
    "    -> vec4<f32>\n"
    "{\n"
    "    let place = clamp(vec2<f32>(nov, roughness), vec2<f32>(0.0), vec2<f32>(1.0));\n"
    "    let at = (place * ($_size - 1.0) + 0.5) / $_size;\n"
    "    let depth = (f32(k) + 0.5) / f32($_taps + 1);\n"
    "    return textureSampleLevel(table, linear, vec3<f32>(at, depth), 0.0);\n"
    "}\n"
    "\n"
    "// Returns reflected light, before it is multiplied by F0 A + B. n and v are unit vectors,\n"
    "// `levels` is the prefiltered environment and `sh` its radiance in nine orthonormal "
    "harmonics.\n"
    "// The sampler filters linearly, between levels too, and clamps to the edge.\n"
    "fn $_reflect(table: texture_3d<f32>, levels: texture_cube<f32>, linear: sampler,\n"
    "    sh: array<vec3<f32>, 9>, n: vec3<f32>, v: vec3<f32>, roughness: f32) -> vec3<f32>\n"
    "{\n"
    "    let nov = dot(n, v);\n"
    "    let flat = nov * n - v;\n"
    "    let sine = length(flat);\n"
    "    let other = select(vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(1.0, 0.0, 0.0), abs(n.x) < 0.5);\n"
    "    let t = normalize(select(other - dot(other, n) * n, flat, sine > 1e-4));\n"
    "    var sum = vec3<f32>(0.0);\n"
    "    var lowest = vec3<f32>(1e30);\n"
    "    var rest = 1.0;\n"
    "    var c = array<f32, 5>();\n"
    "    for (var k = 0; k < $_taps; k++) {\n"
    "        let tap = $_slice(table, linear, nov, roughness, k);\n"
    "        let cosine = cos(tap.x);\n"
    "        let lean = sin(tap.x);\n"
    "        let d = (nov * cosine + sine * lean) * n + (sine * cosine - nov * lean) * t;\n"
    "        let light = textureSampleLevel(levels, linear, d, tap.y).rgb;\n"
    "        sum += tap.z * light;\n"
    "        lowest = min(lowest, light);\n"
    "        rest -= tap.z;\n"
    "        c[k] = tap.w;\n"
    "    }\n"
    "    let last = $_slice(table, linear, nov, roughness, $_taps);\n"
    "    for (var i = $_taps; i < 5; i++) {\n"
    "        c[i] = last[i - $_taps];\n"
    "    }\n"
    "    let b = cross(n, t);\n"
    "    let p = c[0] * n + c[1] * t;\n"
    "    // The symmetric matrix c20 n n' + c21 (n t' + t n') / 2 + c22 (t t' - b b'): its "
    "diagonal,\n"
    "    // then its elements xy, yz and zx.\n"
    "    let d = c[2] * n * n + c[3] * n * t + c[4] * (t * t - b * b);\n"
    "    let s = c[2] * n * n.yzx + 0.5 * c[3] * (n * t.yzx + t * n.yzx)\n"
    "        + c[4] * (t * t.yzx - b * b.yzx);\n"
    "    sum += 0.28209479 * rest * sh[0];\n"
    "    sum += 0.48860251 * (p.y * sh[1] + p.z * sh[2] + p.x * sh[3]);\n"
    "    sum += 1.09254843 * (s.x * sh[4] + s.y * sh[5] + s.z * sh[7]);\n"
    "    sum += 0.31539157 * (2.0 * d.z - d.x - d.y) * sh[6];\n"
    "    sum += 0.54627422 * (d.x - d.y) * sh[8];\n"
    "    // The sum can be negative beside bright light. It is kept above 0.6 times what the "
    "darkest\n"
    "    // tap would give with the weights of all.\n"
    "    return max(sum, 0.6 * clamp(1.0 - rest, 0.0, 1.0) * lowest);\n"
    "}\n";

// Writes a text with the name in place of each $ and the number of taps in place of each @.
static void write_text(const char *text, const char *name, int taps, ki_writer *w)
{
    while (*text) {
        size_t plain = strcspn(text, "$@");
        ki_write_text(w, "%.*s", (int)plain, text);
        text += plain;
        if (*text == '$')
            ki_write_text(w, "%s", name);
        else if (*text)
            ki_write_text(w, "%d", taps);
        text += *text != 0;
    }
}

void ki_lobes_write_code(const kiln_table_def *def, ki_language language, const char *name,
                         ki_writer *w)
{
    if (language == KI_LANGUAGE_C)
        ki_write_text(w, "enum { %s_columns = %d, %s_rows = %d };\n", name, def->width, name,
                      def->height);
    else
        ki_write_text(w,
                      language == KI_LANGUAGE_GLSL ? "const vec2 %s_size = vec2(%d, %d);\n"
                                                   : "const %s_size = vec2<f32>(%d, %d);\n",
                      name, def->width, def->height);
    write_text(language == KI_LANGUAGE_C      ? c_text
               : language == KI_LANGUAGE_GLSL ? glsl_text
                                              : wgsl_text,
               name, def->tap_count, w);
}
