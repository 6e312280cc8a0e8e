//! What is told of the load: that much of it stands on single scan lines, or on single nodes.

use asperity::{Real, Solution};

use super::text::Text;
use super::{Warning, WarningCode};

/// How many times harder a node presses than both nodes beside it, along an axis, to stand alone: pressures change
/// little from node to node in a contact that the nodes resolve, but for its edge, where one side is harder.
const ALONE: f64 = 3.0;
/// The share of the load from which it is much: on rough surfaces with four nodes to the shortest wave, at one per cent
/// of contact, some 3 % stand on single nodes.
const MUCH: f64 = 0.2;
/// Fewer nodes in contact tell nothing: they may be alone by chance.
const LEAST_NODES: usize = 100;

/// The warning that much of the load stands on lines along one axis, or on single nodes, by one pass over the pressure.
pub(super) fn of_load<T: Real>(solution: &Solution<T>) -> Option<Warning> {
    let pressures = &solution.contact_pressure;
    let ((nx, ny), mut nodes) = (pressures.dim(), 0);
    // alone along y but not along x, along x but not along y, and along both: the load, and the greatest pressure
    let (mut all, mut found) = (0.0, [(0.0, 0.0_f64); 3]);
    for ((i, j), pressure) in pressures.indexed_iter().filter(|(_, pressure)| **pressure > T::zero()) {
        let pressure = pressure.widen();
        let alone = |before: [usize; 2], after: [usize; 2]| {
            pressure > ALONE * pressures[before].widen().max(pressures[after].widen())
        };
        let along_x = alone([(i + nx - 1) % nx, j], [(i + 1) % nx, j]);
        let along_y = alone([i, (j + ny - 1) % ny], [i, (j + 1) % ny]);
        (all, nodes) = (all + pressure, nodes + 1);
        let class = match (along_x, along_y) {
            (false, false) => continue,
            (false, true) => 0,
            (true, false) => 1,
            (true, true) => 2,
        };
        found[class] = (found[class].0 + pressure, found[class].1.max(pressure));
    }
    let much = |(load, _): (f64, f64)| nodes >= LEAST_NODES && load > MUCH * all;
    let class = (0..3).filter(|&class| much(found[class])).max_by(|&a, &b| found[a].0.total_cmp(&found[b].0))?;
    let (share, mut text) = (found[class].0 / all, Text::default());
    let percent = Warning::figure(100.0 * share);
    let greatest = text.pressure(found[class].1);
    let press = format!("that press more than {ALONE} times as hard as");
    let (code, message) = match class {
        2 => (
            WarningCode::Noise,
            format!(
                "{percent} % of the load stands on single nodes, {press} all beside them, with up to {greatest}: noise of a \
                 measurement, or waves that the nodes do not resolve; leave out short waves (prepare \
                 --cut-off-wavelength), give spikes the median around them (despike), or refine the map"
            ),
        ),
        _ => {
            let axis = ["x", "y"][class];
            (
                WarningCode::Scars,
                format!(
                    "{percent} % of the load stands on single lines along {axis}, on nodes {press} those of both lines \
                     beside them, with up to {greatest}: scars, if {axis} is the scan axis of a measurement; remove them \
                     (prepare --remove-scars --scan-axis {axis})"
                ),
            )
        }
    };
    Some(Warning { code, text: text.with(message).of_severity(share) })
}
