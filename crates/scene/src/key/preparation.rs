//! The preparation of a measured map: its steps, their order, and the log of them.

mod described;
mod steps;

use std::fmt::Display;

use asperity::{Error, Result};
use asperity_maps::io::check_memory;
use asperity_maps::warning::{Warning, WarningCode};
use asperity_maps::{RowAlignment, ScanAxis, Topography, Trend};

use crate::key::{Entries, LENGTH, Notice, Units, power_of_length, times_ten_to};
use crate::numbers::plain;
pub use steps::{CutOffKeys, NewLengthsKeys, StepKeys};

use described::{changed, described, described_form, holes, list_others, quantity, removed, rms, sides};

/// The steps that make a surface of a measured map; no step by default.
#[derive(Clone, Debug, Default)]
pub struct Preparation {
    /// The steps without lengths.
    pub steps: StepKeys,
    /// The side lengths, with the unit of the map from then on.
    pub lengths: Option<((f64, f64), Option<String>)>,
    /// The cut-off wavelength, in the unit of the map.
    pub cut_off_wavelength: Option<f64>,
}

impl Entries {
    /// The steps of a preparation of a map of a shape, with numbers in SI units or not; the map may have a unit.
    ///
    /// # Errors
    /// As [`Preparation::set_lengths`] and [`Preparation::set_cut_off_wavelength`].
    pub fn steps(
        &self,
        shape: (usize, usize),
        si: bool,
        unit: Option<&str>,
    ) -> std::result::Result<Preparation, String> {
        let mut steps = Preparation { steps: self.keys(), ..Preparation::default() };
        self.lengths(shape).map_or(Ok(()), |lengths| steps.set_lengths(lengths, si, unit))?;
        let cut_off = self.keys::<CutOffKeys>().cut_off_wavelength;
        cut_off.map_or(Ok(()), |cut_off| steps.set_cut_off_wavelength(cut_off, si, unit))?;
        Ok(steps)
    }
}

/// The log of a preparation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Log {
    /// Each step that was taken, with its name and its effect in numbers.
    pub lines: Vec<(&'static str, String)>,
    /// The probable mistakes that were met.
    pub warnings: Vec<Notice>,
}

impl Log {
    fn tell(&mut self, step: &'static str, what: impl Into<String>) {
        self.lines.push((step, what.into()));
    }

    /// Tells a step with the rms height behind it.
    fn tell_rms(&mut self, step: &'static str, what: impl Display, map: &Topography) {
        self.tell(step, format!("{what}: rms height {}", rms(map)));
    }

    /// Tells a step with the rms height behind it, and that `before` it.
    fn tell_change(&mut self, step: &'static str, what: impl Display, map: &Topography, before: &str) {
        self.tell(step, format!("{what}: rms height {} from {before}", rms(map)));
    }

    fn warn(&mut self, found: impl IntoIterator<Item = Warning>, map: &Topography) {
        let units = Units::of_map(map.unit.as_deref());
        self.warnings.extend(found.into_iter().map(|warning| units.describe(&warning)));
    }
}

impl Preparation {
    /// The steps with the steps of a cleaning.
    fn cleaned(mut self) -> Self {
        let steps = &mut self.steps;
        steps.clean = false;
        let has = |part: &str| !steps.without.iter().any(|without| without == part);
        let [rows, scars, spikes, plane, holes] = StepKeys::OF_CLEAN.map(has);
        steps.align_rows = steps.align_rows.or(rows.then_some(RowAlignment::Median));
        steps.remove_scars = steps.remove_scars.or(scars.then_some(0.667));
        steps.despike = steps.despike.or(spikes.then_some(10.0));
        steps.detrend = steps.detrend.or(plane.then_some(Trend::Plane));
        steps.fill |= holes;
        self
    }

    /// Gives the map side lengths; those in metres are brought to the unit that the map will have.
    ///
    /// # Errors
    /// A text if that is no unit of length, for [`worded`](crate::worded).
    pub fn set_lengths(
        &mut self,
        (lx, ly): (f64, f64),
        in_metres: bool,
        of_map: Option<&str>,
    ) -> std::result::Result<(), String> {
        if !in_metres {
            self.lengths = Some(((lx, ly), of_map.map(str::to_owned)));
            return Ok(());
        }
        let (unit, power) = self.unit_of_lengths("{lengths} have", of_map)?;
        self.lengths = Some(((times_ten_to(-power, lx), times_ten_to(-power, ly)), Some(unit)));
        Ok(())
    }

    /// Gives the map a cut-off wavelength; one in metres is brought to the unit that the map will have.
    ///
    /// # Errors
    /// A text if that is no unit of length, for [`worded`](crate::worded).
    pub fn set_cut_off_wavelength(
        &mut self,
        cut_off: f64,
        in_metres: bool,
        of_map: Option<&str>,
    ) -> std::result::Result<(), String> {
        let power = if in_metres { self.unit_of_lengths("{cut_off_wavelength} has", of_map)?.1 } else { 0 };
        self.cut_off_wavelength = Some(times_ten_to(-power, cut_off));
        Ok(())
    }

