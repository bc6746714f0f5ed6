#include "sphere/fft.h"

#include "math/math.h"

static int next_radix(int length)
{
    if (length % 4 == 0)
        return 4;
    for (int r = 2; r * r <= length; r++)
        if (length % r == 0)
            return r;
    return length;
}

int ki_fft_good_length(int length)
{
    int best = 2;
    while (best < length)
        best *= 2;
    for (int threes = 3; threes <= 9; threes *= 3) {
        int n = 2 * threes;
        while (n < length)
            n *= 2;
        if (n < best)
            best = n;
    }
    return best;
}

bool ki_fft_create(kiln_context *context, int length, ki_fft *fft)
{
    *fft = (ki_fft){.length = length};
    size_t room = 0;
    for (int n = length; n > 1;) {
        int r = next_radix(n);
        room += 2 * ((size_t)(n / r) * (size_t)(r - 1) + (size_t)r);
        n /= r;
    }
    fft->tables = ki_alloc_raw(context, room + 2, sizeof *fft->tables);
    if (!fft->tables)
        return false;

    double *at = fft->tables;
    int stride = 1;
    for (int n = length; n > 1;) {
        int r = next_radix(n);
        ki_fft_pass *pass = &fft->pass[fft->pass_count++];
        *pass = (ki_fft_pass){.radix = r, .length = n, .stride = stride, .twiddles = at};
        for (int p = 0; p < n / r; p++)
            for (int j = 1; j < r; j++, at += 2) {
                int64_t turn = (int64_t)p * j % n;
                ki_sincos(-2 * KI_PI * (double)turn / n, &at[1], &at[0]);
            }
        pass->roots = at;
        for (int j = 0; j < r; j++, at += 2)
            ki_sincos(-2 * KI_PI * j / r, &at[1], &at[0]);
        n /= r;
        stride *= r;
    }
    return true;
}

void ki_fft_destroy(ki_fft *fft)
{
    ki_free(fft->tables);
    *fft = (ki_fft){0};
}
