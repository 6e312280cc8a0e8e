//! The Pareto front: what nothing else beats in both error and cost.

/// Which of the points (cost, error) no other one beats; those without a finite error never are.
pub fn front(points: &[(f64, f64)]) -> Vec<bool> {
    let beats = |a: &(f64, f64), b: &(f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
    points.iter().map(|point| point.1.is_finite() && !points.iter().any(|other| beats(other, point))).collect()
}
