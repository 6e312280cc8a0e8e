//! The surfaces that are made: bodies of simple forms, and self-affine roughness.

use std::f64::consts::TAU;
use std::path::PathBuf;

use asperity::{Amplitude, Error, Grid, Result, SelfAffine, Surface};
use asperity_maps::surface_with_absent;
use ndarray::Array2;

use crate::key::{Entries, Kind, LENGTH, Range, choice, keys};

keys! {
    /// The grid of a surface that is made.
    GridKeys {
        "Grid" {
            /// Nodes along each side of a square
            size: Option<usize> = Kind::nodes(&["N"]),
            /// Nodes along each side of a rectangle; NY = 1 makes a line
            shape: Vec<usize> = Kind::nodes(&["NX", "NY"]).each(),
            /// Side lengths; LX alone means square cells [default: 1 1]
            lengths: Vec<f64> = Kind::quantity(LENGTH, Range::POSITIVE, &["LX", "LY"]).from(1),
        }
    }
}

impl Entries {
    /// The nodes of a surface that is made.
    ///
    /// # Errors
    /// The remedy, unless either a square or a rectangle is given.
    pub fn shape(&self) -> std::result::Result<(usize, usize), String> {
        let GridKeys { size, shape, .. } = self.keys();
        match (size, &shape[..]) {
            (Some(size), []) => Ok((size, size)),
            (None, &[nx, ny]) => Ok((nx, ny)),
            _ => Err("give {size}, the nodes along each side of a square, or {shape}, two numbers of nodes".to_owned()),
        }
    }

    /// The side lengths of a surface that is made, 1 by 1 by default, which are needed where numbers are in SI units.
    ///
    /// # Errors
    /// The remedy where they are missing, for [`worded`](crate::worded).
    pub fn sides(&self, shape: (usize, usize), si: bool) -> std::result::Result<(f64, f64), String> {
        match self.lengths(shape) {
            None if si => {
                Err("the numbers have units, but nothing says how large the map is: give {lengths}, such as 20um"
                    .to_owned())
            }
            lengths => Ok(lengths.unwrap_or((1.0, 1.0))),
        }
    }

    /// The unit of the coefficients of a surface, if it is given.
    pub fn fourier_unit(&self) -> Option<f64> {
        self.keys::<FourierKeys>().fourier_unit
    }

    /// The file of the coefficients of a surface.
    pub fn fourier(&self) -> Option<PathBuf> {
        self.keys::<FourierKeys>().fourier
    }
}

keys! {
    /// A body of a simple form.
    FormKeys {
        "Form" {
            /// Form of the body, with its apex on the node in the middle
            form: BodyForm = Kind::word(BodyForm::words, &["FORM"]).or("self-affine"),
            /// Radius of a sphere or a flat punch, radius of curvature of a paraboloid
            radius: Option<f64> = Kind::quantity(LENGTH, Range::POSITIVE, &["R"]),
            /// Angle between the side of a cone and the half-space, in degrees: 90 less half the angle at its apex
            angle: Option<f64> = Kind::number(Range::ACUTE, &["DEGREES"]),
            /// Amplitude A of a wave
            amplitude: Option<f64> = Kind::quantity(LENGTH, Range::POSITIVE, &["A"]),
            /// Periods of a wave along x, and along y [default: 1 0]
            periods: Vec<usize> = Kind::whole(&["MX", "MY"]).from(1),
            /// Slope of a plane that is added, along x and along y [default: 0 0]
            tilt: Vec<f64> = Kind::number(Range::FINITE, &["SX", "SY"]).from(1),
        }
    }
}

choice! {
    /// The form of a body.
    BodyForm {
        /// flat, with roughness on it
        SelfAffine = "self-affine",
        /// sqrt(R^2 - r^2) - R, absent beyond R
        Sphere = "sphere",
        /// -r^2/2R
        Paraboloid = "paraboloid",
        /// -r tan(angle)
        Cone = "cone",
        /// A cos(2 pi MX x/LX) cos(2 pi MY y/LY)
        Wave = "wave",
        /// 0 up to R, absent beyond
        FlatPunch = "flat-punch",
    }
}

impl FormKeys {
    /// Refuses parameters that the form lacks or does not have.
    ///
    /// # Errors
    /// The first of them, and the remedy, for [`worded`](crate::worded).
    pub fn check(&self) -> std::result::Result<(), String> {
        let round = [BodyForm::Sphere, BodyForm::Paraboloid, BodyForm::FlatPunch];
        let given = [
            ("radius", self.radius.is_some(), round.contains(&self.form)),
            ("angle", self.angle.is_some(), self.form == BodyForm::Cone),
            ("amplitude", self.amplitude.is_some(), self.form == BodyForm::Wave),
            ("periods", !self.periods.is_empty(), self.form == BodyForm::Wave && !self.periods.is_empty()),
        ];
        let misfit = given.into_iter().find(|(_, given, needed)| given != needed);
        misfit.map_or(Ok(()), |(name, _, lacks)| {
            let (what, remedy) = if lacks { ("lacks", "give it") } else { ("has no", "leave it out") };
            Err(format!("{{form}} {} {what} {{{name}}}: {remedy}", self.form))
        })
    }

