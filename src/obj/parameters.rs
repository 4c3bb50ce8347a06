//! Parameters of a free-form surface along u or v: knots of a B-spline, or where the pieces of a Bézier surface meet.

/// The most that patches can have.
pub(super) const MAX_DEGREE: usize = 3;

/// Number of control points along a direction, or `None` if there are too few parameters for any.
pub(super) fn point_count(is_bezier: bool, degree: usize, parameters: usize) -> Option<usize> {
    if is_bezier {
        let pieces = parameters.checked_sub(1).filter(|&pieces| pieces > 0)?;
        return pieces.checked_mul(degree)?.checked_add(1);
    }
    parameters.checked_sub(degree + 1).filter(|&points| points > degree)
}

/// The place of the first parameter that is smaller than the one before; pieces of a Bézier surface must not be empty
/// either.
pub(super) fn first_descent(is_bezier: bool, parameters: &[f64]) -> Option<usize> {
    let ascends = |pair: &[f64]| pair[0] < pair[1] || (!is_bezier && pair[0] == pair[1]);
    parameters.windows(2).position(|pair| !ascends(pair)).map(|before| before + 1)
}

/// The knots with which a B-spline is this piecewise Bézier curve: each parameter as often as the degree says, and the
/// first and the last once more.
pub(super) fn knots_of_pieces(degree: usize, parameters: &[f64]) -> Vec<f64> {
    let inner = parameters.iter().flat_map(|&parameter| std::iter::repeat_n(parameter, degree));
    parameters.first().copied().into_iter().chain(inner).chain(parameters.last().copied()).collect()
}
