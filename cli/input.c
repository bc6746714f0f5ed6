// Loads the input of a command: one file, folder or pattern, or six faces of a cube; and says on
// standard error what the loader found.
#include "work.h"

#include <string.h>

enum { FACES = 6 };

int cli_check_input(const cli_command *command, const char **names, int count)
{
    int order[FACES];
    if (count == 0)
        return cli_wrong(command, "no input is named, name a panorama or six faces");
    if (count != 1 && count != FACES)
        return cli_wrong(command,
                         "%d inputs are named, name one file, folder or pattern, or six faces, or "
                         "write {name} in the "
                         "output for several environments",
                         count);
    if (count == 1)
        return CLI_GO;
    for (int i = 0; i < FACES; i++)
        if (!strcmp(names[i], "-"))
            return cli_wrong(command, "standard input (-) cannot be one of six faces");
    if (!kiln_faces_order(names, order))
        return cli_wrong(command,
                         "the names of the six inputs do not tell which face each is, end them in "
                         "px nx py ny pz nz or in right left top bottom front back");
    return CLI_GO;
}

void cli_say_report(cli_work *work, const char *name)
{
    kiln_note note;
    for (int i = 0; kiln_load_report_note(&work->loaded, i, &note) && !work->quiet; i++)
        cli_note(work, note.warning, "%s: %s", name, note.text);
}

int cli_load(cli_work *work, const char **names, int count, const kiln_load_def *def, kiln_map *map)
{
    kiln_load_def full = *def;
    full.report = &work->loaded;
    kiln_result result = count == FACES
                             ? kiln_map_load_faces(work->context, names, &full, map, &work->error)
                             : kiln_map_load(work->context, names[0], &full, map, &work->error);
    if (result != KILN_OK)
        return CLI_FAILED;
    cli_say_report(work, names[0]);
    return CLI_GO;
}
