// What trueReflections() of three.mjs and babylon.mjs share. A table of `kiln tables --table lobes` says, for a
// roughness and a cosine n.v, which directions and levels of a prefiltered environment a reflection consists of, and by
// which coefficients bands 0 to 2 of the environment's spherical harmonics correct that sum.
// docs/theory/lobes.md derives the method. In: a table's module and nine coefficients of radiance. Out: halves for a
// texture, nine vectors for the shader, and the shader's functions.

// Texels along an edge of each slice. A table for K taps has K + 1 slices, one above the other.
export const SIZE = 32;

// The halves of a table, RGBA, whose slices begin with the lowest roughness.
export function decodeTable(base64) {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    return new Uint16Array(bytes.buffer);
}

// Checks what a caller gives as harmonics: what `kiln bake --sh FILE.json` writes.
export function checkHarmonics(sh, who) {
    const coefficients = sh?.coefficients;
    if (!Array.isArray(coefficients) || coefficients.length < 9 || !coefficients.every((c) => c?.length === 3))
        throw new Error(`${who}: the spherical harmonics must be an object with 9 coefficients of 3 numbers or more, ` +
                        'as "kiln bake --sh sh.json" writes them');
    if (sh.irradiance || sh.window)
        throw new Error(`${who}: the spherical harmonics must be those of the radiance, and these are ` +
                        `${sh.irradiance ? 'those of the irradiance' : 'windowed'}; leave out ` +
                        `${sh.irradiance ? '--sh-irradiance' : '--sh-window'}`);
    return coefficients;
}

// Factors of the orthonormal functions k0, k1 y, k1 z, k1 x, 2 k2 xy, 2 k2 yz, k3 (3 z^2 - 1), 2 k2 xz, k4 (x^2 - y^2).
const BASIS = [0.28209479177387814, 0.4886025119029199, 0.5462742152960396, 0.31539156525252005, 0.5462742152960396];

// The values of these functions in a direction.
export function basisAt(x, y, z) {
    const [k0, k1, k2, k3, k4] = BASIS;
    return [k0, k1 * y, k1 * z, k1 * x, 2 * k2 * x * y, 2 * k2 * y * z, k3 * (3 * z * z - 1), 2 * k2 * x * z,
            k4 * (x * x - y * y)];
}

// The radiance of bands 0 to 2 at a direction d is c + e.d + d'Md, with M symmetric and without trace. Returns
// [c, ex, ey, ez, Mxx, Myy, Mxy, Mxz, Myz], each in red, green and blue, in the axes of an engine: axes[i] is the
// engine's axis i as a direction of kiln.
export function lightOf(coefficients, axes) {
    const [k0, k1, k2, k3, k4] = BASIS;
    const rgb = [0, 1, 2].map((c) => {
        const [s, y, z, x, xy, yz, zz, xz, xx] = coefficients.map((each) => each[c]);
        const e = [k1 * x, k1 * y, k1 * z];
        const m = [[k4 * xx - k3 * zz, k2 * xy, k2 * xz], [k2 * xy, -k4 * xx - k3 * zz, k2 * yz],
                   [k2 * xz, k2 * yz, 2 * k3 * zz]];
        const linear = (a) => e[0] * a[0] + e[1] * a[1] + e[2] * a[2];
        const square = (a, b) => m.reduce((sum, row, i) =>
            sum + a[i] * (row[0] * b[0] + row[1] * b[1] + row[2] * b[2]), 0);
        const [X, Y, Z] = axes;
        return [k0 * s, linear(X), linear(Y), linear(Z), square(X, X), square(Y, Y), square(X, Y), square(X, Z),
                square(Y, Z)];
    });
    return rgb[0].map((_, i) => rgb.map((each) => each[i]));
}

// The harmonics of the radiance in kiln's axes, from the polynomial of the irradiance that an .env file of Babylon.js
// holds: its bands contain the factors 1, 2/3 and 1/4 of the cosine lobe twice.
export function harmonicsOf({ x, y, z, xx, yy, zz, yz, zx, xy }) {
    const [k0, k1, k2, k3, k4] = BASIS;
    const rgb = [0, 1, 2].map((c) => {
        const mean = (xx[c] + yy[c] + zz[c]) / 3, e = 9 / 4, m = 16;
        return [mean / k0, e * y[c] / k1, -e * z[c] / k1, e * x[c] / k1, m / 2 * xy[c] / k2, -m / 2 * yz[c] / k2,
                m * (zz[c] - mean) / (2 * k3), -m / 2 * zx[c] / k2, m * (xx[c] - yy[c]) / (2 * k4)];
    });
    return { bands: 3, irradiance: false, window: 0, coefficients: rgb[0].map((_, i) => rgb.map((each) => each[i])) };
}

