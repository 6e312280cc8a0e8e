//! The warnings about the load: a large share of it stands on single scan lines, on single nodes, or above a hardness.

use asperity::{Real, Solution};

use super::part::Part::{Figure, Pressure, Word};
use super::{Warning, WarningCode};

/// How many times harder a node presses than both nodes next to it, along an axis, to stand alone: pressures change
/// little from node to node in a contact that the nodes resolve, but for its edge, where one side is harder.
const ALONE: f64 = 3.0;
/// The least number of nodes of a piece of a line with all nodes alone across it: contacts of a rough surface are
/// rounder.
const LENGTH: usize = 8;
/// The shares of the load that are much, on lines and on single nodes: where a contact of some hundred nodes has a few
/// to each of its pieces, a quarter may stand on single ones.
const MUCH: [f64; 2] = [0.2, 1.0 / 3.0];
/// Fewer nodes in contact tell nothing: they may be alone by chance.
const LEAST_NODES: usize = 100;

/// The pressure over the contact modulus E* that few solids bear, and the share of the load above it that is most.
const BORNE: f64 = 0.1;
const MOST: f64 = 0.5;

/// Nodes that stand alone: their number and their load.
#[derive(Clone, Copy, Default)]
struct Nodes {
    count: usize,
    load: f64,
}

impl Nodes {
    fn add(&mut self, other: Self) {
        self.count += other.count;
        self.load += other.load;
    }

    /// Continues a line with a node that is alone across it, or ends it, and counts it if it was long.
    fn go_on(&mut self, node: Option<Self>, counted: &mut Self) {
        match node {
            Some(node) => self.add(node),
            None if self.count > 0 => {
                if self.count >= LENGTH {
                    counted.add(*self);
                }
                *self = Self::default();
            }
            None => {}
        }
    }
}

/// The warning that much of the load stands on lines along one axis, or on single nodes, by one pass over the pressure.
/// From the heights scars may have been removed beyond a threshold.
pub(super) fn of_load<T: Real>(solution: &Solution<T>, scars_removed: Option<f64>) -> Option<Warning> {
    let pressures = &solution.contact_pressure;
    let (nx, ny) = pressures.dim();
    let [mut all, mut along_x, mut along_y, mut single] = [Nodes::default(); 4];
    let mut lines_along_x = vec![Nodes::default(); ny];
    for i in 0..nx {
        let mut line_along_y = Nodes::default();
        for (j, line_along_x) in lines_along_x.iter_mut().enumerate() {
            let pressure = pressures[[i, j]].widen();
            // no line of nodes under load ends here
            if pressure <= 0.0 && line_along_x.count + line_along_y.count == 0 {
                continue;
            }
            let node = Nodes { count: 1, load: pressure };
            let alone = |before: [usize; 2], after: [usize; 2]| {
                let beside = pressures[before].widen().max(pressures[after].widen());
                (pressure > ALONE * beside).then_some(node)
            };
            let (mut on_line_along_x, mut on_line_along_y) = (None, None);
            if pressure > 0.0 {
                on_line_along_x = alone([i, (j + ny - 1) % ny], [i, (j + 1) % ny]);
                on_line_along_y = alone([(i + nx - 1) % nx, j], [(i + 1) % nx, j]);
                all.add(node);
                on_line_along_x.and(on_line_along_y).into_iter().for_each(|node| single.add(node));
            }
            line_along_x.go_on(on_line_along_x, &mut along_x);
            line_along_y.go_on(on_line_along_y, &mut along_y);
        }
        line_along_y.go_on(None, &mut along_y);
    }
    lines_along_x.iter_mut().for_each(|line| line.go_on(None, &mut along_x));
    let kinds = [(along_x, Some("x")), (along_y, Some("y")), (single, None)];
    let much = |(nodes, axis): &(Nodes, Option<_>)| {
        all.count >= LEAST_NODES && nodes.load > MUCH[usize::from(axis.is_none())] * all.load
    };
    let (nodes, axis) = kinds.into_iter().filter(much).max_by(|a, b| a.0.load.total_cmp(&b.0.load))?;
    let (share, percent) = (nodes.load / all.load, Figure(100.0 * nodes.load / all.load));
    Some(match axis.map(str::to_owned) {
        Some(axis) => Warning::new(
            WarningCode::Scars,
            share,
            "{} % of the load is on lines along {}: {}",
            [percent, Word(axis.clone()), Word(remedy(&axis, scars_removed))],
        ),
        None => Warning::new(
            WarningCode::Noise,
            share,
            "{} % of the load is on single nodes: use despike, or cut off short waves",
            [percent],
        ),
    })
}

