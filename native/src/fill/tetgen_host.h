// Included before all of TetGen's own code by the build: what TetGen gets for printf, rand and srand. It prints even when
// told to be quiet, and with the C library's own numbers a host that draws some in another thread would change the
// result. So does the build for orient3d(): its calls are TetGen's steps, which are counted, for it may come to no end.
// And it adds calls of partwheel_tetgen_poll(), in which a cancellation is asked for. The functions are in tetrahedra.cpp.
#pragma once

#include <stdio.h>
#include <stdlib.h>

extern "C" {
int partwheel_tetgen_printf(const char* format, ...);
int partwheel_tetgen_rand();
void partwheel_tetgen_srand(unsigned seed);
void partwheel_tetgen_poll();
}
double partwheel_tetgen_orient3d(double* a, double* b, double* c, double* d);

#if defined(PARTWHEEL_COMPILES_TETGEN)
#define printf partwheel_tetgen_printf
#define rand partwheel_tetgen_rand
#define srand partwheel_tetgen_srand
#endif
