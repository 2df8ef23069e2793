// Sparse factorization, one row of L after the other (up-looking).
#include "edit/sparse_factor.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace partwheel {

namespace {

using Matrix = Eigen::SparseMatrix<double>;

// Rows of L have nonzeros where paths in the elimination tree lead, upward from the entries of the matrix's column.
class EliminationTree {
public:
    explicit EliminationTree(int32_t size) : parent_(idx(size), -1), visited_(idx(size), 0), path_(idx(size)) {}

    // Calls visit(column) for each column of a row with a nonzero, before those of columns above it.
    template <class Function>
    void for_each_in_row(const Matrix& upper, int32_t row, const Function& visit) {
        visited_[idx(row)] = ++stamp_;
        auto first = path_.end();
        for (Matrix::InnerIterator entry(upper, row); entry; ++entry) {
            auto last = path_.begin();
            for (int32_t i = entry.index(); visited_[idx(i)] != stamp_; i = parent_[idx(i)]) {
                if (parent_[idx(i)] < 0) parent_[idx(i)] = row;
                visited_[idx(i)] = stamp_;
                *last++ = i;
            }
            first = std::copy_backward(path_.begin(), last, first);
        }
        std::for_each(first, path_.end(), visit);
    }

private:
    std::vector<int32_t> parent_;
    std::vector<int64_t> visited_;  // the last call that did
    int64_t stamp_ = 0;
    std::vector<int32_t> path_;
};

// Numbers of rows and columns that keep L sparse.
Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> elimination_order(const Matrix& whole) {
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
    Eigen::AMDOrdering<int>()(whole, inverse);
    return inverse.inverse();
}

}  // namespace

SparseFactor::SparseFactor(const Matrix& matrix, Progress& progress, double begin, double end) {
    const auto size = static_cast<int32_t>(matrix.rows());
    const auto reach = [&](double part) { progress.reach(begin + part * (end - begin)); };
    reach(0);
    const Matrix whole = matrix.selfadjointView<Eigen::Lower>();
    reach(0.02);
    const auto order = elimination_order(whole);  // can't be canceled, but takes less than 0.1 s for 100,000 unknowns
    row_of_.assign(order.indices().begin(), order.indices().end());
    reach(0.08);
    Matrix upper(size, size);
    upper.selfadjointView<Eigen::Upper>() = matrix.selfadjointView<Eigen::Lower>().twistedBy(order);
    std::vector<size_t> count(idx(size), 0);  // of nonzeros in each column
    EliminationTree tree(size);
    for (int32_t k = 0; k < size; ++k) {
        if (k % 1024 == 0) reach(0.1);
        tree.for_each_in_row(upper, k, [&](int32_t i) { ++count[idx(i)]; });
    }
    column_.push_back(0);
    for (const size_t n : count) column_.push_back(column_.back() + n);
    row_.resize(column_.back());
    reach(0.15);
    value_.resize(column_.back());
    reach(0.2);

    std::ranges::fill(count, 0);
    std::vector<double> y(idx(size), 0), diagonal(idx(size));
    for (int32_t k = 0; k < size; ++k) {
        reach(0.2 + 0.8 * k / size);  // at each row: the last ones take milliseconds
        for (Matrix::InnerIterator entry(upper, k); entry; ++entry) y[idx(entry.index())] += entry.value();
        double d = std::exchange(y[idx(k)], 0.0);
        tree.for_each_in_row(upper, k, [&](int32_t i) {
            const double scaled = std::exchange(y[idx(i)], 0.0), value = scaled / diagonal[idx(i)];
            const size_t last = column_[idx(i)] + count[idx(i)]++;
            for (size_t p = column_[idx(i)]; p < last; ++p) y[idx(row_[p])] -= value_[p] * scaled;
            d -= value * scaled;
            row_[last] = k;
            value_[last] = value;
        });
        diagonal[idx(k)] = d;
    }
    for (const double d : diagonal) inverse_d_.push_back(1 / d);
}

bool SparseFactor::is_positive_definite() const {
    return std::ranges::all_of(inverse_d_, [](double x) { return x > 0 && std::isfinite(x); });
}

void SparseFactor::solve(std::vector<Point>& x) const {
    const size_t size = inverse_d_.size();
    for (size_t j = 0; j < size; ++j) {
        const Point xj = x[j];
        for (size_t p = column_[j]; p < column_[j + 1]; ++p) {
            Point& to = x[row_[p]];
            const double value = value_[p];
            to[0] -= value * xj[0], to[1] -= value * xj[1], to[2] -= value * xj[2];
        }
    }
    for (size_t j = size; j-- > 0;) {
        Point sum = inverse_d_[j] * x[j];
        for (size_t p = column_[j]; p < column_[j + 1]; ++p) {
            const Point& from = x[row_[p]];
            const double value = value_[p];
            sum[0] -= value * from[0], sum[1] -= value * from[1], sum[2] -= value * from[2];
        }
        x[j] = sum;
    }
}

}  // namespace partwheel
