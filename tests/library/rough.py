"""Three heights of the surface of `heights_are_the_same_on_every_platform`, by a sum over its waves.

    python3 tests/library/rough.py
"""

from math import cos, log, pi, sin, sqrt

N, SEED = 64, 1
K_L, K_R, K_S, HURST, RMS_SLOPE = 2, 4, 20, 0.8, 0.1
WORD = 0xFFFFFFFF


def philox(counter, key):
    """Philox 4x32-10 (Salmon et al. 2011)."""
    (a, b, c, d), (k, l) = counter, key
    for _ in range(10):
        first, second = 0xD2511F53 * a, 0xCD9E8D57 * c
        a, b, c, d = (second >> 32) ^ b ^ k, second & WORD, (first >> 32) ^ d ^ l, first & WORD
        k, l = (k + 0x9E3779B9) & WORD, (l + 0xBB67AE85) & WORD
    return a, b, c, d


def amplitude(kx, ky):
    """A complex Gaussian number of unit mean square, by its radius and its angle."""
    a, b, c, d = philox((kx & WORD, ky, 0, 0), (SEED, 0))
    radius, turn = ((a << 32 | b) >> 11) / 2**53, ((c << 32 | d) >> 11) / 2**53
    modulus = sqrt(-log(1 - radius))
    return modulus * cos(2 * pi * turn), modulus * sin(2 * pi * turn)


waves = []
for ky in range(K_S + 1):
    for kx in range(1 if ky == 0 else -K_S, K_S + 1):
        k2 = kx**2 + ky**2
        if K_L**2 <= k2 <= K_S**2:
            density = 1 if k2 <= K_R**2 else (k2 / K_R**2) ** (-1 - HURST)
            real, imaginary = amplitude(kx, ky)
            waves.append((kx, ky, sqrt(density) * real, sqrt(density) * imaginary))

# each wave stands for its mirror image, too
slope = 2 * pi * sqrt(sum(2 * (re**2 + im**2) * (kx**2 + ky**2) for kx, ky, re, im in waves))
for i, j in (0, 0), (32, 32), (17, 50):
    # the origin is the middle of the grid
    phase = [2 * pi * (kx * (i - N // 2) + ky * (j - N // 2)) / N for kx, ky, _, _ in waves]
    height = sum(2 * (re * cos(p) - im * sin(p)) for p, (_, _, re, im) in zip(phase, waves))
    print(repr(RMS_SLOPE / slope * height))
