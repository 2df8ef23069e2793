// Exact orientation and collinearity tests.
#pragma once

#include "base/geometry.h"

namespace partwheel {

// The exact sign (-1, 0, 1) of signed_volume6(a, b, c, d). Where a filter does not decide, it is computed by expansion
// arithmetic (Shewchuk 1997, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates").
// Thread-safe: unlike TetGen's own predicates it keeps no state. Exact as long as no product of three coordinate
// differences under- or overflows.
int orientation(const Point& a, const Point& b, const Point& c, const Point& d);

// Exact: 1 if a, b, c, projected along a coordinate axis, turn left, -1: right, 0: collinear.
int orientation_along(size_t axis, const Point& a, const Point& b, const Point& c);

// Exact.
bool collinear(const Point& a, const Point& b, const Point& c);

}  // namespace partwheel
