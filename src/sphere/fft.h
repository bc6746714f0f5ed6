// Fourier transforms of any length, eight at a time.
#ifndef KI_FFT_H
#define KI_FFT_H

#include "sphere/kernels.h"

/// Prepares a forward transform: y_k = sum_j x_j exp(-2 pi i j k / length). Lengths with prime
/// factors above 5 work, at a cost that grows with the factor. False when memory runs out.
bool ki_fft_create(kiln_context *context, int length, ki_fft *fft);
void ki_fft_destroy(ki_fft *fft);
/// The smallest length of factors 2, 3, 4 that is even and at least `length`.
int ki_fft_good_length(int length);

#endif
