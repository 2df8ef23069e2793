// The sparse factorization: the same bits as Eigen's, and it can be canceled at each row.
#include "edit/sparse_factor.h"

#include "edit/deform.h"
#include "edit/fair.h"

#include <Eigen/SparseCholesky>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

// The symbol that the linker wraps.
#define PW_REACH _ZN9partwheel8Progress5reachEd
#define PW_JOINED(a, b) a##b
#define PW_NAME(prefix, call) PW_JOINED(prefix, call)

namespace partwheel::test {
namespace {

size_t polls = 0;
size_t cancel_at = 0;  // the number of a poll; 0: none

}  // namespace
}  // namespace partwheel::test

extern "C" {
void PW_NAME(__real_, PW_REACH)(partwheel::Progress*, double);
void PW_NAME(__wrap_, PW_REACH)(partwheel::Progress* progress, double fraction) {
    using namespace partwheel::test;
    if (++polls == cancel_at) progress->cancel();
    PW_NAME(__real_, PW_REACH)(progress, fraction);
}
}

namespace partwheel::test {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

// Of edges with random weights, plus the diagonal.
Matrix laplacian(int size, int edges, double diagonal, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> weight(0.1, 1);
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < size; ++i) entries.emplace_back(i, i, diagonal);
    for (int e = 0; e < edges; ++e) {
        const auto a = static_cast<int>(random() % static_cast<unsigned>(size));
        const auto b = static_cast<int>(random() % static_cast<unsigned>(size));
        if (a == b) continue;
        const double w = weight(random);
        entries.emplace_back(a, a, w);
        entries.emplace_back(b, b, w);
        entries.emplace_back(std::max(a, b), std::min(a, b), -w);
    }
    Matrix matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

TEST(SparseFactor, SolutionsAreThoseOfEigen) {
    for (const auto& [size, edges] : {std::pair{1, 0}, {2, 1}, {30, 40}, {300, 900}, {2000, 3000}}) {
        const Matrix matrix = laplacian(size, edges, 0.01, 7);
        const SparseFactor factor(matrix, unobserved_progress(), 0, 1);
        EXPECT_TRUE(factor.is_positive_definite());
        const Eigen::MatrixXd right = Eigen::MatrixXd::Random(size, 3);
        std::vector<Point> x(static_cast<size_t>(size));
        for (int i = 0; i < size; ++i) x[idx(factor.row_of(static_cast<size_t>(i)))] = {right(i, 0), right(i, 1), right(i, 2)};
        factor.solve(x);
        const Eigen::MatrixXd expected = Eigen::SimplicialLDLT<Matrix>(matrix).solve(right);
        for (int i = 0; i < size; ++i)
            for (int k = 0; k < 3; ++k)
                ASSERT_EQ(x[idx(factor.row_of(static_cast<size_t>(i)))][static_cast<size_t>(k)], expected(i, k));
    }
}

TEST(SparseFactor, SingularAndIndefiniteMatricesAreFound) {
    for (const double diagonal : {0.0, -0.5})
        EXPECT_FALSE(SparseFactor(laplacian(2, 1, diagonal, 1), unobserved_progress(), 0, 1).is_positive_definite());
    Matrix nan(1, 1);
    nan.insert(0, 0) = std::nan("");
    EXPECT_FALSE(SparseFactor(nan, unobserved_progress(), 0, 1).is_positive_definite());
}

// A square of n times n vertices whose boundary is fixed.
struct Sheet {
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;
    std::vector<std::array<int32_t, 2>> edges;
    std::vector<int32_t> roles;
    std::vector<uint8_t> is_free;

    explicit Sheet(int32_t n) {
        for (int32_t i = 0; i < n * n; ++i) {
            const int32_t x = i % n, y = i / n;
            const bool fixed = x == 0 || y == 0 || x == n - 1 || y == n - 1;
            vertices.push_back({x + 0.0, y + 0.0, std::sin(0.3 * x * y)});
            roles.push_back(x == 0 ? 0 : fixed ? PW_VERTEX_FIXED : PW_VERTEX_FREE);
            is_free.push_back(!fixed);
            if (x > 0) edges.push_back({i - 1, i});
            if (y > 0) edges.push_back({i - n, i});
            if (x == 0 || y == 0) continue;
            triangles.push_back({i - n - 1, i - n, i});
            triangles.push_back({i - n - 1, i, i - 1});
        }
    }
};

TEST(SparseFactor, FairingAndDeformationCanBeCanceledAtEachRow) {
    const Sheet sheet(60);
    const size_t unknowns = 58 * 58;
    const std::vector<std::function<void(Progress&)>> calls = {
        [&](Progress& progress) { fair_vertices(sheet.vertices, sheet.edges, sheet.is_free, progress); },
        [&](Progress& progress) { Deformation(sheet.vertices, sheet.triangles, sheet.roles, 1, progress); }};
    for (const auto& call : calls) {
        Progress progress;
        polls = cancel_at = 0;
        call(progress);
        EXPECT_GE(polls, unknowns);
        for (const size_t n : {polls - unknowns / 2, polls - 2}) {
            polls = 0;
            cancel_at = n;
            Progress canceled;
            EXPECT_THROW(call(canceled), Error) << n;
            EXPECT_EQ(polls, n);
        }
        cancel_at = 0;
    }
}

}  // namespace
}  // namespace partwheel::test
