// Writes gallery.html around the HTML that gallery.mjs made with the engines.
#include "demo.h"

#include <string.h>

static void copy(FILE *from, FILE *to)
{
    char bytes[1 << 14];
    size_t size;
    while ((size = fread(bytes, 1, sizeof bytes, from)) > 0)
        fwrite(bytes, 1, size, to);
}

kiln_result demo_gallery_page(const char *folder, bool *made, kiln_error *error)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/" DEMO_GALLERY, folder);
    FILE *drawn = fopen(path, "rb");
    *made = drawn != NULL;
    if (!drawn)
        return KILN_OK;
    FILE *f = demo_page_open(folder, "gallery.html", error);
    if (!f) {
        fclose(drawn);
        return error->result;
    }
    demo_page_head(f);
    fputs("<header><div><h1>In the engines</h1><p class=\"lead\">The same panorama in four "
          "engines: lit by "
          "the file that kiln wrote for each, and by what the engine makes of the panorama "
          "itself.</p>\n"
          "<nav><a href=\"index.html\">kiln</a><a href=\"tables.html\">Exact tables</a>"
          "<a href=\"assignment.html\">The assignment</a></nav></div></header>\n<main>\n"
          "<p>Balls of white metal, of roughness 0.1, 0.25, 0.4, 0.6, 0.8 and 1, drawn by the "
          "published "
          "engines in a headless browser. Filament filters nothing in a browser, so its own tool, "
          "cmgen, stands "
          "there. Errors are against the same shading of light that is filtered exactly for each "
          "pixel: "
          "grey is right, and the numbers are the relative rms of each ball in percent.</p>\n",
          f);
    copy(drawn, f);
    demo_page_foot(f, "Pictures are c / (c + 1) with the power 1 / 2.2.");
    bool failed = ferror(drawn);
    fclose(drawn);
    if (failed) {
        snprintf(error->message, sizeof error->message, "%.400s: cannot be read whole", path);
        error->result = KILN_ERROR_IO;
    }
    return demo_page_close(f, folder, "gallery.html", failed ? KILN_ERROR_IO : KILN_OK, error);
}
