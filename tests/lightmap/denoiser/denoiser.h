// A stand-in for Open Image Denoise, which few distributions have: src/lightmap/denoise.c is
// compiled and run with it.
#pragma once

extern struct test_denoiser_state {
    int live;         // devices, buffers and filters that are not released
    int images;       // denoised ones
    int buffers_left; // that succeed; below 0: all
} test_denoiser;