    /// The unit that the map will have, which is of length, and its power of ten, for what `has` a unit.
    fn unit_of_lengths(&self, has: &str, of_map: Option<&str>) -> std::result::Result<(String, i32), String> {
        let unit = self.steps.unit.as_deref().or(of_map).unwrap_or(LENGTH.si);
        let power = power_of_length(unit).ok_or_else(|| {
            format!("{has} a unit, but the map is in {unit}, which is no unit of length: give {{unit}}, such as nm")
        })?;
        Ok((unit.to_owned(), power))
    }

    /// The prepared map, with a line in the log for each step; the log has those before an error, too.
    ///
    /// # Errors
    /// Errors of the steps: see [`Topography`].
    pub fn run(&self, mut map: Topography, log: &mut Log) -> Result<Topography> {
        if self.steps.clean {
            return self.clone().cleaned().run(map, log);
        }
        log.tell("read", format!("{}{}", described(&map), list_others(&map)));
        map = self.interpret(map, log)?;
        let has_codes = !log.warnings.is_empty();
        if let [x, y, nx, ny] = self.steps.crop[..] {
            map = map.crop(x..x.saturating_add(nx), y..y.saturating_add(ny))?;
            log.tell("crop", format!("from index [{x}, {y}] on: {}", described(&map)));
        }
        log.warn(Warning::of_topography(&map).into_iter().filter(is_no_height), &map);
        if self.steps.flip {
            map = map.flip();
            log.tell("flip", "peaks are valleys now");
        }
        map = self.clean_lines(map, log)?;
        map = self.level(map, log)?;
        map = self.continue_periodically(map, log)?;
        if let Some(holes) = holes(&map) {
            log.tell("left", format!("points are missing still, {holes}: fill them before solving"));
        }
        // where codes for missing points are among the heights, they alone make the slope
        let is_left = |found: &Warning| !(is_code(found) || is_no_height(found) || has_codes);
        log.warn(Warning::of_topography(&map).into_iter().filter(is_left), &map);
        map.unread.clear();
        Ok(map)
    }

    /// Takes the numbers of a file for what they mean: side lengths, missing points, the factor and the unit of heights.
    fn interpret(&self, mut map: Topography, log: &mut Log) -> Result<Topography> {
        if let Some((lengths, unit)) = &self.lengths {
            let before = map.lengths.map_or("unknown".to_owned(), |before| sides(before, map.unit.as_deref()));
            (map.lengths, map.unit) = (Some(*lengths), unit.clone());
            log.tell("lengths", format!("{}, before {before}", sides(*lengths, unit.as_deref())));
        }
        for code in &self.steps.missing {
            let before = map.missing();
            map = map.declare_missing(*code);
            let (found, nodes) = (map.missing() - before, map.heights.len());
            log.tell_rms("missing", format!("{} stood at {found} of {nodes} points", plain(*code)), &map);
        }
        log.warn(Warning::of_topography(&map).into_iter().filter(is_code), &map);
        if let Some(factor) = self.steps.scale {
            let to_metres = map.unit.as_deref().and_then(power_of_length).filter(|power| *power != 0);
            if self.steps.unit.is_none() && to_metres.is_some_and(|power| factor == times_ten_to(power, 1.0)) {
                let requirement =
                    "left out, since the file tells the unit, or next to unit m, if heights are in m then";
                return Err(Error::Value { name: "scale", value: factor, requirement });
            }
            map.heights.mapv_inplace(|h| factor * h);
            log.tell_rms("scale", format!("heights times {}", plain(factor)), &map);
        }
        if let Some(unit) = &self.steps.unit {
            let before = map.unit.replace(unit.clone()).unwrap_or("unknown".to_owned());
            log.tell("unit", format!("{unit}, before {before}"));
        }
        Ok(map)
    }

    /// Removes what scanning leaves: offsets between lines, scars and spikes.
    fn clean_lines(&self, mut map: Topography, log: &mut Log) -> Result<Topography> {
        let along = self.steps.scan_axis.unwrap_or(ScanAxis::X);
        let axis = if along == ScanAxis::X { "x" } else { "y" };
        if let Some(alignment) = self.steps.align_rows {
            let (before, heights) = (rms(&map), map.heights.clone());
            log.warn(Warning::of_lines(&map, along), &map);
            map = map.align_rows(alignment, along)?;
            let (nx, ny) = map.heights.dim();
            let lines = if along == ScanAxis::X { ny } else { nx };
            let what = format!("{lines} lines along {axis} {}", changed(&heights, &map));
            log.tell_change("align-rows", what, &map, &before);
        }
        if let Some(threshold) = self.steps.remove_scars {
            let (scars, before, nodes) = (map.scars(threshold, along)?, rms(&map), map.heights.len());
            let (count, points) = (scars.count, scars.map.iter().filter(|&&on_scar| on_scar).count());
            let limit = quantity(scars.limit, &map);
            map = map.without(&scars)?;
            let beyond =
                |scars: &str, them| format!("{scars} along {axis} beyond {limit} from the lines next to {them}");
            let what = match count {
                0 => beyond("no scars", "them"),
                1 => beyond("1 scar", "it") + &format!(", {points} of {nodes} points replaced"),
                _ => beyond(&format!("{count} scars"), "them") + &format!(", {points} of {nodes} points replaced"),
            };
            log.tell_change("remove-scars", what, &map, &before);
        }
        if let Some(threshold) = self.steps.despike {
            let (spikes, before, nodes) = (map.spikes(threshold)?, rms(&map), map.heights.len());
            map = map.despike(threshold)?;
            let limit = quantity(spikes.limit, &map);
            let what = match spikes.worst {
                Some(((i, j), distance)) => format!(
                    "{} of {nodes} points deviated by more than {limit} and were set to the median around them; the largest deviation was {} at index [{i}, {j}]",
                    spikes.nodes.len(),
                    quantity(distance, &map)
                ),
                None => format!("none of {nodes} points deviates by more than {limit} from the median around it"),
            };
            log.tell_change("despike", what, &map, &before);
            log.warn(Warning::of_despiked(spikes.nodes.len(), nodes), &map);
        }
        Ok(map)
    }

