//! Warnings about a surface or a solution that periodicity or the grid makes doubtful.

use std::fmt;

use crate::numbers::rounded;
use crate::topography::Topography;
use asperity::contact::Original;
use asperity::{Grid, Real, Result, Solution, Surface};

mod body;
mod code;
mod extremes;
mod heights;
mod layout;
mod lines;
mod load;
mod part;
mod range;
mod relief;
mod spikes;

pub use code::WarningCode;
use extremes::Extremes;
use heights::{cells, ends_at_edges, ends_within, missing_code, open_edges, slope, spikes, tilt};
use part::Part::{self, Figure, Length, Pressure, Word};
use relief::Relief;

/// The largest number of names in a message.
const MOST_NAMES: usize = 10;

/// The rms slope from which a surface is steep: linear elasticity of a half-space is for small slopes, and real
/// surfaces have up to about this. Heights in another unit than the lengths are beyond it by orders of magnitude.
const STEEP: f64 = 0.5;

/// The same for a measured map: offsets between scan lines, and spikes, make slopes of several tens.
const STEEP_MAP: f64 = 100.0;

/// The range of heights, as a share of the greatest magnitude, up to which a surface is flat: a few roundings of `f64`.
const FLAT: f64 = 4.0 * f64::EPSILON;

/// The difference of contact between an original and the whole with its mirror images, as a share, from which the
/// solution has lost the symmetry: more than nodes at the edge of the contact make.
const UNLIKE: f64 = 0.05;

/// A probable mistake in the input, or in an answer: a code, the number that shows it, and a remedy, on a line of at
/// most 90 characters. The page `docs/program/warnings.md` explains each code.
///
/// A warning refuses and changes nothing, and the reader decides whether it matters. Clean periodic surfaces have
/// none. [`of_surface`](Self::of_surface) looks at the heights, [`of_modulus`](Self::of_modulus) at the unit of the
/// contact modulus with them, [`of_law`](Self::of_law) at the adhesion on them, all before a solve,
/// [`of_solution`](Self::of_solution) and [`of_hardness`](Self::of_hardness) at its answer, and
/// [`of_images`](Self::of_images) at the answer on a mirrored map.
///
/// ```
/// use asperity_maps::warning::{Warning, WarningCode};
/// use asperity::{Control, Exponential, Grid, Problem, Solver, Surface, Westergaard};
/// let grid = Grid::square(64, 1.0)?;
/// let tilted = Surface::from_fn(grid, |x, y| 0.01 * (6.0 * x).sin() * (9.0 * y).cos() + 0.05 * x)?;
/// let codes: Vec<_> = Warning::of_surface(&tilted).iter().map(|warning| warning.code).collect();
/// assert_eq!(codes, [WarningCode::Tilt, WarningCode::OpenEdges]);
///
/// let (surface, law) = (Surface::wave_2d(grid, 0.01, 2)?, Exponential::new(1e-5, 2e-3)?);
/// assert!(Warning::of_surface(&surface).is_empty());
/// for warning in Warning::of_law::<f64>(&law, &surface, 1.0) {
///     eprintln!("{warning}"); // code: message
/// }
/// let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, law)?;
/// let solution = Solver::default().solve(&mut problem, Control::MeanPressure(0.01))?;
/// assert!(Warning::of_solution(&solution, None).is_empty());
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Warning {
    /// The code.
    pub code: WarningCode,
    severity: f64,
    /// The message, with `{}` in the place of each part.
    text: &'static str,
    parts: Vec<Part>,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.code, self.message())
    }
}

impl Warning {
    fn new(code: WarningCode, severity: f64, text: &'static str, parts: impl Into<Vec<Part>>) -> Self {
        let parts = parts.into();
        debug_assert_eq!(text.matches("{}").count(), parts.len());
        Self { code, severity, text, parts }
    }

    /// The message: the observation, with its number, and the remedy, on one line. Lengths and pressures are in the
    /// units of the input.
    pub fn message(&self) -> String {
        self.message_with(Self::figure, Self::figure)
    }