    /// The surface of the body with `roughness` of the shape of the grid on it; nodes beyond the body are absent.
    ///
    /// # Errors
    /// [`Error::Value`] if the grid does not resolve a wave.
    pub fn surface(&self, grid: Grid, roughness: Option<Surface>) -> Result<Surface> {
        let flat = self.form == BodyForm::SelfAffine && self.tilt.is_empty();
        if let (true, Some(roughness)) = (flat, &roughness) {
            return Ok(roughness.clone());
        }
        let mut heights = self.heights(&grid)?;
        if let Some(roughness) = roughness {
            heights += roughness.heights();
        }
        surface_with_absent(grid, heights)
    }

    /// The heights of the body, NaN beyond it.
    fn heights(&self, grid: &Grid) -> Result<Array2<f64>> {
        let (radius, amplitude) = (self.radius.unwrap_or_default(), self.amplitude.unwrap_or_default());
        let slope = self.angle.unwrap_or_default().to_radians().tan();
        let (mx, my) = pair(&self.periods).unwrap_or((1, 0));
        let ((nx, ny), (lx, ly)) = (grid.shape(), grid.lengths());
        for (name, periods, nodes) in [("periods MX", mx, nx), ("periods MY", my, ny)] {
            if self.form == BodyForm::Wave && periods > nodes / 2 {
                let requirement = "at most half the number of nodes";
                return Err(Error::Value { name, value: periods as f64, requirement });
            }
        }
        let (along_x, along_y) = pair(&self.tilt).unwrap_or_default();
        let form = |x: f64, y: f64| {
            let r2 = x * x + y * y;
            match self.form {
                BodyForm::SelfAffine => 0.0,
                // without the cancellation of nearly equal lengths
                BodyForm::Sphere => -r2 / (radius + (radius * radius - r2).sqrt()),
                BodyForm::Paraboloid => -r2 / (2.0 * radius),
                BodyForm::Cone => -slope * r2.sqrt(),
                BodyForm::Wave => amplitude * (TAU * mx as f64 * x / lx).cos() * (TAU * my as f64 * y / ly).cos(),
                BodyForm::FlatPunch if r2 <= radius * radius => 0.0,
                BodyForm::FlatPunch => f64::NAN,
            }
        };
        Ok(grid.sample(|x, y| form(x, y) + along_x * x + along_y * y))
    }
}

/// One value or two; the second is zero if left out.
fn pair<T: Copy + Default>(values: &[T]) -> Option<(T, T)> {
    match values {
        [x] => Some((*x, T::default())),
        [x, y, ..] => Some((*x, *y)),
        [] => None,
    }
}

keys! {
    /// Self-affine roughness.
    RoughnessKeys {
        "Roughness" {
            /// Root mean square of the heights of the roughness, a length
            rms_height: Option<f64> = Kind::quantity(LENGTH, Range::POSITIVE, &["H"]).excludes(&["rms_slope"]),
            /// Root mean square of the slope of the roughness
            rms_slope: Option<f64> = Kind::number(Range::POSITIVE, &["S"]),
            /// Hurst exponent, from 0 to 1
            hurst: Option<f64> = Kind::number(Range::FINITE, &["H"]).or("0.8"),
            /// Wave number of the longest waves, in units of 2 pi/LX
            k_l: Option<f64> = Kind::number(Range::FINITE, &["KL"]).or("4"),
            /// Wave number up to which the spectrum is constant [default: KL, for none]
            k_r: Option<f64> = Kind::number(Range::FINITE, &["KR"]),
            /// Wave number of the shortest waves, below half the number of nodes
            k_s: Option<f64> = Kind::number(Range::FINITE, &["KS"]).or("64"),
            /// Let only phases be random, and not the moduli of the waves
            random_phase: bool = Kind::switch(),
            /// Seed of the random numbers, from 0: each makes another surface
            seed: Option<u64> = Kind::whole(&["N"]).or("0"),
        }
    }
}

keys! {
    /// Roughness by the waves of a file.
    FourierKeys {
        "Roughness" {
            /// Roughness by the Fourier coefficients of a text: lines of qX, qY, Re h(q), Im h(q), with whole numbers of
            /// periods along the sides, as FFTW's inverse transform takes them; half of the waves is enough
            fourier: Option<PathBuf> = Kind::file().excludes(&["rms_height", "rms_slope"]),
            /// Unit of length of the coefficients [default: the unit of the side lengths, where it has no name]
            fourier_unit: Option<f64> = Kind::quantity(LENGTH, Range::POSITIVE, &["LENGTH"])
                .needs(&["fourier"]).excludes(&["rms_height", "rms_slope"]),
        }
    }
}

impl RoughnessKeys {
    /// The generator of the roughness; none without an amplitude, or with two.
    pub fn self_affine(&self) -> Option<SelfAffine> {
        let usual = SelfAffine::default();
        let amplitude = match (self.rms_height, self.rms_slope) {
            (Some(height), None) => Amplitude::RmsHeight(height),
            (None, Some(slope)) => Amplitude::RmsSlope(slope),
            _ => return None,
        };
        let (k_l, k_s) = (self.k_l.unwrap_or(usual.k_l), self.k_s.unwrap_or(usual.k_s));
        let rough = usual.hurst(self.hurst.unwrap_or(usual.hurst)).k_l(k_l).k_r(self.k_r.unwrap_or(k_l)).k_s(k_s);
        let rough = rough.amplitude(amplitude).random_phase(self.random_phase);
        Some(rough.seed(self.seed.unwrap_or(usual.seed)))
    }
}