/// The remedy for scars along an axis, where some may have been removed beyond a threshold.
fn remedy(axis: &str, scars_removed: Option<f64>) -> String {
    match scars_removed {
        None => format!("prepare --remove-scars --scan-axis {axis}"),
        Some(threshold) => format!("use --remove-scars below {threshold}"),
    }
}

/// The bytes of a GiB.
const GIB: f64 = 1_073_741_824.0;

impl Warning {
    /// So few `nodes` of a contact bear the pull-off, where a grid of `needed` nodes, which takes these `bytes`, tells it:
    /// [`FewNodes`](WarningCode::FewNodes).
    pub fn of_few_nodes(nodes: f64, (nx, ny): (usize, usize), bytes: f64, memory: f64) -> Self {
        let size = if bytes < 0.1 * GIB { String::new() } else { format!(", {:.1} GiB", bytes / GIB) };
        let few = if nodes < 1.5 { "one node or less".to_owned() } else { format!("{nodes:.0} nodes") };
        let remedy = if bytes <= memory { "refine to" } else { "too large for this memory are" };
        Self::new(
            WarningCode::FewNodes,
            nodes.recip(),
            "{} of a contact bear the pull-off, which is too few: {} {} x {} nodes{}",
            [few, remedy.to_owned(), nx.to_string(), ny.to_string(), size].map(Word),
        )
    }

    /// An elastic solution with most of its load above a tenth of the contact modulus E*,
    /// [`Hardness`](WarningCode::Hardness): most solids yield there. On a steep surface only a hardness makes the
    /// contact real.
    ///
    /// ```
    /// use asperity_maps::warning::Warning;
    /// use asperity::{Control, Grid, Hardness, NoAdhesion, Problem, Settings, Solver, Surface, Westergaard};
    /// let grid = Grid::square(32, 1.0)?;
    /// let steep = Surface::wave_2d(grid, 0.2, 2)?;
    /// let mut problem = Problem::new(&steep, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
    /// let control = Control::MeanPressure(0.05);
    /// assert!(Warning::of_hardness(&Solver::default().solve(&mut problem, control)?).is_some());
    /// let mut soft = Solver { settings: Settings::default(), constraint: Hardness::new(0.3)? };
    /// assert!(Warning::of_hardness(&soft.solve(&mut problem, control)?).is_none());
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn of_hardness<T: Real>(solution: &Solution<T>) -> Option<Self> {
        let modulus = solution.report.modulus;
        let pressures = || solution.contact_pressure.iter().map(|pressure| pressure.widen());
        let (all, above) = pressures().fold((0.0, 0.0), |(all, above), pressure| {
            (all + pressure, if pressure > BORNE * modulus { above + pressure } else { above })
        });
        if solution.report.plastic.is_some() || modulus <= 0.0 || above.is_nan() || above <= MOST * all {
            return None;
        }
        let text = "{} % of the load is above E*/10, {}: give the hardness of the softer body";
        let parts = [Figure(100.0 * above / all), Pressure(BORNE * modulus)];
        Some(Self::new(WarningCode::Hardness, above / all, text, parts))
    }
}
