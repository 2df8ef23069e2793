// The factorization of sparse systems of equations, which can be canceled.
#pragma once

#include "base/geometry.h"
#include "base/progress.h"

namespace Eigen {
template <typename Scalar, int Options, typename Index> class SparseMatrix;
}

namespace partwheel {

// L D L^T of a symmetric matrix. The steps and bits are those of Eigen::SimplicialLDLT, which doesn't check for
// cancellation.
class SparseFactor {
public:
    SparseFactor() = default;
    // Reads the lower triangle. The progress goes from `begin` to `end`.
    SparseFactor(const Eigen::SparseMatrix<double, 0, int>& matrix, Progress& progress, double begin, double end);

    bool is_positive_definite() const;
    // The row of each unknown in the arguments of solve().
    int32_t row_of(size_t unknown) const { return row_of_[unknown]; }
    // Replaces right sides, three at once, by solutions. They are not finite if the matrix is singular.
    void solve(std::vector<Point>& x) const;

private:
    std::vector<int32_t> row_of_;
    // Below the diagonal of L, column by column; entries of D.
    std::vector<size_t> column_;
    std::vector<int32_t> row_;
    std::vector<double> value_, inverse_d_;
};

}  // namespace partwheel
