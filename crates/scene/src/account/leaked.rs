//! The leakage through a gap, with the keys of its report and the sentences for people.

use asperity::Result;
use asperity_flow::{Axis, Bounds, Constriction, Flow, Gap, Leak};
use serde::{Deserialize, Serialize};

use crate::key::{Boundary, LENGTH, LeakAsked, Skin, TRANSMISSIVITY, Units, VISCOSITY, record, times_ten_to, worded};
use crate::numbers::{percent, plain, scale};

record! {
    /// The leakage through a gap, as its report has it.
    #[derive(Clone, Debug, Serialize, Deserialize)]
    Leaked of (asked: &LeakAsked, leak: &Leak, grid_errors: [Option<f64>; 2]) {
        /// What is beyond the map.
        boundary: Boundary = asked.boundary,
        /// Whether open nodes connect the sides.
        percolates: Along<bool> = Along::from_axes(|axis| leak.percolation.along(axis).is_some()),
        /// The widest passages.
        constriction: Along<Option<Narrowest>> = Along::from_axes(|axis| leak.percolation.along(axis).map(Narrowest::record)),
        /// Qη/Δp, a length³.
        transmissivity: Along<Transmissivity> = Along::from_axes(|axis| Transmissivity::record(leak.along(axis), grid_errors[axis as usize])),
        /// Q/Δp, if the viscosity is known.
        flow_per_pressure: Along<Option<Enclosed>> = Along::from_axes(|axis| Some(Enclosed::record(leak.along(axis).transmissivity, asked.viscosity?))),
        /// The viscosity η, a pressure times a time.
        viscosity: Option<f64> = asked.viscosity,
        /// The gap of absent nodes, if they are open.
        absent_gap: Option<f64> = asked.absent_gap,
        /// The relative distance of the bounds that was asked for.
        tolerance: f64 = asked.settings.tolerance,
        /// Whether all bounds are as close.
        reached: bool = leak.reached(),
    }
}

/// What there is along x and along y.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Along<T> {
    /// Along x.
    pub x: T,
    /// Along y.
    pub y: T,
}

impl<T> Along<T> {
    pub(crate) fn from_axes(make: impl Fn(Axis) -> T) -> Self {
        Self { x: make(Axis::X), y: make(Axis::Y) }
    }

    /// That along an axis.
    pub fn along(&self, axis: Axis) -> &T {
        match axis {
            Axis::X => &self.x,
            Axis::Y => &self.y,
        }
    }
}

record! {
    /// The narrowest place of the widest passage along an axis.
    #[derive(Clone, Copy, Debug, Serialize, Deserialize)]
    Narrowest of (found: &Constriction) {
        /// Gap there.
        gap: f64 [LENGTH] = found.gap,
        /// Node there.
        node: (usize, usize) = found.node,
        /// Nodes on the passage.
        path_nodes: usize = found.path.len(),
    }
}

impl Narrowest {
    /// Where the passage along an axis is narrowest, in words.
    pub(crate) fn in_words(found: Option<&Self>, units: &Units) -> String {
        found.map_or("closed".to_owned(), |Self { gap, node: (i, j), .. }| {
            format!("open, the gap is {} at the constriction, node [{i}, {j}]", units.number(*gap, LENGTH))
        })
    }
}

record! {
    /// A flow per pressure between two bounds, from the bounds of the transmissivity.
    #[derive(Clone, Copy, Debug, Serialize, Deserialize)]
    Enclosed of (bounds: Bounds, viscosity: f64) {
        /// The lower bound.
        lower: f64 = bounds.lower / viscosity,
        /// The upper bound.
        upper: f64 = bounds.upper / viscosity,
    }
}

record! {
    /// A transmissivity, and how it was found.
    #[derive(Clone, Copy, Debug, Serialize, Deserialize)]
    Transmissivity of (flow: &Flow, error: Option<f64>) {
        /// Lower bound.
        lower: f64 [TRANSMISSIVITY] = flow.transmissivity.lower,
        /// Upper bound.
        upper: f64 [TRANSMISSIVITY] = flow.transmissivity.upper,
        /// Estimated relative error of the grid, from grids of half the resolution; of `leak` alone.
        grid_error: Option<f64> as Error = error,
        /// Whether the bounds are as close as the tolerance.
        reached: bool = flow.reached,
        /// Iterations of conjugate gradients.
        iterations: usize = flow.iterations,
        /// Nodes through which the fluid may flow.
        nodes: usize = flow.nodes,
    }
}

impl Along<Transmissivity> {
    /// Whether all bounds are as close as the tolerance.
    pub fn reached(&self) -> bool {
        self.x.reached && self.y.reached
    }

