// The top of the tree built anew by two small neural networks: a few hundred parts of the paper's tree, joined in the
// order that people would, with borders in creases. choose.cpp says which parts, measure.cpp measures them, decide.cpp
// has the networks, join.cpp joins.
//
// Concavity alone joins a leg's two halves late and a cup's handle early. So the paper's tree is cut into some parts,
// which are joined again bottom-up; the cost is how unlikely it is that people put both into one part, told by a small
// neural network (one hidden layer of softsigns, see fitted()) from 32 measures of the pair: sizes, convexity, the hull
// of both, the area of the facets between them (the cross-section) and the length and the crease of the border on the
// surface, after the ideas of Golovinskiy and Funkhouser, "Randomized Cuts for 3D Mesh Analysis" (2008). Another such
// network scores each node of the result from 48 measures. feature_names.h names the measures and says what each is. Both
// networks were fitted to segmentations made by people (tests/quality/fit.py); their weights are in fitted.h. All of it
// is arithmetic without library functions but the square root, so it is the same on every machine.
// tests/core/reference_merge_policy.py does the same from what is said here and there:
//
// The unit of length is the longest side of the bounding box.
//
// Parts. Beginning with the components, the cluster with the largest area x concavity / hull volume (in single
// precision; where they tie the one of the lowest number) is replaced by its two halves in the paper's tree, until
// there are 600 parts or all are convex. A part has a volume, the area of its outer triangles, and a hull.
//
// Folds are the edges of the surface, each between two outer triangles. A fold has a length and a bend: the sine of
// half the angle between the two normals, below 0 where the surface is concave. The curvature of a vertex is a quotient
// of two sums: over its folds of length x bend / 2, and over its outer triangles of a third of their area. Four times,
// all vertices at once, each adds to both of its sums those of the vertices at the other ends of its folds. The
// quotient times the square root of the whole area is the curvature h; after 24 times instead of four the wide one, w.
//
// Two parts with common facets are a pair. Its border has an interface, the area of those facets; and as sums over the
// folds between the two: a length, that of the folds; a crease, of length x bend; a sharpness, the same without a sign;
// a concave length, of the folds whose bend is below -0.02, a ridge, above 0.2, and a valley, below -0.2; a curvature, of
// length x h / (4 + |h|) with the mean h of the fold's ends, and a wide curvature, likewise of w. A part's rim is the sum
// of its borders. What parts have is added up when they are joined, and where both have a border with a third part, these
// two borders are; the rim is what is left.
//
// Order. The pair that costs least is joined first; costs are in single precision, and the pair of the lowest number
// goes first where they tie. Hulls take time, so a pair, new or grown, is entered by a guess: what it would cost if the
// hull of both were no larger than it is known to be (the sum of their hulls, or a hull of parts of both that was made
// before), but no less than before. When a guess comes first the hull is made, and the pair entered again by what it
// does cost. Of two pairs that become one, the larger known hull, the lesser cost and the number of the one that the
// pair's first part had stay. A pair of which one has no area goes before all others, at -1000000 - interface / area of
// all.
// Components are joined at last, as in the paper's tree. A mesh of one tetrahedron is one part, of score 1.
//
// Borders. Then each split is moved into the creases nearby (parts/snap/snap.h). The parts are measured again as they
// are now, joined in the same order at the same costs, within -8 and 8, and scored; where one of two is gone, what both
// became is the other. Below them the paper's clusters keep what they have.
//
// Planes. Where the model is its own mirror image in given planes, the parts of the sides that scored better before
// their borders were moved are then copied (parts/mirror/mirror_parts.h), and the copies joined in the order in which what
// they stand for was, each join with its images at once (parts/mirror/mirror_tree.h). What joins more than two at once has
// steps, which are merges of score 0 and no nodes. A node's score is the mean of it and its images'.
#pragma once

#include "cluster/cluster.h"
#include "mesh/symmetry.h"
#include "parts/part_tree.h"
#include "parts/merge/feature_names.h"

#include <array>
#include <span>
#include <vector>

namespace partwheel {

// So many parts at most, but at least one a component: enough that most borders people draw run between them.
inline constexpr size_t initial_part_count = 600;

// The network: a sum of bounded ramps (softsigns). numbers: for each ramp z / (1 + |z|) a bias and the weights of the
// inputs, which give z, and the ramp's own weight; at the end the sum's bias. A pair's cost is that, how unlikely as a
// logit; a node's score is (1 + z / (1 + |z|)) / 2 of its sum z.
double mlp_forward(std::span<const double> numbers, std::span<const double> inputs);

struct ScoredTree {
    // Its first merges are the paper's, below the parts; the last ones join the parts, and at the very end components,
    // as the paper's do.
    BinaryTree tree;
    // How well each node at or above the parts is expected to match what people would take, 0..1 (the mean overlap,
    // intersection over union; 0: no node, but a step to what is joined from more than two): first the parts in
    // depth-first order, then the merges that join them. 2 parts - 1.
    std::vector<double> scores;
};

// What fitting needs to see. What join j makes is number parts + j.
struct MergeTrace {
    struct Pair {
        int32_t a, b;  // numbers of the parts at first
        std::array<double, pair_feature_count> measures;
    };
    PartTree first;  // parts of the paper's tree, numbered as their clusters are, joined by cost
    PartTree last;   // those that are scored
    std::vector<Pair> pairs;
    std::vector<std::array<double, node_feature_count>> nodes;  // of the last
};

// tree: the paper's of this mesh; planes: in which it is its own mirror image, see mirror_planes(). pair_numbers: none,
// or another cost to be tried; trace: null, or what to fill.
ScoredTree merge_parts(const TetMesh& mesh, const BinaryTree& tree, std::span<const Plane> planes, Progress& progress,
                  std::span<const double> pair_numbers = {}, MergeTrace* trace = nullptr);

}  // namespace partwheel
