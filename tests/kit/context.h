// A context, an error, and where wanted a folder of files, for a whole test program:
//     cmocka_run_group_tests(tests, set_up, tear_down)
//     cmocka_run_group_tests(tests, set_up_folder, tear_down_folder)
// Include this header last, because its names are common words.
#ifndef KILN_KIT_CONTEXT_H
#define KILN_KIT_CONTEXT_H

#include "kit.h"

extern kiln_context *context;
extern kiln_error error; // what CHECK_OK prints

/// Makes a context of two threads.
int set_up(void **state);

/// Destroys the context, and fails if memory is still allocated in it.
int tear_down(void **state);

/// Makes the context, and the folder of folder.h.
int set_up_folder(void **state);

/// Removes the folder with all that is in it, and destroys the context as tear_down does.
int tear_down_folder(void **state);

/// Does what tear_down_folder does, and fails if the folder was not empty.
int tear_down_empty_folder(void **state);

#endif
