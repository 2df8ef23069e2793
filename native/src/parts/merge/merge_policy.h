// The merge policy: two small neural networks rebuild the top of the paper's tree from a few hundred parts, merged in
// the order that people would, with borders snapped to creases.
//
// Concavity alone merges the halves of a leg late and the handle of a cup early. So the paper's tree is cut into
// initial parts, which merge again bottom-up. The cost of a merge is the logit of the probability that people
// separate the two parts. A network with one hidden layer of softsigns (Mlp) computes it from 32 features of
// the pair: sizes, convexity, the hull of both, the interface (cross-section) and the length and creases of the
// border, after Golovinskiy and Funkhouser, "Randomized Cuts for 3D Mesh Analysis" (2008). A second network scores
// each node of the result from 48 features. feature_names.h defines the features; network_weights.h has the weights,
// fitted to human segmentations by tests/quality/fit.py. Only basic arithmetic and square roots are used, so every
// machine computes the same bits. initial_parts.cpp chooses the parts, features.cpp and evaluate.cpp compute features
// and networks, merge_parts.cpp merges. tests/core/reference_merge_policy.py implements this description
// independently:
//
// The unit of length is the longest side of the bounding box.
//
// Initial parts. Start with the components. Replace the cluster with the largest area x concavity / hull volume (in
// single precision; in a tie the one with the lowest id) by its two children in the paper's tree, until there are 600
// parts or all are convex. A part has a volume, the area of its boundary facets, and a hull.
//
// Surface edges. Each lies between two boundary facets and has a length and a bend: the sine of half the angle
// between their normals, negative where the surface is concave. The curvature of a vertex is the quotient of two
// sums: length x bend / 2 over its edges, and a third of the area over its facets. Smoothing: four times,
// simultaneously at all vertices, each adds to both sums those of its neighbors. The quotient times the square root
// of the model's area is the curvature h; after 24 passes instead of four it is the wide curvature w.
//
// Borders. Two parts with common facets form a pair. Its border has the area of these facets (interface) and sums
// over the surface edges between the parts: of length; of length x bend (crease); of length x |bend| (sharpness); of
// the length of edges with a bend below -0.02 (concave length), above 0.2 (ridge) and below -0.2 (valley); of length
// x h / (4 + |h|) with the mean h of the edge's ends (curvature), and likewise with w (wide curvature). The border of
// a part is the sum over its pairs. Merging adds up what two parts have, and also their borders with a common third
// part; the border of the result is that of the pairs that remain.
//
// Order. The cheapest pair merges first; costs are in single precision, in a tie the lowest pair id wins. Hulls take
// time. So a pair that is new or has grown gets a lower bound as its cost: that for the largest known lower bound of
// the hull volume (the sum of both hulls, or a hull of subsets of both), but at least its previous cost. When such a
// pair comes first, its hull is built and the pair queued again at its exact cost. When two pairs become one, it
// keeps the larger hull volume, the smaller cost and the id of the one that belonged to the merged pair's first part.
// A pair in which one part has no area precedes all others, at cost -1000000 - interface / area(model). Components
// merge last, as in the paper's tree. A mesh of one tetrahedron is one part with score 1.
//
// Border snapping. Each split is then moved to creases nearby (parts/snap/snap.h). The features of the parts are
// computed again, the parts merge in the same order at the same costs, clamped to [-8, 8], and are scored. Where a
// part has disappeared, the other one takes the place of the merge. Below the parts the paper's clusters are kept as
// far as possible.
//
// Symmetry. If the model is its own mirror image in given planes, the side of a plane whose parts scored better
// before snapping is copied to the other one (parts/mirror/mirror_parts.h). The copies merge in the order of their
// originals, each merge together with its images (parts/mirror/mirror_tree.h). A merge of more than two parts has
// intermediate merges, which have score 0 and are no nodes. The score of a node is the mean over it and its images.
// Finally, borders on the sides that received copies move to where all planes agree; the scores stay those from before.
#pragma once

#include "cluster/cluster.h"
#include "mesh/symmetry.h"
#include "parts/part_tree.h"
#include "parts/regions.h"
#include "parts/merge/feature_names.h"

namespace partwheel {

// The largest number of initial parts (but at least one per component): most borders that people draw run between them.
inline constexpr size_t initial_part_count = 600;

// A multilayer perceptron with one hidden layer of softsigns s(z) = z / (1 + |z|):
//
//     c + sum over h of w[h] s(b[h] + sum over i of u[h][i] features[i])
//
// The cost of a pair is this output; the score of a node is (1 + s(output)) / 2.
class Mlp {
public:
    // weights: b, u, w of each hidden unit, then c.
    Mlp(std::span<const double> weights, size_t feature_count);

    double operator()(std::span<const double> features) const;

private:
    size_t units_;                 // those that weigh 0 included
    double bias_;                  // c
    std::vector<double> weights_;  // b of all hidden units, then u of all for each feature, then w of all
};

struct ScoredTree {
    // First the paper's merges within the parts, then the merges of parts, last the merges of components.
    BinaryTree tree;
    // For each part and each node above: the expected overlap with a part that a person would cut, 0..1; 0 marks an
    // intermediate merge. First the parts in depth-first order, then the merges. 2 parts - 1 values.
    std::vector<double> scores;
};

// What fitting needs. Merge j creates node parts + j.
struct MergeTrace {
    struct Pair {
        int32_t a, b;  // parts of the first tree
        std::array<double, pair_feature_count> features;
    };
    PartTree first;  // the initial parts, ordered by cluster, and their merges by cost
    PartTree last;   // the final one, which is scored
    std::vector<Pair> pairs;
    std::vector<std::array<double, node_feature_count>> nodes;  // of the last tree
};

// tree: the paper's tree of this mesh. planes: its symmetry planes, see mirror_planes(). pair_weights: empty, or
// another pair network to try. trace: null, or filled. regions: null, or those that the tree was clustered in.
ScoredTree merge_parts(const TetMesh& mesh, const BinaryTree& tree, std::span<const Plane> planes, Progress& progress,
                       std::span<const double> pair_weights = {}, MergeTrace* trace = nullptr,
                       const Regions* regions = nullptr);

}  // namespace partwheel
