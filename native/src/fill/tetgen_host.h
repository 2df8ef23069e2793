// The build includes this before all of TetGen's code. It replaces printf and std::cerr, because TetGen prints even in
// quiet mode, and rand and srand, because other threads of the host may draw from the C library's generator. The build
// also replaces orient3d(): its calls are the steps of TetGen, which must be counted, because it may not terminate. And
// it adds calls of partwheel_tetgen_poll(), which checks for cancellation, and of those that limit the improvement of
// tetrahedra. acos, cos and log are replaced because their last bits differ between systems; cmake/patched_tetgen.cmake
// checks that TetGen calls no other such function. The functions are in tetrahedra.cpp.
#pragma once

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <ostream>

extern "C" {
int partwheel_tetgen_printf(const char* format, ...);
int partwheel_tetgen_rand();
void partwheel_tetgen_srand(unsigned seed);
void partwheel_tetgen_poll();
void partwheel_tetgen_begin_improving();
bool partwheel_tetgen_must_end_improving();
double partwheel_tetgen_acos(double cosine);
double partwheel_tetgen_cos(double angle);
double partwheel_tetgen_log(double x);
}
double partwheel_tetgen_orient3d(double* a, double* b, double* c, double* d);

// A stream that writes nothing.
inline constexpr struct {
    template <class T>
    const auto& operator<<(const T&) const { return *this; }
    const auto& operator<<(std::ostream& (*)(std::ostream&)) const { return *this; }
} partwheel_tetgen_cerr;

#if defined(PARTWHEEL_COMPILES_TETGEN)
#define printf partwheel_tetgen_printf
#define rand partwheel_tetgen_rand
#define srand partwheel_tetgen_srand
#define acos partwheel_tetgen_acos
#define cos partwheel_tetgen_cos
#define log partwheel_tetgen_log
#endif
