// The roughness of levels. In: a panorama, levels in its directions, and what is expected of them.
// Out: for each level the roughness whose exact level is most like the level, and sentences about
// the mapping from levels to roughness.
//
// Method: the panorama is filtered for a ladder of roughnesses. Between two rungs the exact level
// is nearly a linear mixture of both, so that the mixture of least error gives the roughness.
// Errors are means of ((level - exact) / (exact + mean))^2, in which a sun counts as any other
// texel.
#include "check/check.h"

#include "image/image.h"
#include "math/math.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// RUNGS: number of rungs of the ladder, cubes of EDGE x EDGE texels a face that are filtered from a
// panorama of ROWS rows. LEAST: smallest size of a level whose roughness is searched.
enum { RUNGS = 16, EDGE = 32, ROWS = 128, LEAST = 4 };

// The roughnesses of the rungs, closer together where levels change faster.
static const float rungs[RUNGS] = {0,     0.1F,  0.14F, 0.18F, 0.23F, 0.28F, 0.33F, 0.39F,
                                   0.45F, 0.51F, 0.58F, 0.65F, 0.73F, 0.81F, 0.9F,  1};

// ----------------------------------------------------------------------------------------- ladders

static kiln_result make_ladder(kiln_context *context, const kiln_map *source, kiln_lobe_kind lobe,
                               kiln_map *ladder, kiln_error *error)
{
    kiln_map small;
    const kiln_prefilter_def def = {.size = EDGE,
                                    .level_count = RUNGS,
                                    .smallest = EDGE,
                                    .lobe = lobe,
                                    .roughness = rungs,
                                    .tolerance = 0.01};
    kiln_result result = kiln_map_convert(context, source, KILN_SHAPE_PANORAMA,
                                          ki_min(ROWS, source->size), 0, &small, error);
    if (result == KILN_OK)
        result = kiln_prefilter(context, &small, &def, ladder, error);
    kiln_map_free(&small);
    return result;
}

// Reads the rungs at the centres of the texels of a smaller cube, `read`.
static void read_ladder(const kiln_map *ladder, kiln_map *read)
{
    for (size_t i = 0; i < kiln_map_texels(read, 0); i++) {
        size_t texels[4];
        double at[3], weights[4];
        kiln_map_direction(read, 0, i, at);
        ki_cube_taps(ladder->size, at, texels, weights);
        for (int k = 0; k < RUNGS; k++)
            for (size_t c = 0; c < 3; c++) {
                double sum = 0;
                for (int t = 0; t < 4; t++)
                    sum += weights[t] * (double)ladder->level[k][3 * texels[t] + c];
                read->level[k][3 * i + c] = (float)sum;
            }
    }
}

// Weighted sums over all values of products of a level l and of two exact levels a and b.
typedef struct products {
    double ll, la, lb, aa, ab, bb;
} products;

static products multiply(const kiln_map *level, const float *a, const float *b, double mean)
{
    products p = {0, 0, 0, 0, 0, 0};
    for (size_t i = 0; i < 3 * kiln_map_texels(level, 0); i++) {
        double l = (double)level->level[0][i], u = (double)a[i], v = (double)b[i];
        double scale = fabs(u) + mean, w = 1 / (scale * scale);
        p.ll += w * l * l;
        p.la += w * l * u;
        p.lb += w * l * v;
        p.aa += w * u * u;
        p.ab += w * u * v;
        p.bb += w * v * v;
    }
    return p;
}

// Where on the ladder a level lies.
typedef struct place {
    double roughness, error;
    double factor; ///< factor of brightness with which the error is least
} place;

// Returns the error of a level divided by `factor` against the mixture (1 - t) a + t b.
static double mixture_error(const products *p, double factor, double t)
{
    double s = 1 - t, lm = s * p->la + t * p->lb,
           mm = s * s * p->aa + 2 * s * t * p->ab + t * t * p->bb;
    return p->ll / (factor * factor) - 2 * lm / factor + mm;
}

// Finds the mixture of least error. If `factor` is 0, so is the factor.
static place find_between(const products *p, double factor)
{
    place found = {0, 0, factor};
    double t = 0.5;
    for (int round = 0; round < 4; round++) {
        double s = 1 - t, lm = s * p->la + t * p->lb,
               mm = s * s * p->aa + 2 * s * t * p->ab + t * t * p->bb;
        if (factor <= 0)
            found.factor = mm > 0 && lm > 0 ? lm / mm : 1;
        double f = found.factor, bend = p->aa - 2 * p->ab + p->bb;
        t = bend > 0 ? ki_clamp(((p->lb - p->la) / f + p->aa - p->ab) / bend, 0, 1) : 0;
    }
    found.roughness = t;
    found.error = mixture_error(p, found.factor, t);
    return found;
}

