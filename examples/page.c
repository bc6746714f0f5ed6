// Writes the HTML of the demo's pages. In: sections' text and pictures. Out: self-contained HTML
// files with style, script and constant text, whose pictures are PNGs in base64.
#include "demo.h"

#include <kiln/course.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char style_of_text[] =
    "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
    "<title>kiln: exact image-based lighting</title>\n<style>\n"
    ":root{color-scheme:light dark;--back:#f7f6f3;--card:#fff;--ink:#1d1c1a;--soft:#6a665f;"
    "--line:#e2dfd8;--accent:#b4501e;--bar:#d9d5cc;--shade:#0000000f}\n"
    "@media(prefers-color-scheme:dark){:root{--back:#141312;--card:#1e1d1b;--ink:#eceae6;"
    "--soft:#a29d94;--line:#34322e;--accent:#f08a4b;--bar:#3a3733;--shade:#0006}}\n"
    "*{box-sizing:border-box}\nhtml{scroll-behavior:smooth}\n"
    "body{margin:0;background:var(--back);color:var(--ink);font:17px/1.6 system-ui,sans-serif}\n"
    "main,header>div,footer{max-width:1180px;margin:0 auto;padding:0 24px}\n"
    "header{position:relative}\nheader>img{display:block;width:100%;height:auto;min-height:150px;"
    "object-fit:cover}\n"
    "h1{font-size:clamp(2.2rem,6vw,3.4rem);line-height:1.1;letter-spacing:-.02em;"
    "margin:1.6rem 0 .4rem}\n"
    "h2{font-size:clamp(1.6rem,4vw,2.2rem);line-height:1.2;letter-spacing:-.01em;"
    "margin:4.5rem 0 .3rem;padding-top:2rem;border-top:1px solid var(--line)}\n"
    "main>h2:first-child{margin-top:2rem}\n"
    "h3{font-size:1.25rem;margin:2.8rem 0 .2rem}\n"
    "p{max-width:46rem;margin:.5rem 0 1rem}\n.lead{font-size:1.25rem;color:var(--soft)}\n"
    ".soft,figcaption,.note{color:var(--soft);font-size:.92rem}\n"
    "a{color:var(--accent)}\n"
    "nav{display:flex;flex-wrap:wrap;gap:.4rem .6rem;margin:1.4rem 0}\n"
    "nav a{padding:.25rem .85rem;border:1px solid var(--line);border-radius:2rem;"
    "background:var(--card);text-decoration:none;font-size:.95rem}\n"
    "figure{margin:0;min-width:0}\nfigcaption{margin-top:.4rem;line-height:1.4}\n"
    "figcaption b{color:var(--ink);font-variant-numeric:tabular-nums}\n"
    "sup{line-height:0}\nimg{display:block;max-width:100%}\n"
    ".wide{width:100%;height:auto;border-radius:10px}\n"
    ".texels{width:100%;height:auto;image-rendering:pixelated}\n.ball{width:100%;height:auto}\n"
    ".cards{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(200px,44%),1fr));gap:"
    "14px;"
    "margin:1.6rem 0}\n"
    ".card{background:var(--card);border:1px solid var(--line);border-radius:14px;"
    "padding:18px 20px;box-shadow:0 2px 10px var(--shade)}\n"
    ".card strong{display:block;font-size:1.75rem;line-height:1.25;letter-spacing:-.02em;"
    "font-variant-numeric:tabular-nums}\n.card span{color:var(--soft);font-size:.92rem}\n";