    /// The message with lengths and pressures as these functions write them, with units for example. They are rounded to
    /// three digits.
    ///
    /// ```
    /// use asperity_maps::warning::Warning;
    /// use asperity::{Exponential, Grid, Surface};
    /// let surface = Surface::wave_2d(Grid::square(64, 1e-6)?, 1e-9, 2)?;
    /// let found = Warning::of_law::<f64>(&Exponential::new(1e-5, 2e-8)?, &surface, 1e9);
    /// let (nm, gpa) = (|length| format!("{} nm", 1e9 * length), |pressure| format!("{} GPa", 1e-9 * pressure));
    /// let message = found[0].message_with(nm, gpa);
    /// assert!(message.starts_with("the range of adhesion, 20 nm, exceeds the heights, 2 nm"), "{message}");
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn message_with(&self, length: impl Fn(f64) -> String, pressure: impl Fn(f64) -> String) -> String {
        let rounded = |value: f64| format!("{value:.2e}").parse().unwrap_or(value);
        let written = |part: &Part| match part {
            Length(value) => length(rounded(*value)),
            Pressure(value) => pressure(rounded(*value)),
            Figure(value) => Self::figure(*value),
            Word(word) => word.clone(),
        };
        let parts = self.parts.iter().map(written).chain([String::new()]);
        self.text.split("{}").zip(parts).flat_map(|(piece, part)| [piece.to_owned(), part]).collect()
    }

    /// The severity, to choose the worst among warnings of one code: the figure of the message that exceeds its limit,
    /// as far as there is one; otherwise zero.
    ///
    /// ```
    /// use asperity_maps::warning::Warning;
    /// use asperity::{Grid, Surface};
    /// let wave = |slope| Surface::wave(Grid::line(64, 1.0)?, slope / 6.0, 1);
    /// let severity = |surface: &Surface| Warning::of_surface(surface)[0].severity();
    /// assert!(severity(&wave(9.0)?) > severity(&wave(2.0)?));
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn severity(&self) -> f64 {
        self.severity
    }

    /// A number as in messages: with three digits, below 1e-3 and from 1e5 on with an exponent.
    ///
    /// ```
    /// use asperity_maps::warning::Warning;
    /// assert_eq!([2.0, 0.01234, 1.5e-9].map(Warning::figure), ["2", "0.0123", "1.5e-9"]);
    /// ```
    #[doc(hidden)]
    pub fn figure(value: f64) -> String {
        rounded(value, 3, 1e5)
    }

    /// The probable mistakes in the heights: [`Tilt`](WarningCode::Tilt), [`OpenEdges`](WarningCode::OpenEdges),
    /// [`Ends`](WarningCode::Ends), [`Steep`](WarningCode::Steep), [`Smooth`](WarningCode::Smooth),
    /// [`Spikes`](WarningCode::Spikes), [`LineOffsets`](WarningCode::LineOffsets),
    /// [`MissingCode`](WarningCode::MissingCode), [`Cells`](WarningCode::Cells) and [`Flat`](WarningCode::Flat). The
    /// first three are none where the boundary is free.
    ///
    /// Before all, numbers that are no heights: [`Axes`](WarningCode::Axes), and [`ByteOrder`](WarningCode::ByteOrder),
    /// which comes alone.
    ///
    /// Takes a few passes over the heights. Where there are codes for missing points, the warnings that these codes
    /// would cause are left out. Tilt and edges are looked at along sides of 16 nodes and more.
    ///
    /// Where several processes share the grid, each of them takes the whole surface for it, as [`Surface::whole`] gives
    /// it.
    pub fn of_surface(surface: &Surface) -> Vec<Self> {
        let surface = &*surface.whole();
        let extremes = Extremes::find(surface.heights());
        let heights = surface.heights();
        if let Some(warning) = layout::byte_order(heights) {
            return vec![warning];
        }
        let mut found: Vec<_> = cells(surface.grid()).into_iter().chain(ends_within(surface)).collect();
        found.extend(layout::axes(heights));
        if is_flat(&extremes) {
            let text = "all heights are {}: check the file, or the map";
            found.push(Self::new(WarningCode::Flat, 0.0, text, [Length(extremes.low)]));
            return found;
        }
        let codes = extremes.codes();
        if !codes.is_empty() {
            found.extend(codes.into_iter().map(|(value, count)| missing_code(value, count)));
            return found;
        }
        let relief = Relief::measure(surface.heights(), &extremes);
        let at_edges = [open_edges(&relief), ends_at_edges(&relief, surface)];
        let slope = slope(relief.rms_slope(surface.grid().spacing()), STEEP);
        found.extend(tilt(&relief, surface.grid()).into_iter().chain(at_edges.into_iter().flatten()));
        found.extend(slope.into_iter().chain(spikes(&relief)).chain(lines::offsets(&relief.heights, relief.unit)));
        found
    }