// Finds the place of least error on the ladder. Sets *worst to the largest error of a rung.
static place find_place(const kiln_map *level, const kiln_map *ladder, double mean, double factor,
                        double *worst)
{
    place best = {0, HUGE_VAL, 1};
    *worst = 0;
    for (int i = 0; i < RUNGS - 1; i++) {
        products p = multiply(level, ladder->level[i], ladder->level[i + 1], mean);
        place here = find_between(&p, factor);
        *worst = fmax(*worst, mixture_error(&p, here.factor, i ? 1 : 0) / p.aa);
        here.roughness = (double)rungs[i] + here.roughness * (double)(rungs[i + 1] - rungs[i]);
        here.error /= p.aa;
        if (here.error < best.error)
            best = here;
    }
    return best;
}

// Converts a level to a cube of at most EDGE texels along a side.
static kiln_result shrink(kiln_context *context, const kiln_map *map, int level, kiln_map *small,
                          kiln_error *error)
{
    kiln_map one = ki_single_level(map, level);
    return kiln_map_convert(context, &one, KILN_SHAPE_CUBE, ki_min(EDGE, one.size), 0, small,
                            error);
}

// ----------------------------------------------------------------------------------------- search

// Returns the factor of brightness, or 1 if there is none. The factor of least error and the ratio
// of the means must agree: clamped light changes only the mean, and blur only the least error.
static double find_brightness(double factor, double ratio)
{
    bool agree = fabs(factor / ratio - 1) < 0.04;
    return agree && fabs(factor - 1) > 0.02 && fabs(ratio - 1) > 0.02 ? ratio : 1;
}

static kiln_result find_level(kiln_context *context, const kiln_map *ladder, double mean,
                              const kiln_map *map, int level, ki_mapping *mapping,
                              kiln_error *error)
{
    kiln_map small = {0}, read = {0};
    double worst;
    double texel =
        KI_PI / (map->shape == KILN_SHAPE_CUBE ? 2 : 1) / kiln_map_level_size(map, level);
    mapping->found[level] = -1;
    mapping->least[level] = sqrt(fmax(texel, KI_PI / 2 / EDGE) / 2);
    if (kiln_map_level_size(map, level) < LEAST)
        return KILN_OK;
    kiln_result result = shrink(context, map, level, &small, error);
    if (result == KILN_OK) {
        read = (kiln_map){.shape = KILN_SHAPE_CUBE,
                          .size = small.size,
                          .level_count = RUNGS,
                          .smallest = small.size};
        result = ki_map_allocate(context, &read, error);
    }
    if (result == KILN_OK) {
        read_ladder(ladder, &read);
        place p = find_place(&small, &read, mean, level ? mapping->brightness : 0, &worst);
        // Levels of a uniform environment are alike at every roughness.
        mapping->found[level] = worst > 1e-5 ? p.roughness : -1;
        if (level == 0)
            mapping->brightness = find_brightness(p.factor, ki_map_mean(&small) / mean);
    }
    kiln_map_free(&small);
    kiln_map_free(&read);
    return result;
}

kiln_result ki_find_roughness(kiln_context *context, const kiln_map *source, const kiln_map *map,
                              kiln_lobe_kind lobe, ki_mapping *mapping, kiln_error *error)
{
    kiln_map ladder = {0};
    *mapping = (ki_mapping){.brightness = 1};
    kiln_result result = make_ladder(context, source, lobe, &ladder, error);
    kiln_map sharp = ki_single_level(&ladder, 0);
    double mean = result == KILN_OK ? fabs(ki_map_mean(&sharp)) + 1e-12 : 1;
    for (int k = 0; k < map->level_count && result == KILN_OK; k++)
        result = find_level(context, &ladder, mean, map, k, mapping, error);
    kiln_map_free(&ladder);
    return result;
}

// ------------------------------------------------------------------------------------------ words

// Returns the difference of a level's roughness from `roughness`. Lobes that are narrower than the
// texels that were compared cannot be told apart, and do not differ.
static double difference(const ki_mapping *mapping, int level, double roughness)
{
    double least = mapping->least[level];
    return fmax(mapping->found[level], least) - fmax(roughness, least);
}

// Returns the root mean square difference of found roughnesses from a list.
static double distance(const ki_mapping *mapping, int count, const double *list)
{
    double sum = 0;
    int known = 0;
    for (int k = 0; k < count; k++)
        if (mapping->found[k] >= 0) {
            double d = difference(mapping, k, list[k]);
            sum += d * d;
            known++;
        }
    return known ? sqrt(sum / known) : 0;
}

