// The six files of a cube's faces: which names files of faces have, and which file is which face.
#ifndef KI_FACES_H
#define KI_FACES_H

#include "base/base.h"

/// The names that a program uses for the six faces of a cube; faces.c has the table of these sets.
typedef struct ki_face_set ki_face_set;

/// Paths of six files in the order +X -X +Y -Y +Z -Z.
typedef struct ki_face_files {
    const char *path[6];
    /// the set of names that the paths have; NULL if the names do not tell the faces
    const ki_face_set *set;
    char *owner; ///< memory of the paths, freed by ki_face_files_free
} ki_face_files;

/// Finds the files of six cube faces in a folder.
kiln_result ki_faces_in_folder(kiln_context *context, const char *folder, ki_face_files *files,
                               kiln_error *error);
/// Finds the files of six cube faces by a pattern, a path in which `length` characters at `place`
/// stand for the name of the face.
kiln_result ki_faces_of_pattern(kiln_context *context, const char *pattern, const char *place,
                                size_t length, ki_face_files *files, kiln_error *error);
void ki_face_files_free(ki_face_files *files);

/// Sets order[face] to the index of the path of each face, and returns the set whose names the
/// paths have. Returns NULL, with the order unchanged, if no set has all six.
const ki_face_set *ki_faces_order(const char *const paths[6], int order[6]);
/// Adds a note that says which axes the names of the faces were taken for, where names leave that
/// open. `set` may be NULL.
void ki_faces_note(const ki_face_set *set, kiln_load_report *report);
/// Copies a square picture of three channels to a face of a cube, turned from the orientation that
/// pictures with this set of names have to that of kiln. `set` may be NULL.
/// Returns false if the caller of the library wants to stop.
bool ki_face_place(kiln_context *context, const ki_face_set *set, const kiln_image *image, int face,
                   float *texels);

#endif