static const char style_of_parts[] =
    ".balls{display:grid;grid-template-columns:repeat(9,1fr);gap:14px;margin:1.2rem 0}\n"
    ".balls figcaption{text-align:center}\n"
    ".crosses{display:grid;grid-template-columns:repeat(3,1fr);gap:26px;"
    "margin:1.2rem 0}\n"
    ".pair{display:grid;grid-template-columns:repeat(4,1fr);gap:8px 20px;margin:1rem 0;"
    "padding:18px 20px;background:var(--card);border:1px solid var(--line);border-radius:14px}\n"
    ".pair h4{grid-column:1/-1;margin:0;font-size:1rem}\n"
    ".rows{display:grid;grid-template-columns:1fr 1fr;gap:8px 20px;margin:1rem 0}\n"
    ".rows h3{grid-column:1/-1;margin:1rem 0 0}\n"
    ".three{display:grid;grid-template-columns:repeat(3,1fr);gap:20px;margin:1rem 0}\n"
    ".three .ball{max-width:240px}\n"
    ".turn{display:flex;flex-wrap:wrap;align-items:center;gap:14px 34px;margin:1.4rem 0}\n"
    ".turn .stack{position:relative;width:240px;height:240px;flex:none}\n"
    ".turn .stack img{position:absolute;inset:0;width:100%;height:100%}\n"
    ".turn label{flex:1 1 260px;max-width:420px}\n.turn input{width:100%;"
    "accent-color:var(--accent)}\n"
    ".legend{max-width:520px;margin:1.2rem 0}\n.legend i{display:block;height:16px;"
    "border-radius:8px}\n"
    ".legend div{display:flex;justify-content:space-between;font-size:.85rem;color:var(--soft);"
    "font-variant-numeric:tabular-nums}\n"
    ".scroll{overflow-x:auto;margin:1.2rem 0}\n"
    "table{border-collapse:collapse;min-width:100%;font-variant-numeric:tabular-nums;"
    "font-size:.97rem}\n"
    "th,td{padding:.5rem .9rem;text-align:right;border-bottom:1px solid var(--line);"
    "white-space:nowrap}\n"
    "th:first-child,td:first-child{text-align:left;padding-left:0}\n"
    "thead th{font-weight:600;color:var(--soft);font-size:.88rem}\ntd.good{color:var(--accent);"
    "font-weight:600}\n"
    ".bars{display:grid;grid-template-columns:15.5rem 1fr;gap:10px 18px;"
    "align-items:center;margin:1.2rem 0}\n"
    ".bars span{line-height:1.3;font-size:.97rem}\n.bars div{display:flex;align-items:center;"
    "gap:10px;min-width:0}\n"
    ".bars i{display:block;height:18px;min-width:3px;border-radius:4px;background:var(--bar)}\n"
    ".bars i.own{background:var(--accent)}\n.bars b{white-space:nowrap;font-weight:600;"
    "font-variant-numeric:tabular-nums;font-size:.95rem}\n"
    ".table{display:flex;flex-wrap:wrap;gap:24px 40px;align-items:center;margin:1.2rem 0}\n"
    ".table figure{position:relative;padding:0 0 30px 34px}\n.table figure img{width:256px;"
    "height:256px;border-radius:6px}\n"
    ".table .x,.table .y{position:absolute;font-size:.85rem;color:var(--soft);"
    "white-space:nowrap}\n"
    ".table .x{left:34px;right:0;bottom:2px;display:flex;justify-content:space-between}\n"
    ".table .y{left:0;top:256px;width:256px;transform:rotate(-90deg);transform-origin:0 0;"
    "display:flex;justify-content:space-between}\n"
    ".table div.words{flex:1 1 300px}\n"
    "footer{margin-top:4rem;padding-top:1.4rem;padding-bottom:3rem;color:var(--soft);"
    "font-size:.92rem}\n"
    "@media(max-width:760px){body{font-size:16px}main,header>div,footer{padding:0 16px}"
    ".balls{grid-template-columns:repeat(3,1fr)}.crosses{grid-template-columns:1fr 1fr;gap:14px}"
    ".pair{grid-template-columns:1fr "
    "1fr;padding:14px}.rows{grid-template-columns:1fr}.three{gap:10px}"
    ".bars{grid-template-columns:1fr;gap:2px}.bars div{margin-bottom:10px}"
    ".turn .stack{margin:auto}th,td{padding:.45rem .35rem}table{font-size:.84rem}thead "
    "th{font-size:.8rem}"
    ".card{padding:14px}.card strong{font-size:1.45rem}}\n"
    "</style>\n</head>\n<body>\n";

// Script of the pages: lays the balls of a section on top of each other; a slider fades between
// neighbouring balls.
static const char script[] =
    "<script>\n"
    "for (const turn of document.querySelectorAll('.turn')) {\n"
    "  const stack = turn.querySelector('.stack'), input = turn.querySelector('input');\n"
    "  const layers = [...document.querySelectorAll('#' + turn.dataset.balls + ' img')]\n"
    "    .map(ball => stack.appendChild(Object.assign(new Image(), {src: ball.src, alt: ''})));\n"
    "  const show = () => {\n"
    "    const at = input.value * (layers.length - 1);\n"
    "    layers.forEach((layer, k) => {\n"
    "      layer.style.opacity = k < Math.floor(at) ? 0 : Math.max(0, Math.min(1, at - k + 1));\n"
    "    });\n"
    "    turn.querySelector('output').textContent = (+input.value).toFixed(2);\n"
    "  };\n"
    "  turn.hidden = false;\n"
    "  input.addEventListener('input', show);\n"
    "  show();\n"
    "}\n"
    "</script>\n";

void demo_page_head(FILE *file)
{
    fputs(style_of_text, file);
    fputs(style_of_parts, file);
}

void demo_page_foot(FILE *file, const char *words)
{
    fprintf(file, "</main>\n<footer>Made by the demo of kiln %s. %s</footer>\n%s</body>\n</html>\n",
            kiln_version(), words, script);
}

void demo_page_text(FILE *file, const char *text)
{
    for (; *text; text++)
        switch (*text) {
        case '&':
            fputs("&amp;", file);
            break;
        case '<':
            fputs("&lt;", file);
            break;
        case '>':
            fputs("&gt;", file);
            break;
        case '"':
            fputs("&quot;", file);
            break;
        default:
            fputc(*text, file);
        }
}