// A way in which levels may be filtered for wrong roughnesses.
typedef enum mistake { NO_MISTAKE, NEXT, PREVIOUS, SQUARED, ROOT, MISTAKES } mistake;

static void make_wrong(mistake wrong, const double *wanted, int count, double *list)
{
    for (int k = 0; k < count; k++) {
        double w = wanted[k];
        list[k] = wrong == NEXT       ? wanted[ki_min(k + 1, count - 1)]
                  : wrong == PREVIOUS ? wanted[ki_max(k - 1, 0)]
                  : wrong == SQUARED  ? w * w
                  : wrong == ROOT     ? sqrt(w)
                                      : w;
    }
}

void ki_judge_mapping(int count, const ki_mapping *mapping, kiln_findings *findings)
{
    static const char *const words[] = {
        [NEXT] = "the levels are shifted by one: each is filtered for the roughness of the next "
                 "level and is too blurred",
        [PREVIOUS] = "the levels are shifted by one: each is filtered for the roughness of the "
                     "level before and is too sharp",
        [SQUARED] = "roughness is squared once too often: the levels have alpha = r^4 in place of "
                    "r^2 and are too sharp",
        [ROOT] = "roughness is not squared: the levels have alpha = r in place of r^2 and are too "
                 "blurred"};
    double list[KILN_MAX_LEVELS], off = distance(mapping, count, mapping->wanted), least = off / 3;
    mistake found = NO_MISTAKE;
    int worst = 0;
    for (mistake m = NEXT; m < MISTAKES; m++) {
        make_wrong(m, mapping->wanted, count, list);
        double d = distance(mapping, count, list);
        if (d < least) {
            least = d;
            found = m;
        }
    }
    for (int k = 0; k < count; k++)
        if (mapping->found[k] >= 0 && fabs(difference(mapping, k, mapping->wanted[k])) >
                                          fabs(difference(mapping, worst, mapping->wanted[worst])))
            worst = k;
    if (off > 0.03 && found != NO_MISTAKE)
        ki_find(findings, KILN_FINDING_MAPPING, true, "%s", words[found]);
    else if (off > 0.05)
        ki_find(findings, KILN_FINDING_MAPPING, true,
                "level %d should be filtered for roughness %.3f and is most like %.3f", worst,
                mapping->wanted[worst], mapping->found[worst]);
}

// Finds the engine whose roughnesses are nearest to those found, and says so.
static void choose_wanted(const kiln_map *map, ki_mapping *mapping, kiln_findings *findings)
{
    const ki_recipe *recipe, *best = NULL;
    double list[KILN_MAX_LEVELS], least = 0.04;
    char names[128] = "";
    for (int i = 0; (recipe = ki_recipe_at(i)) != NULL; i++) {
        if (!recipe->level || (recipe->flat && map->shape == KILN_SHAPE_CUBE))
            continue;
        for (int k = 0; k < map->level_count; k++)
            list[k] = recipe->roughness(k, map->level_count, map->size);
        double d = distance(mapping, map->level_count, list);
        if (d < least - 1e-9) {
            least = d;
            best = recipe;
            memcpy(mapping->wanted, list, sizeof list);
            names[0] = 0;
        }
        size_t length = strlen(names);
        if (d <= least + 1e-9)
            snprintf(names + length, sizeof names - length, "%s%s", length ? ", " : "",
                     recipe->about.name);
    }
    if (best && map->level_count > 1) {
        ki_find(findings, KILN_FINDING_MAPPING, false, "the levels are those of %s: %s", names,
                best->about.mapping);
        return;
    }
    for (int k = 0; k < map->level_count; k++)
        mapping->wanted[k] = mapping->found[k] >= 0 ? mapping->found[k]
                             : k                    ? mapping->wanted[k - 1]
                                                    : 0;
    ki_find(findings, KILN_FINDING_MAPPING, false,
            "each level is compared with the roughness that it is most like");
}

void ki_want_roughness(const kiln_map *map, const kiln_check_levels_def *def, ki_mapping *mapping,
                       kiln_findings *findings)
{
    const ki_recipe *recipe = def->engine ? ki_recipe_of(def->engine) : NULL;
    for (int k = 0; k < map->level_count; k++)
        mapping->wanted[k] =
            recipe ? recipe->roughness(k, map->level_count, map->size) : (double)map->roughness[k];
    if (!recipe && !def->stated)
        choose_wanted(map, mapping, findings);
    if (mapping->brightness != 1)
        ki_find(findings, KILN_FINDING_BRIGHTNESS, true, "all values are %.4g times as bright",
                mapping->brightness);
}