    /// The probable mistakes in a measured map that is still to be prepared: [`MissingCode`](WarningCode::MissingCode),
    /// and, where no such code is there, mistakes in a surface: with known side lengths [`Steep`](WarningCode::Steep),
    /// which here is an rms slope above 100, and [`Smooth`](WarningCode::Smooth), and without missing points
    /// [`Tilt`](WarningCode::Tilt), [`OpenEdges`](WarningCode::OpenEdges), [`Spikes`](WarningCode::Spikes) and
    /// [`LineOffsets`](WarningCode::LineOffsets). Before these, numbers that are no heights, as
    /// [`of_surface`](Self::of_surface) finds them.
    ///
    /// ```
    /// use asperity_maps::warning::Warning;
    /// use asperity_maps::Topography;
    /// let mut map = Topography::new(ndarray::Array2::from_shape_fn((9, 9), |(i, j)| ((7 * i + 5 * j) as f64).sin()));
    /// map.heights.row_mut(3).fill(-99.0);
    /// let found = Warning::of_topography(&map);
    /// assert!(found[0].message().starts_with("-99 stands at 9 nodes"));
    /// assert!(Warning::of_topography(&map.declare_missing(-99.0)).is_empty());
    /// ```
    pub fn of_topography(map: &Topography) -> Vec<Self> {
        let heights = map.heights.as_standard_layout().into_owned();
        if let Some(warning) = layout::byte_order(&heights) {
            return vec![warning];
        }
        let extremes = Extremes::find(&heights);
        let codes = extremes.codes().into_iter().map(|(value, count)| missing_code(value, count));
        let mut found: Vec<_> = layout::axes(&heights).into_iter().chain(codes).collect();
        if !found.is_empty() {
            return found;
        }
        found.extend(map.rms_slope().and_then(|found| slope(found, STEEP_MAP)));
        let sides = map.lengths.unwrap_or((1.0, 1.0));
        if let (Ok(grid), false, 0) = (Grid::new(heights.dim(), sides), is_flat(&extremes), map.missing()) {
            let relief = Relief::measure(&heights, &extremes);
            // of unknown sides the slopes would be none
            let tilt = map.lengths.and_then(|_| tilt(&relief, &grid));
            let at_edges = tilt.into_iter().chain(open_edges(&relief));
            found.extend(at_edges.chain(spikes(&relief)).chain(lines::offsets(&relief.heights, relief.unit)));
        }
        found
    }

    /// What the file or the object of a map leaves open: its side lengths ([`Sides`](WarningCode::Sides)), where none are
    /// known and something next to the heights may give them; a mask ([`Mask`](WarningCode::Mask)); and whether opposite
    /// edges meet ([`NotPeriodic`](WarningCode::NotPeriodic)).
    ///
    /// ```
    /// use asperity_maps::warning::Warning;
    /// use asperity_maps::Topography;
    /// let mut map = Topography::new(ndarray::Array2::zeros((4, 4)));
    /// map.unread = vec!["sides".to_owned()];
    /// map.periodic = Some(false);
    /// let codes: Vec<_> = Warning::of_source(&map).iter().map(|warning| warning.code.name()).collect();
    /// assert_eq!(codes, ["sides", "not-periodic"]);
    /// ```
    pub fn of_source(map: &Topography) -> Vec<Self> {
        let named = |names: &[String]| names.iter().map(|name| format!("{name:?}")).collect::<Vec<_>>().join(", ");
        let (first, more) = map.unread.split_at(map.unread.len().min(MOST_NAMES));
        let more = if more.is_empty() { "" } else { ", ..." };
        let sides = (map.lengths.is_none() && !first.is_empty()).then(|| {
            let text = "the side lengths are unknown, but the file has {}: give lengths";
            Self::new(WarningCode::Sides, 0.0, text, [Word(named(first) + more)])
        });
        let mask = map.unread.iter().find(|name| name.starts_with("a mask")).map(|mask| {
            let mask = mask.split(',').next().unwrap_or_default().to_owned();
            let text = "the file has {}, which count as measured: read them as missing if they are";
            Self::new(WarningCode::Mask, 0.0, text, [Word(mask)])
        });
        let open = (map.periodic == Some(false)).then(|| {
            let text = "the map is not periodic, but is solved as if it were: mirror or window it";
            Self::new(WarningCode::NotPeriodic, 0.0, text, [])
        });
        [sides, mask, open].into_iter().flatten().collect()
    }

