//! The keys of the steps of a preparation.

use std::str::FromStr;

use asperity_maps::{Form, RowAlignment, ScanAxis, Trend};

use crate::key::{Kind, LENGTH, Range, Word, is_unit, keys, readable};

keys! {
    /// The steps that make a surface of a measured map, in their order but for those with lengths.
    #[derive(Default)]
    StepKeys {
        "" {
            /// Value that stands for missing points, in the unit of the heights as they are read; may be repeated
            missing: Vec<f64> = Kind::number(Range::FINITE, &["CODE"]).commas(),
            /// Factor by which to multiply the heights, for example 1e-9 for heights in nm and side lengths in m
            scale: Option<f64> = Kind::number(Range::POSITIVE, &["F"]),
            /// Unit of side lengths and heights after this factor, instead of the file's; solve uses it in tables and
            /// pictures
            unit: Option<String> = Kind::text(is_unit, &["UNIT"]),
            /// Keep NX x NY nodes from index [X, Y] on
            crop: Vec<usize> = Kind::whole(&["X", "Y", "NX", "NY"]).each(),
            /// Turn peaks into valleys: for a replica
            flip: bool = Kind::switch(),
            /// Clean the map of an AFM: {align_rows} median, {remove_scars}, {despike}, {detrend} plane and {fill}, but for
            /// those that are given otherwise, or left out by {without}
            clean: bool = Kind::switch(),
            /// Part of {clean} to leave out
            without: Vec<String> = Kind::word(|| Word::all(&StepKeys::OF_CLEAN), &["PART"]).commas().needs(&["clean"]),
            /// Bring the scan lines of an AFM to one height: median (of each line), median-difference (from line to line,
            /// for large features) or polynomial:ORDER (of each line; ORDER is 1 if it is left out)
            align_rows: Option<RowAlignment> = Kind::text(|text| RowAlignment::from_str(text).map(drop), &["METHOD"]),
            /// Direction of the scan lines of {align_rows} and {remove_scars} [default: x]
            scan_axis: Option<ScanAxis> = Kind::word(|| Word::all(&ScanAxis::NAMES), &["SCAN_AXIS"]).needs(&["align_rows|remove_scars|clean"]),
            /// Replace scars by the heights around them. Scars are pieces of one to four scan lines, at least 16 nodes
            /// long, that are everywhere higher, or everywhere lower, than both neighbouring lines, by more than this
            /// many rms differences of neighbouring lines [default: 0.667 if {remove_scars} has no value]
            remove_scars: Option<f64> = Kind::number(Range::POSITIVE, &["THRESHOLD"]).alone("0.667"),
            /// Give spikes the median of the 5 x 5 nodes around them, if they are farther from it than this many robust
            /// standard deviations of all nodes [default: 10 if {despike} has no value]
            despike: Option<f64> = Kind::number(Range::POSITIVE, &["THRESHOLD"]).alone("10"),
            /// Subtract the sphere or the circular cylinder that fits all measured points best
            remove_form: Option<Form> = Kind::word(|| Word::all(&Form::NAMES), &["FORM"]),
            /// Subtract the least-squares fit to all measured points: mean, plane, quadric (such as a sphere or a
            /// cylinder), or a polynomial of this order, up to 12
            detrend: Option<Trend> = Kind::text(|text| Trend::from_str(text).map(drop), &["TREND"]),
            /// Fill missing points smoothly from their surroundings, by Laplace's equation
            fill: bool = Kind::switch(),
            /// Make the map periodic: taper heights towards their mean within this share of the sides at each edge, up
            /// to 0.5. Good for spectra; under load the flat frame may come into contact, while {mirror} keeps all
            /// heights
            window: Option<f64> = Kind::number(Range::FINITE, &["F"]).excludes(&["mirror"]),
            /// Make the map periodic: continue it by its mirror images, to twice the size along both sides. A .npz
            /// remembers its original, and solve then gives the results of the original
            mirror: bool = Kind::switch(),
            /// Interpolate on NX x NY nodes by Fourier series, finer or coarser; the map should be periodic by then
            resample: Vec<usize> = Kind::nodes(&["NX", "NY"]).each(),
        }
    }
}

keys! {
    /// The side lengths that a preparation gives a map.
    NewLengthsKeys {
        "" {
            /// Side lengths, instead of the file's; LX alone means square cells. With a unit, such as 20um, the result
            /// is in the unit of {unit} or of the file, or else in m
            lengths: Vec<f64> = Kind::quantity(LENGTH, Range::POSITIVE, &["LX", "LY"]).from(1),
        }
    }
}

keys! {
    /// The waves that a preparation leaves out.
    CutOffKeys {
        "" {
            /// Remove the waves shorter than this, for example where they are noise: stats prints the wavelength of the
            /// knee of the spectrum, beyond which it is flat. The map should be periodic by then
            cut_off_wavelength: Option<f64> = Kind::quantity(LENGTH, Range::POSITIVE, &["LENGTH"]),
        }
    }
}

readable! {
    Option<RowAlignment>: Word = |value| value?.as_str()?.parse().ok();
    Option<ScanAxis>: Word = |value| value?.as_str()?.parse().ok();
    Option<Form>: Word = |value| value?.as_str()?.parse().ok();
    Option<Trend>: Word = |value| value?.as_str()?.parse().ok();
}

impl StepKeys {
    /// The parts of a cleaning, in their order.
    pub const OF_CLEAN: [&str; 5] = ["rows", "scars", "spikes", "plane", "holes"];
}