    /// How far the bounds are apart, if that is further than the tolerance, in words.
    pub(crate) fn apart(&self) -> Option<String> {
        let width = |Transmissivity { lower, upper, .. }| if upper > 0.0 { (upper - lower) / upper } else { 0.0 };
        let widest = percent(f64::max(width(self.x), width(self.y)));
        (!self.reached()).then(|| format!("the bounds of the transmissivity hold, but are {widest} % apart"))
    }
}

impl Transmissivity {
    /// The bounds in words.
    pub(crate) fn in_words(&self, units: &Units) -> String {
        between(self.lower, self.upper, units.unit(TRANSMISSIVITY), units)
    }
}

impl LeakAsked {
    /// The leakage through a gap, with the flow, and as its report has it.
    ///
    /// # Errors
    /// As [`Gap::absent`] and [`Leakage::through`](asperity_flow::Leakage::through).
    pub fn find(&self, gap: Gap<'_>) -> Result<(Leak, Leaked)> {
        self.find_while(gap, &|| true)
    }

    /// The same, by [`Leakage::through_while`](asperity_flow::Leakage::through_while).
    ///
    /// # Errors
    /// As [`Gap::absent`] and [`Leakage::through`](asperity_flow::Leakage::through).
    pub fn find_while(&self, gap: Gap<'_>, goes_on: &(dyn Fn() -> bool + Sync)) -> Result<(Leak, Leaked)> {
        let Self { boundary, absent_gap, settings, grid_error, .. } = *self;
        let gap = if boundary == Boundary::Free { gap.free() } else { gap };
        let gap = gap.absent(absent_gap.unwrap_or(0.0))?;
        let leak = settings.through_while(&gap, goes_on)?;
        let grid_errors =
            if grid_error && goes_on() { settings.grid_error_while(&gap, &leak, goes_on)? } else { [None; 2] };
        let leaked = Leaked::record(self, &leak, grid_errors);
        Ok((leak, leaked))
    }
}

impl Leaked {
    /// The shortfall of bounds that are further apart than the tolerance, with a remedy, in the words of a skin.
    pub fn shortfall(&self, skin: Skin) -> Option<String> {
        let (apart, wanted) = (self.transmissivity.apart()?, percent(self.tolerance));
        Some(worded(&format!("{apart}, not {wanted} %: raise {{max_iterations}} or {{tolerance}}"), skin))
    }

    /// The rows of its summary.
    pub fn rows(&self, units: &Units) -> Vec<(String, String)> {
        let mut rows = Vec::new();
        for axis in Axis::BOTH {
            let constriction = Narrowest::in_words(self.constriction.along(axis).as_ref(), units);
            rows.push((format!("along {}", axis.name()), constriction));
            let transmissivity = self.transmissivity.along(axis);
            rows.push(("  transmissivity".to_owned(), transmissivity.in_words(units)));
            if let Some(error) = transmissivity.grid_error {
                rows.push(("  error of the grid".to_owned(), format!("{} %", percent(error))));
            }
            if let Some(Enclosed { lower, upper }) = *self.flow_per_pressure.along(axis) {
                let viscous = units.unit(VISCOSITY).zip(units.length.as_ref());
                let volume = viscous.map(|(viscosity, length)| format!("{length}³/({viscosity})"));
                rows.push(("  flow per pressure".to_owned(), between(lower, upper, volume, units)));
            }
        }
        rows
    }
}

/// Two bounds in words, with their unit as far as it is known.
fn between(lower: f64, upper: f64, unit: Option<String>, units: &Units) -> String {
    if upper <= 0.0 {
        return "0".to_owned();
    }
    let is_si = units.length.as_deref() == Some(LENGTH.si);
    let scaled = unit.as_ref().filter(|_| is_si).and_then(|unit| scale(upper, unit));
    let (power, unit) = scaled.unwrap_or_else(|| (0, unit.unwrap_or_default()));
    // rounded outwards, so that the bounds hold as they are printed
    let number = |bound, round: fn(f64) -> f64| plain(times_ten_to(-power, outwards(bound, round)));
    format!("{} to {} {unit}", number(lower, f64::floor), number(upper, f64::ceil)).trim_end().to_owned()
}

/// A number to seven digits, rounded by a function to whole numbers.
fn outwards(value: f64, round: fn(f64) -> f64) -> f64 {
    if value <= 0.0 {
        return 0.0;
    }
    let power = value.log10().floor() as i32 - 6;
    times_ten_to(power, round(times_ten_to(-power, value)))
}
