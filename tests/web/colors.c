// Prints a picture as a browser would show it: colors FILE writes red, green and blue of each
// pixel, encoded by the curve of sRGB in 8 bits, to standard output.
#include "image/pack.h"

#include <kiln/kiln.h>

#include <stdio.h>

int main(int count, char **arguments)
{
    kiln_context *context;
    kiln_error error;
    kiln_image image;
    if (count != 2 || kiln_context_create(NULL, &context, &error) != KILN_OK)
        return 2;
    if (kiln_image_load(context, arguments[1], &image, &error) != KILN_OK) {
        fprintf(stderr, "%s\n", error.message);
        return 1;
    }
    for (int i = 0; i < image.width * image.height * 3; i++) {
        float value = image.pixels[i] > 0 ? image.pixels[i] < 1 ? image.pixels[i] : 1 : 0;
        putchar((int)(ki_srgb_from_linear(value) * 255 + 0.5F));
    }
    kiln_image_free(&image);
    kiln_context_destroy(context);
    return fflush(stdout) ? 1 : 0;
}