    /// The probable mistakes in an answer: [`BeyondModulus`](WarningCode::BeyondModulus) where the contact modulus E*
    /// is positive, [`WindowEdge`](WarningCode::WindowEdge) with a free boundary, and [`Scars`](WarningCode::Scars) or
    /// [`Noise`](WarningCode::Noise) where more than 20 % of the load of at least 100 nodes stands on lines, or 33 % on
    /// single nodes, that press three times as hard as their neighbours. The remedy for scars depends on the threshold
    /// of scars that were [removed](Topography::scars_removed) from the heights.
    pub fn of_solution<T: Real>(solution: &Solution<T>, scars_removed: Option<f64>) -> Vec<Self> {
        let modulus = solution.report.modulus;
        let pressures = || solution.contact_pressure.iter().map(|pressure| pressure.widen());
        let count = pressures().filter(|pressure| *pressure > modulus).count();
        let mut found = Vec::new();
        found.extend(window_edge(solution));
        found.extend(load::of_load(solution, scars_removed));
        if count == 0 || modulus <= 0.0 {
            return found;
        }
        let greatest = pressures().fold(f64::NEG_INFINITY, f64::max);
        found.push(Self::new(
            WarningCode::BeyondModulus,
            greatest / modulus,
            "the contact pressure is up to {}, {} E*: check the load and the units",
            [Pressure(greatest), Figure(greatest / modulus)],
        ));
        found
    }

    /// A solution on a mirrored map with another contact than its mirror images, [`Images`](WarningCode::Images): its
    /// `original` does not stand for the whole.
    ///
    /// ```
    /// use asperity::contact::Original;
    /// use asperity_maps::warning::Warning;
    /// use asperity::{Control, Grid, NoAdhesion, Problem, Solver, Surface, Westergaard};
    /// let grid = Grid::square(32, 1.0)?;
    /// let sphere = Surface::paraboloid(grid, 2.0)?; // its mirror lines are between no nodes
    /// let mut problem = Problem::new(&sphere, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
    /// let solution = Solver::default().solve(&mut problem, Control::MeanPressure(0.001))?;
    /// let [left, all] = [(16, 16), (32, 32)].map(|nodes| Original::new(&grid, nodes));
    /// assert!(Warning::of_images(&left?, &solution)?.is_some());
    /// assert!(Warning::of_images(&all?, &solution)?.is_none());
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Shape`](asperity::Error::Shape) if the solution is not one of the whole.
    pub fn of_images<T: Real>(original: &Original, solution: &Solution<T>) -> Result<Option<Self>> {
        let whole = solution.report.contact_nodes as f64;
        let part = original.contact_nodes(solution)? as f64;
        let expected = original.share() * whole;
        if (part - expected).abs() <= f64::max(1.0, UNLIKE * expected) {
            return Ok(None);
        }
        let percent = |contact: f64, grid: &Grid| Figure(100.0 * contact / grid.nodes() as f64);
        Ok(Some(Self::new(
            WarningCode::Images,
            (part - expected).abs() / expected.max(1.0),
            "{} % of the original touch, but {} % of the whole: look at the whole",
            [percent(part, original.grid()), percent(whole, original.whole())],
        )))
    }
}

fn is_flat(extremes: &Extremes) -> bool {
    extremes.span() <= FLAT * extremes.low.abs().max(extremes.high.abs())
}

fn window_edge<T: Real>(solution: &Solution<T>) -> Option<Warning> {
    let share = solution.report.edge_traction.filter(|_| solution.report.reaches_edge)?;
    let text = "contact or traction reaches the edge, {} of the largest: widen the map";
    Some(Warning::new(WarningCode::WindowEdge, share, text, [Figure(share)]))
}
