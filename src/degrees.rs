//! Degrees: how little is hardly any, how near is near enough, and how much is far, where the order alone counts.

/// A share that is hardly any: of the pressure that presses the surface flat, of a tension that is held without contact,
/// of the largest traction at the edge of a window, of a work that rounding may take, of the softest stiffness.
pub(crate) const HARDLY: f64 = 1e-3;

/// A share that is little: the least that counts of a curvature, of a step or of a stiffness, the error of a first state,
/// and what a law, a contact or an eigenvalue may be wrong by.
pub(crate) const LITTLE: f64 = 1e-2;

/// A share that is a part, and not the whole: of the range of adhesion in a small change of the gap, of an error that the
/// next state may leave, of the change that a mode makes up.
pub(crate) const PARTLY: f64 = 0.1;

/// A distance that is far: in ranges of adhesion, in steps, in stiffnesses of the shortest wave.
pub(crate) const FAR: f64 = 10.0;

/// The tolerance of a state that tells where to go on: how much tension it holds, where else surfaces touch, how far its
/// contact is from a wanted one.
pub(crate) const ROUGHLY: f64 = 1e-3;

/// The tolerance of a state that leads to another one: the edge of the adhesive zone has to be right to a node.
pub(crate) const CLOSELY: f64 = 1e-4;

/// The roundings of a sum of products, of a difference of sums, and of a value that is compared, in units of ε.
pub(crate) const ROUNDINGS: f64 = 8.0;