void demo_page_legend(FILE *file)
{
    fputs("<div class=\"legend\"><i style=\"background:linear-gradient(90deg", file);
    for (int i = 0; i < DEMO_ERROR_COLORS; i++)
        fprintf(file, ",rgb(%d %d %d)", demo_error_colors[i][0], demo_error_colors[i][1],
                demo_error_colors[i][2]);
    fputs(")\"></i><div><span>10<sup>&minus;7</sup></span><span>10<sup>&minus;6</sup></span>"
          "<span>10<sup>&minus;5</sup></span><span>10<sup>&minus;4</sup></span><span>0.1%</span>"
          "<span>1%</span><span>10%</span><span>100%</span></div></div>\n",
          file);
}

// ---------------------------------------------------------------------------------------- pictures

static void write_base64(FILE *file, const unsigned char *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i;
        unsigned group = (unsigned)bytes[i] << 16 | (left > 1 ? (unsigned)bytes[i + 1] << 8 : 0) |
                         (left > 2 ? (unsigned)bytes[i + 2] : 0);
        fputc(digits[group >> 18], file);
        fputc(digits[group >> 12 & 63], file);
        fputc(left > 1 ? digits[group >> 6 & 63] : '=', file);
        fputc(left > 2 ? digits[group & 63] : '=', file);
    }
}

// Writes the picture as a PNG to a scratch file and reads it back, because kiln_image_save writes
// to files only.
kiln_result demo_page_picture(demo_page *page, kiln_image *image, const char *style_class,
                              const char *alt, kiln_error *error)
{
    kiln_result result = kiln_image_save(page->context, image, page->scratch, error);
    int width = image->width, height = image->height;
    kiln_image_free(image);
    if (result)
        return result;
    unsigned char *bytes = NULL;
    long size = 0;
    FILE *png = fopen(page->scratch, "rb");
    if (png && !fseek(png, 0, SEEK_END) && (size = ftell(png)) > 0 && !fseek(png, 0, SEEK_SET))
        bytes = malloc((size_t)size);
    if (!bytes || fread(bytes, 1, (size_t)size, png) != (size_t)size) {
        result = error->result = KILN_ERROR_IO;
        snprintf(error->message, sizeof error->message, "%s: cannot be read back", page->scratch);
    } else {
        fprintf(page->file, "<img class=\"%s\" width=\"%d\" height=\"%d\" alt=\"", style_class,
                width, height);
        demo_page_text(page->file, alt);
        fputs("\" src=\"data:image/png;base64,", page->file);
        write_base64(page->file, bytes, (size_t)size);
        fputs("\">", page->file);
    }
    free(bytes);
    if (png)
        fclose(png);
    remove(page->scratch);
    return result;
}

kiln_result demo_signed_legend(demo_page *page, kiln_error *error)
{
    enum { HALF = 260, HEIGHT = 8 };
    kiln_image off = {0}, none = {0}, map = {0};
    kiln_difference d;
    kiln_result result = kiln_image_create(page->context, 2 * HALF, HEIGHT, 1, &off, error);
    if (!result)
        result = kiln_image_create(page->context, 2 * HALF, HEIGHT, 1, &none, error);
    for (int i = 0; i < 2 * HALF * HEIGHT && !result; i++) {
        double x = (i % (2 * HALF) + 0.5) / HALF - 1;
        off.pixels[i] = (float)(copysign(1e-4, x) * pow(10, 4 * fabs(x)));
    }
    if (!result)
        result = kiln_assignment_compare(page->context, &off, &none, &d, &map, error);
    fputs("<div class=\"legend\">", page->file);
    if (!result)
        result = demo_page_picture(page, &map, "wide", "Colours of the errors", error);
    fputs("<div><span>&minus;1</span><span>&minus;0.1</span><span>&minus;0.01</span>"
          "<span>&minus;0.001</span><span>0</span><span>0.001</span><span>0.01</span>"
          "<span>0.1</span><span>1</span></div></div>\n"
          "<p class=\"note\">Blue is too dark, red too bright; white is within 0.0001.</p>\n",
          page->file);
    kiln_image_free(&none);
    kiln_image_free(&off);
    return result;
}

// ------------------------------------------------------------------------------------------- files

static kiln_result fail(const char *folder, const char *name, const char *why, kiln_error *error)
{
    snprintf(error->message, sizeof error->message, "%.300s/%s: cannot be written%s", folder, name,
             why);
    return error->result = KILN_ERROR_IO;
}

FILE *demo_page_open(const char *folder, const char *name, kiln_error *error)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    if (!file)
        fail(folder, name, "", error);
    return file;
}

kiln_result demo_page_close(FILE *file, const char *folder, const char *name, kiln_result result,
                            kiln_error *error)
{
    bool failed = ferror(file);
    failed |= fclose(file) != 0;
    if (failed && !result)
        return fail(folder, name, " whole", error);
    if (!result)
        printf("wrote %s/%s\n", folder, name);
    return result;
}
