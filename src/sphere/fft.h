// Fast Fourier transforms of any length. One call transforms eight independent signals, one in each
// lane of the vectors.
#ifndef KI_FFT_H
#define KI_FFT_H

#include "sphere/kernels.h"

/// Prepares the forward transform y_k = sum_j x_j exp(-2 pi i j k / length). Every length is
/// allowed; a prime factor above 4 costs time in proportion to the factor. Returns false when
/// memory runs out.
bool ki_fft_create(kiln_context *context, int length, ki_fft *fft);
void ki_fft_destroy(ki_fft *fft);
/// Returns the smallest even length of at least `length` whose only prime factors are 2 and at most
/// two factors of 3.
int ki_fft_good_length(int length);

#endif