// GLSL of kilnReflection(v, n, roughness, turn): the radiance that a surface of that roughness reflects towards v, for
// unit vectors v and n of one frame, which `turn` turns into the frame of the environment. `read` is GLSL
// code that returns the radiance in the direction `way` at the level `lod` of the table's chain. Babylon.js 5 breaks lines
// at semicolons, which comments of the shader must not have.
export const shader = (taps, read) => `
uniform highp sampler2D kilnLobes;
uniform vec3 kilnLight[ 9 ];

vec4 kilnSlice( const in float slice, const in vec2 place ) {
	vec2 at = place * ${((SIZE - 1) / SIZE).toFixed(5)} + ${(0.5 / SIZE).toFixed(6)};
	return textureLod( kilnLobes, vec2( at.x, ( slice + at.y ) / ${taps + 1}.0 ), 0.0 );
}

vec3 kilnChain( const in vec3 way, const in float lod ) {
	${read}
}

// a'Mb of band 2 of the environment's light.
vec3 kilnSquare( const in vec3 a, const in vec3 b ) {
	return kilnLight[ 4 ] * ( a.x * b.x - a.z * b.z ) + kilnLight[ 5 ] * ( a.y * b.y - a.z * b.z )
		+ kilnLight[ 6 ] * ( a.x * b.y + a.y * b.x ) + kilnLight[ 7 ] * ( a.x * b.z + a.z * b.x )
		+ kilnLight[ 8 ] * ( a.y * b.z + a.z * b.y );
}

vec3 kilnReflection( const in vec3 v, const in vec3 n, const in float roughness, const in mat3 turn ) {
	float nov = clamp( dot( n, v ), 0.0, 1.0 );
	vec2 place = vec2( nov, roughness );
	// The tangent on the side of the mirror direction, or any tangent where v is along n.
	vec3 side = dot( n, v ) * n - v + 1e-6 * ( abs( n.x ) < 0.5 ? vec3( 1.0, 0.0, 0.0 ) : vec3( 0.0, 1.0, 0.0 ) );
	vec3 t = turn * normalize( side - dot( side, n ) * n ), N = turn * n, b = cross( N, t );
	float mirror = acos( nov );
	vec3 sum = vec3( 0.0 ), lowest = vec3( 1e30 ), light;
	vec4 tap, last = kilnSlice( ${taps}.0, place );
	float angle, weight = 0.0, rest[ 3 ];
	${Array.from({ length: taps }, (_, k) => `
	tap = kilnSlice( ${k}.0, place );
	angle = mirror - tap.x;
	weight += tap.z;
	light = kilnChain( cos( angle ) * N + sin( angle ) * t, tap.y );
	sum += tap.z * light;
	lowest = min( lowest, light );
	rest[ ${k} ] = tap.w;`).join('')}
	${[`float c10 = rest[ 0 ], c11 = last.x, c20 = last.y, c21 = last.z, c22 = last.w;`,
       `float c10 = rest[ 0 ], c11 = rest[ 1 ], c20 = last.x, c21 = last.y, c22 = last.z;`,
       `float c10 = rest[ 0 ], c11 = rest[ 1 ], c20 = rest[ 2 ], c21 = last.x, c22 = last.y;`][taps - 1]}
	vec3 e = c10 * N + c11 * t;
	sum += ( 1.0 - weight ) * kilnLight[ 0 ] + e.x * kilnLight[ 1 ] + e.y * kilnLight[ 2 ] + e.z * kilnLight[ 3 ];
	sum += c20 * kilnSquare( N, N ) + c21 * kilnSquare( N, t ) + c22 * ( kilnSquare( t, t ) - kilnSquare( b, b ) );
	// The sum can be negative beside bright light. It is kept above 0.6 times what the darkest tap would give with the
	// weights of all.
	return max( sum, 0.6 * clamp( weight, 0.0, 1.0 ) * lowest );
}
`;
