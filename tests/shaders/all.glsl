#include "../../shaders/brdf.glsl"
#include "../../shaders/kulla_conty.glsl"
#include "../../shaders/ibl.glsl"
#include "../../shaders/tone.glsl"
