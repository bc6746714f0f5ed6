#include "view_numbers.h"

void view_to_numbers(const view_options *o, double n[STAGE_NUMBERS])
{
    n[STAGE_SCENE] = (double)o->scene;
    n[STAGE_METHOD] = (double)o->method;
    n[STAGE_MATERIAL] = (double)o->material;
    n[STAGE_TARGET_X] = o->camera.target[0];
    n[STAGE_TARGET_Y] = o->camera.target[1];
    n[STAGE_TARGET_Z] = o->camera.target[2];
    n[STAGE_AZIMUTH] = o->camera.azimuth;
    n[STAGE_ELEVATION] = o->camera.elevation;
    n[STAGE_DISTANCE] = o->camera.distance;
    n[STAGE_FOV] = o->camera.fov;
    n[STAGE_ROTATION] = o->rotation;
    n[STAGE_EXPOSURE] = o->exposure;
    n[STAGE_DEBUG] = (double)o->debug;
    n[STAGE_LEVEL] = o->debug_level;
    n[STAGE_SPLIT] = o->split;
    n[STAGE_BACKGROUND] = o->background;
    n[STAGE_SAMPLES] = o->samples;
    n[STAGE_AS_PRINTED] = o->as_printed;
    n[STAGE_OCCLUSION] = o->occlusion;
    n[STAGE_CUBE_DIFFUSE] = o->cube_diffuse;
    n[STAGE_REFLECTIONS] = (double)o->reflections;
    n[STAGE_GROUND] = o->ground;
}

view_options view_from_numbers(const double n[STAGE_NUMBERS])
{
    return (view_options){
        .scene = (view_scene)n[STAGE_SCENE],
        .method = (view_method)n[STAGE_METHOD],
        .material = (view_material)n[STAGE_MATERIAL],
        .camera = {.target = {n[STAGE_TARGET_X], n[STAGE_TARGET_Y], n[STAGE_TARGET_Z]},
                   .azimuth = n[STAGE_AZIMUTH],
                   .elevation = n[STAGE_ELEVATION],
                   .distance = n[STAGE_DISTANCE],
                   .fov = n[STAGE_FOV]},
        .rotation = n[STAGE_ROTATION],
        .exposure = n[STAGE_EXPOSURE],
        .debug = (view_debug)n[STAGE_DEBUG],
        .debug_level = (int)n[STAGE_LEVEL],
        .split = n[STAGE_SPLIT],
        .background = n[STAGE_BACKGROUND],
        .samples = (int)n[STAGE_SAMPLES],
        .as_printed = n[STAGE_AS_PRINTED] != 0,
        .occlusion = n[STAGE_OCCLUSION] != 0,
        .cube_diffuse = n[STAGE_CUBE_DIFFUSE] != 0,
        .reflections = (view_reflections)n[STAGE_REFLECTIONS],
        .ground = n[STAGE_GROUND] != 0,
    };
}
