//! Degrees: how little is hardly any, how near is near enough, and how much is far, where the order alone counts.

/// A share that is hardly any: of the pressure that presses the surface flat, of a tension that is held without contact,
/// of the largest traction at the edge of a window, of a work that rounding may take, of the softest stiffness, of a
/// tolerance that rounding may exceed.
pub(crate) const HARDLY: f64 = 1e-3;

/// A share that is little: the least that counts of a curvature, of a step or of a stiffness, the error of a first state,
/// and what a law, a contact or an eigenvalue may be wrong by.
pub(crate) const LITTLE: f64 = 1e-2;

/// A share that is a part, and not the whole: of the range of adhesion in a small change of the gap, of an error that the
/// next state may leave, of the change that a mode makes up.
pub(crate) const PARTLY: f64 = 0.1;

/// A share that is about a half: of the nodes of a grid, of a gap that a step may take, of a load that is not borne, of a
/// step by which the next step may be longer, of the change before in the error of a prediction, of a tolerance, of the
/// work that a law has left at its strongest traction.
pub(crate) const HALF: f64 = 0.5;

/// A share that is most, and not all: of a jump that half a step has, of a step that the next one takes along.
pub(crate) const MOSTLY: f64 = 0.7;

/// A factor that leaves room: over the floor of rounding, a tolerance, the rise of concave functions, the last step, a
/// step to a peak that was too low.
pub(crate) const TWICE: f64 = 2.0;

/// A first step into the unknown, as a share of the way that is known.
pub(crate) const FIRST_STEP: f64 = 0.0625;

/// A distance that is far: in ranges of adhesion, in steps, in stiffnesses of the shortest wave, in the rounding of updates.
pub(crate) const FAR: f64 = 10.0;

/// The tolerance of a state that tells where to go on: how much tension it holds, where else surfaces touch, how far its
/// contact is from a wanted one.
pub(crate) const ROUGHLY: f64 = 1e-3;

/// The tolerance of a state that leads to another one: the edge of the adhesive zone has to be right to a node.
pub(crate) const CLOSELY: f64 = 1e-4;

/// The relative difference, far above rounding and far below anything measured, of numbers that are the same.
pub(crate) const ALIKE: f64 = 1e-9;

/// The roundings of a sum of products, of a difference of sums, and of a value that is compared, in units of ε.
pub(crate) const ROUNDINGS: f64 = 8.0;
