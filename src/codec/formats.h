// The table of file formats: one row for each format, whose reader and writer are in a file of
// their own.
#ifndef KI_FORMATS_H
#define KI_FORMATS_H

#include "codec/codec.h"

/// What the files of a format can hold, as bits.
enum {
    KI_HOLDS_PICTURE =
        1, ///< a flat picture: a panorama, an octahedron, one face of a cube, or an image
    KI_HOLDS_CUBE = 2,     ///< the faces and levels of a cube
    KI_HOLDS_TABLE = 4,    ///< a table of the reflection model
    KI_HOLDS_SH = 8,       ///< spherical harmonics
    KI_READS_PICTURE = 32, ///< a flat picture, which kiln reads but does not write
    KI_HOLDS_CODE = 16,    ///< functions that look tables up, and closed forms
};

/// What a picture's file states about the picture, and how the picture's numbers are stored: the
/// arguments of a format's writer.
typedef struct ki_picture_about {
    /// True: the picture is a level of a map, stored by `format`. False: the picture holds numbers,
    /// stored as exactly as the file allows.
    bool radiance;
    kiln_format format;
    bool panorama, octahedron;
    float roughness; ///< roughness of the level; negative if the picture is no level
} ki_picture_about;

typedef kiln_result ki_read_picture(kiln_context *context, const uint8_t *bytes, size_t size,
                                    const char *name, kiln_image *image, kiln_file_info *info,
                                    kiln_load_report *report, kiln_error *error);
typedef kiln_result ki_read_layer(kiln_context *context, const uint8_t *bytes, size_t size,
                                  const char *name, const char *layer, kiln_image *image,
                                  kiln_file_info *info, kiln_load_report *report,
                                  kiln_error *error);
typedef kiln_result ki_read_file(kiln_context *context, const uint8_t *bytes, size_t size,
                                 const char *name, ki_decoded *decoded, kiln_file_info *info,
                                 kiln_error *error);
typedef kiln_result ki_describe_file(kiln_context *context, const uint8_t *bytes, size_t size,
                                     const char *name, kiln_file_info *info, kiln_error *error);
typedef kiln_result ki_write_picture(const kiln_image *image, const ki_picture_about *about,
                                     ki_writer *writer, kiln_error *error);
typedef kiln_result ki_write_cube(const kiln_map *map, const kiln_save_def *def, ki_writer *writer,
                                  kiln_error *error);

typedef struct ki_file_format {
    const char *name;       ///< name of the format, as in kiln_file_info, for example "ktx2"
    const char *endings[3]; ///< endings of paths, in lower case with the dot; NULL after the last
    /// The bytes with which every file of the format begins; NULL if formats are told apart in
    /// another way.
    const char *first;
    int first_count;
    /// For text formats, whose first bytes vary: returns whether bytes are of this format.
    bool (*begins)(const uint8_t *bytes, size_t size);
    unsigned holds; ///< what files of the format can hold, a sum of KI_HOLDS_... constants
    /// Texel formats that files of maps can have, a sum of 1 << kiln_format; KILN_FORMAT_AUTO is
    /// always allowed.
    unsigned pixel_formats;
    /// number formats that files of tables can have, a sum of 1 << kiln_table_format
    unsigned table_formats;
    /// number format of a table if the caller chooses KILN_TABLE_FORMAT_AUTO
    kiln_table_format table_format;
    bool zstd;
    double limit; ///< largest radiance that files with KILN_FORMAT_AUTO hold; 0 for no limit
    /// Reading: a format that is recognised by its first bytes has exactly one of the four
    /// functions read_picture, read_layer, read and describe.
    ki_read_picture *read_picture;
    ki_read_layer *read_layer; ///< reads a picture from files with layers, of which one is chosen
    ki_read_file *read;
    ki_describe_file *describe; ///< describes files whose texels kiln does not read
    ki_write_picture *write_picture;
    ki_write_cube *write_cube;
} ki_file_format;

/// Returns the row of the table for the ending of a path, in lower or upper case, or NULL if no
/// format has the ending.
const ki_file_format *ki_file_format_of_path(const char *path);
/// Returns whether files of a format can hold at least one of the contents in `holds`, a sum of
/// KI_HOLDS constants. False if `format` is NULL.
static inline bool ki_file_holds(const ki_file_format *format, unsigned holds)
{
    return format && (format->holds & holds);
}

/// Checks the compression level of a file of this format: 0 for none, or 1 to 22 for KTX2 in a
/// build with zstd.
kiln_result ki_check_zstd(const char *path, const ki_file_format *file, int level,
                          kiln_error *error);

enum { KI_ENDINGS_TEXT = 96 };
/// Writes the endings of all formats that hold at least one of the contents in `holds`, a sum of
/// KI_HOLDS constants, to `text`, for example ".exr .hdr or .png", and returns `text`. `more`,
/// which may be NULL, is a further ending at the end of the list.
const char *ki_list_endings(unsigned holds, const char *more, char text[KI_ENDINGS_TEXT]);
/// Writes the endings of all formats that store maps in `format` to `text`, and returns `text`.
const char *ki_list_endings_of_format(kiln_format format, char text[KI_ENDINGS_TEXT]);

#endif
