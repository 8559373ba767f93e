//! The entries of the manifolds of saddles: of the curves on which basins meet, and of the unstable manifolds.

use super::entry::{Entry, Extent::*, Type::*, entries};
use super::flags::{branch_ends, curve_ends};

entries! {
    STABLE_CURVE "stable_curve" "1" Dimension, Whole, None,
        "curve on which two basins meet in the plane of the starts";
    STABLE_EDGE "stable_edge" "1" Table(STABLE_CURVE.name), Whole, None,
        "saddle whose stable manifold the curve is, by its place along edge_index; -1 where it was followed by where starts lead alone";
    STABLE_LEFT "stable_attractor_left" "1" Table(STABLE_CURVE.name), Whole, None,
        "attractor on the left of the curve, the first axis to the right and the second upward";
    STABLE_RIGHT "stable_attractor_right" "1" Table(STABLE_CURVE.name), Whole, None,
        "attractor on its right";
    STABLE_BEGIN "stable_begin" "1" Table(STABLE_CURVE.name), Category(curve_ends), None,
        "why the curve ends at its first point";
    STABLE_END "stable_end" "1" Table(STABLE_CURVE.name), Category(curve_ends), None,
        "why it ends at its last point";
    STABLE_LENGTH "stable_length" "1" Table(STABLE_CURVE.name), Real, None,
        "length of the curve, the sides of the plane being one";
    STABLE_ERROR "stable_error" "1" Table(STABLE_CURVE.name), Real, None,
        "largest estimate of how far a point by derivatives is from the manifold, the sides of the plane being one";

    STABLE_POINT "stable_point" "1" Dimension, Whole, None,
        "point of the curves, one curve after the other";
    STABLE_POINT_CURVE "stable_point_curve" "1" Table(STABLE_POINT.name), Whole, None,
        "curve that the point is on";
    STABLE_POINT_DIVIDED "stable_point_divided" "1" Table(STABLE_POINT.name), Whole, None,
        "1 where the point was found by division between starts that lead to the two attractors, 0 where by derivatives";

    UNSTABLE_BRANCH "unstable_branch" "1" Dimension, Whole, None,
        "half of the unstable manifold of a section point of a saddle";
    UNSTABLE_EDGE "unstable_edge" "1" Table(UNSTABLE_BRANCH.name), Whole, None,
        "saddle of the half, by its place along edge_index";
    UNSTABLE_CYCLE "unstable_cycle" "1" Table(UNSTABLE_BRANCH.name), Whole, None,
        "cycle of the period of the saddle that it goes from";
    UNSTABLE_ATTRACTOR "unstable_attractor" "1" Table(UNSTABLE_BRANCH.name), Whole, None,
        "attractor to which motions lead that begin on it";
    UNSTABLE_END "unstable_end" "1" Table(UNSTABLE_BRANCH.name), Category(branch_ends), None,
        "why it ends";
    UNSTABLE_TEARS "unstable_tears" "1" Table(UNSTABLE_BRANCH.name), Whole, None,
        "places where the return map tears it apart";

    UNSTABLE_POINT "unstable_point" "1" Dimension, Whole, None,
        "point of the unstable manifolds, one half after the other, each from the saddle on";
    UNSTABLE_POINT_BRANCH "unstable_point_branch" "1" Table(UNSTABLE_POINT.name), Whole, None,
        "half that the point is on";

    BOUNDARY_CROSSINGS "boundary_crossings" "1" Once, Whole, None,
        "pairs of neighbouring starts that lead to two attractors";
    BOUNDARY_UNCOVERED "boundary_uncovered" "1" Once, Whole, None,
        "those of them that no curve passes within the distance of two neighbouring starts";
    BOUNDARY_SEEDS "boundary_seeds" "1" Once, Whole, None,
        "those of them from which a curve was sought";
    BOUNDARY_FAILED "boundary_failed" "1" Once, Whole, None,
        "those of these that gave none";
    BOUNDARY_STOPPED "boundary_stopped" "1" Once, Whole, None,
        "1 where the search stopped before all were covered, as there are as many curves, points, cycles or failures as are allowed";
}