    /// Subtracts form and trend, and fills missing points.
    fn level(&self, mut map: Topography, log: &mut Log) -> Result<Topography> {
        if let Some(form) = self.steps.remove_form {
            let (fit, before) = (map.fit_form(form)?, rms(&map));
            map = map.remove_form(form)?;
            log.tell_change("remove-form", format!("{} removed", described_form(&fit, &map)), &map, &before);
        }
        if let Some(trend) = self.steps.detrend {
            let before = map.clone();
            map = map.detrend(trend)?;
            let what = removed(trend, &before, &map)?;
            log.tell_change("detrend", what, &map, &rms(&before));
        }
        if self.steps.fill {
            let (missing, nodes) = (map.missing(), map.heights.len());
            map = map.fill()?;
            log.tell_rms("fill", format!("{missing} of {nodes} points filled"), &map);
        }
        Ok(map)
    }

    /// Makes a map periodic, and chooses its waves and nodes.
    fn continue_periodically(&self, mut map: Topography, log: &mut Log) -> Result<Topography> {
        if let Some(fraction) = self.steps.window {
            let before = rms(&map);
            map = map.window(fraction)?;
            let what = format!("{} % of the sides tapered at each edge", plain(100.0 * fraction));
            log.tell_change("window", what, &map, &before);
        }
        if self.steps.mirror {
            let (nx, ny) = map.heights.dim();
            check_memory("a mirrored map", (2 * nx, 2 * ny), 8)?;
            map = map.mirror();
            log.tell("mirror", described(&map));
        }
        if let Some(cut_off) = self.cut_off_wavelength {
            let before = map.clone();
            map = map.low_pass(cut_off)?;
            // the waves belong to a periodic map: where edges do not meet they ring
            let rings = |warning: &Warning| warning.code == WarningCode::OpenEdges;
            log.warn(Warning::of_surface(&before.clone().surface()?).into_iter().filter(rings), &before);
            let [to, from] = [&map, &before].map(|map| plain(map.rms_slope().unwrap_or(f64::NAN)));
            let what = format!("waves shorter than {} left out, which may be noise", quantity(cut_off, &map));
            let before = format!("{}, rms slope by differences {to} from {from}", rms(&before));
            log.tell_change("cut-off-wavelength", what, &map, &before);
        }
        if let [nx, ny] = self.steps.resample[..] {
            let before = rms(&map);
            map = map.resample((nx, ny))?;
            let moved = "nodes moved to the middles of their cells";
            log.tell("resample", format!("{} from {before}, {moved}", described(&map)));
        }
        Ok(map)
    }
}

fn is_code(warning: &Warning) -> bool {
    warning.code == WarningCode::MissingCode
}

fn is_no_height(warning: &Warning) -> bool {
    matches!(warning.code, WarningCode::Axes | WarningCode::ByteOrder)
}

/// A map in a unit of length. One without a unit is in it already.
///
/// # Errors
/// A text if the map is in another unit, or its side lengths are no lengths in this one, for [`worded`](crate::worded).
pub fn in_unit(mut map: Topography, unit: &str) -> std::result::Result<Topography, String> {
    let of_map = map.unit.replace(unit.to_owned()).unwrap_or_else(|| unit.to_owned());
    if of_map != unit {
        let (Some(from), Some(to)) = (power_of_length(&of_map), power_of_length(unit)) else {
            return Err(format!(
                "is in {of_map}, but numbers with units are in {unit}: give the unit of its lengths by {{prepare:unit}}, \
                 or numbers without units"
            ));
        };
        let converted = |length| times_ten_to(from - to, length);
        map.heights.mapv_inplace(converted);
        map.lengths = map.lengths.map(|(lx, ly)| (converted(lx), converted(ly)));
        if let Some((lx, ly)) = map.lengths.filter(|&(lx, ly)| !(lx.min(ly) > 0.0 && lx.max(ly).is_finite())) {
            return Err(format!("has side lengths of {lx} and {ly} {unit}, expected positive numbers: save it again"));
        }
    }
    Ok(map)
}
