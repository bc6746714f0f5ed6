// What a file says about its colours: the curves from stored samples to linear light, and the
// conversion to Rec. 709. PNG and JPEG share these declarations.
#ifndef KI_FILE_COLOR_H
#define KI_FILE_COLOR_H

#include "base/base.h"
#include "image/color.h"

typedef enum ki_curve_kind {
    KI_CURVE_SRGB,       ///< the transfer function of sRGB, IEC 61966-2-1
    KI_CURVE_PARAMETRIC, ///< (a x + b)^g + e from x = d on, c x + f below, as in ICC profiles
    KI_CURVE_TABLE,      ///< samples at equal distances, with straight lines between them
    KI_CURVE_PQ,         ///< PQ of SMPTE ST 2084, scaled so that 203 cd/m2 become 1
    KI_CURVE_HLG,        ///< HLG of ARIB STD-B67: the light of the scene, from 0 to 1
} ki_curve_kind;

/// A function from a stored sample in [0, 1] to linear light. {0} is the function of sRGB.
typedef struct ki_curve {
    ki_curve_kind kind;
    double g, a, b, c, d, e, f; ///< the numbers in the formula of KI_CURVE_PARAMETRIC
    const uint8_t *table;       ///< samples of KI_CURVE_TABLE: numbers of 16 bits, high byte first
    size_t count;
} ki_curve;

double ki_curve_linear(const ki_curve *curve, double sample);

/// How stored samples become linear light in Rec. 709. {0} is sRGB.
typedef struct ki_file_color {
    ki_curve curve[3];
    bool narrow; ///< true: samples run from 16/255 to 235/255, as in video
    /// True: the values are the scene's light of HLG, to which the system gamma is applied, with
    /// `luminance` as the weights of the channels.
    bool hlg;
    double luminance[3];
    bool converts; ///< true: the colours are multiplied by `to_rec709`
    ki_matrix3 to_rec709;
    uint8_t *profile; ///< memory of an ICC profile, in which the tables of curves lie
} ki_file_color;

void ki_file_color_free(ki_file_color *color);
/// Sets the same curve for the three channels of a file.
void ki_file_color_set_curve(ki_file_color *color, const ki_curve *curve);
/// Sets the conversion from colours with these primaries to Rec. 709. Returns false if the
/// chromaticities cannot be primaries.
bool ki_file_color_set_primaries(ki_file_color *color, const ki_primaries *primaries);
/// Sets the colours that the four numbers of ITU-T H.273 name: primaries, transfer function, matrix
/// coefficients, and 1 for the full range of samples. `what` gets their names. Returns false if
/// kiln does not know them.
enum { KI_COLOR_NAME = 64 };
bool ki_file_color_set_cicp(ki_file_color *color, const uint8_t numbers[4],
                            char what[KI_COLOR_NAME]);
/// The numbers that ki_file_color_set_cicp accepts, as text for error messages.
extern const char ki_cicp_known[];

/// Fills a table with the linear value of each of the `count` samples that a channel can have.
void ki_file_color_fill(const ki_file_color *color, int channel, float *table, int count);
/// Converts a picture of linear values in the file's colours to Rec. 709. Does nothing for a file
/// of sRGB. Fails only if the caller asks to stop.
kiln_result ki_file_color_finish(kiln_context *context, const ki_file_color *color,
                                 kiln_image *image, kiln_error *error);

#endif
