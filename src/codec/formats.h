// The table of file formats: one row a format, whose reader and writer are a file of their own.
#ifndef KI_FORMATS_H
#define KI_FORMATS_H

#include "codec/codec.h"

/// What a format's files can hold, as bits.
enum {
    KI_HOLDS_PICTURE =
        1, ///< a flat picture: a panorama, an octahedron, one face of a cube, or an image
    KI_HOLDS_CUBE = 2,  ///< the faces and levels of a cube
    KI_HOLDS_TABLE = 4, ///< a table of the reflection model
    KI_HOLDS_SH = 8,    ///< spherical harmonics
    KI_HOLDS_CODE = 16, ///< functions that look tables up, and closed forms
};

/// What the file of a picture says of the picture, and how the picture's numbers are stored.
typedef struct ki_picture_about {
    bool radiance; ///< a level of a map, stored by `format`; false: numbers, as exact as can be
    kiln_format format;
    bool panorama, octahedron;
    float roughness; ///< negative where there is none
} ki_picture_about;

typedef kiln_result ki_read_picture(kiln_context *context, const uint8_t *bytes, size_t size,
                                    const char *name, kiln_image *image, kiln_file_info *info,
                                    kiln_error *error);
typedef kiln_result ki_read_file(kiln_context *context, const uint8_t *bytes, size_t size,
                                 const char *name, ki_decoded *decoded, kiln_file_info *info,
                                 kiln_error *error);
typedef kiln_result ki_describe_file(const uint8_t *bytes, size_t size, const char *name,
                                     kiln_file_info *info, kiln_error *error);
typedef kiln_result ki_write_picture(const kiln_image *image, const ki_picture_about *about,
                                     ki_writer *writer, kiln_error *error);
typedef kiln_result ki_write_cube(const kiln_map *map, const kiln_save_def *def, ki_writer *writer,
                                  kiln_error *error);

typedef struct ki_file_format {
    const char *name;       ///< as in kiln_file_info, "ktx2"
    const char *endings[3]; ///< of paths, in small letters with the dot; NULL behind the last
    const char *first;      ///< the bytes that files begin with, or NULL
    int first_count;
    bool (*begins)(const uint8_t *bytes, size_t size); ///< tells text, which has no such bytes
    unsigned holds;                                    ///< KI_HOLDS_...
    unsigned pixel_formats;         ///< of maps: bits 1 << kiln_format besides KILN_FORMAT_AUTO
    unsigned table_formats;         ///< of tables: bits 1 << kiln_table_format
    kiln_table_format table_format; ///< what KILN_TABLE_FORMAT_AUTO means
    bool zstd;
    double limit;                  ///< the largest radiance by KILN_FORMAT_AUTO; 0 for none
    ki_read_picture *read_picture; ///< one of the three, where the bytes tell the format
    ki_read_file *read;
    ki_describe_file *describe; ///< of files that are not read, but described
    ki_write_picture *write_picture;
    ki_write_cube *write_cube;
} ki_file_format;

/// The row whose ending a path has, in letters of either case; NULL where there is none.
const ki_file_format *ki_file_format_of_path(const char *path);
/// Whether a row is there and its files can hold one of these.
static inline bool ki_file_holds(const ki_file_format *format, unsigned holds)
{
    return format && (format->holds & holds);
}

enum { KI_ENDINGS_TEXT = 96 };
/// The endings of all formats that hold one of these, ".exr .hdr or .png", and returns `text`. `more`,
/// which may be NULL, is one that comes last.
const char *ki_list_endings(unsigned holds, const char *more, char text[KI_ENDINGS_TEXT]);
/// The same of the formats that store maps so.
const char *ki_list_endings_of_format(kiln_format format, char text[KI_ENDINGS_TEXT]);

#endif
