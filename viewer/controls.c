#include "controls.h"

#include <math.h>

const char *const view_keys[] = {
    "drag           move the camera around the balls",
    "shift + drag   turn the environment, as dragging with the right button does",
    "wheel, + -     move the camera closer to the balls or away",
    "1 to 5         show the scene assignment, ibl, furnace, grid or compare",
    "m              next method: single, kulla-conty, handout, fdez-aguera, turquin",
    "n              next material of the balls",
    "d              next debug view: a level of the environment, a table, E or F",
    "k              next level of the environment in the debug view of a level",
    "[ ]            move the dividing line of the scene compare left or right",
    "e r            darker or brighter by half a stop",
    "b              blur the environment behind the balls more, or not at all again",
    "o              let balls shade one another, or not",
    "g              matte ground with the shadows of the balls, or none",
    "v              next way to look up reflections: straight, bent, one, two or three taps",
    "i              diffuse light from spherical harmonics or from the irradiance cube",
    "p              scene assignment with the mistake of the handout's figure 6, or without",
    "space          reset camera and settings of the scene",
    "h              print the meaning of all keys",
    "q, escape      close the window",
    NULL,
};

static double clamp(double x, double low, double high)
{
    return fmin(fmax(x, low), high);
}

void view_orbit(view_options *o, double right, double down, int height)
{
    o->camera.azimuth = remainder(o->camera.azimuth - 180 * right / height, 360);
    o->camera.elevation = clamp(o->camera.elevation + 180 * down / height, -89, 89);
}

void view_turn(view_options *o, double right, int height)
{
    o->rotation = remainder(o->rotation - 180 * right / height, 360);
}

void view_zoom(view_options *o, double steps)
{
    o->camera.distance = clamp(o->camera.distance * pow(0.9, steps), 60, 4000);
}

static void choose_scene(view_options *o, view_scene scene)
{
    double rotation = o->rotation, exposure = o->exposure;
    *o = view_defaults(scene);
    o->rotation = rotation;
    o->exposure = exposure;
}

static bool key_of_light(view_options *o, char key)
{
    switch (key) {
    case 'e':
    case 'r':
        o->exposure = clamp(o->exposure + (key == 'r' ? 0.5 : -0.5), -16, 16);
        return true;
    case 'b':
        o->background = o->background >= 0.99 ? 0 : o->background + 0.25;
        return true;
    case 'g':
        o->ground = !o->ground;
        return true;
    case 'i':
        o->cube_diffuse = !o->cube_diffuse;
        return true;
    case 'o':
        o->occlusion = !o->occlusion;
        return true;
    case 'v':
        o->reflections = (view_reflections)(((int)o->reflections + 1) % VIEW_REFLECTIONS_COUNT);
        return true;
    default:
        return false;
    }
}

bool view_key(view_options *o, char key, const bool allowed[VIEW_SCENE_COUNT])
{
    switch (key) {
    case '1':
    case '2':
    case '3':
    case '4':
    case '5':
        if (!allowed[key - '1'])
            return false;
        choose_scene(o, (view_scene)(key - '1'));
        return true;
    case 'm':
        o->method = (view_method)(((int)o->method + 1) % VIEW_METHOD_COUNT);
        return true;
    case 'n':
        o->material = (view_material)(((int)o->material + 1) % VIEW_MATERIAL_COUNT);
        return true;
    case 'd':
        o->debug = (view_debug)(((int)o->debug + 1) % VIEW_DEBUG_COUNT);
        return true;
    case 'k':
        o->debug_level = (o->debug_level + 1) % 6;
        return true;
    case '[':
    case ']':
        o->split = clamp(o->split + (key == ']' ? 0.02 : -0.02), 0, 1);
        return true;
    case '+':
    case '=':
    case '-':
        view_zoom(o, key == '-' ? -1 : 1);
        return true;
    case 'p':
        o->as_printed = !o->as_printed;
        return o->scene == VIEW_SCENE_ASSIGNMENT;
    case ' ':
        *o = view_defaults(o->scene);
        return true;
    default:
        return key_of_light(o, key);
    }
}
