//! The surfaces that are made: bodies of simple forms, and self-affine roughness.

use std::f64::consts::TAU;
use std::fmt;

use asperity::{Amplitude, Error, Grid, Result, SelfAffine, Surface};
use asperity_maps::surface_with_absent;
use ndarray::Array2;
use serde::Deserialize;

#[cfg(feature = "options")]
use crate::key::allowed::{acute, finite, positive};
#[cfg(feature = "options")]
use crate::key::quantity::LENGTH;
use crate::key::quantity::Quantity;

/// A body of a simple form.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "options", derive(clap::Args), command(next_help_heading = "Form"))]
pub struct Body {
    /// Form of the body, with its apex on the node in the middle
    #[cfg_attr(feature = "options", arg(long, value_enum, default_value_t = BodyForm::SelfAffine))]
    pub form: BodyForm,
    /// Radius of a sphere or a flat punch, radius of curvature of a paraboloid
    #[cfg_attr(feature = "options", arg(long, value_name = "R", value_parser = LENGTH.positive()))]
    #[cfg_attr(feature = "options", arg(allow_hyphen_values = true))]
    pub radius: Option<Quantity>,
    /// Angle between the side of a cone and the half-space, in degrees: 90 less half the angle at its apex
    #[cfg_attr(feature = "options", arg(long, value_name = "DEGREES", allow_hyphen_values = true, value_parser = acute))]
    pub angle: Option<f64>,
    /// Amplitude A of a wave
    #[cfg_attr(feature = "options", arg(long, value_name = "A", value_parser = LENGTH.positive()))]
    #[cfg_attr(feature = "options", arg(allow_hyphen_values = true))]
    pub amplitude: Option<Quantity>,
    /// Periods of a wave along x, and along y [default: 1 0]
    #[cfg_attr(feature = "options", arg(long, value_names = ["MX", "MY"], num_args = 1..=2))]
    #[cfg_attr(feature = "options", arg(allow_negative_numbers = true))]
    pub periods: Option<Vec<u32>>,
    /// Slope of a plane that is added, along x and along y [default: 0 0]
    #[cfg_attr(feature = "options", arg(long, value_names = ["SX", "SY"], num_args = 1..=2, value_parser = finite))]
    #[cfg_attr(feature = "options", arg(allow_negative_numbers = true))]
    pub tilt: Option<Vec<f64>>,
}

/// The form of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "options", derive(clap::ValueEnum))]
pub enum BodyForm {
    /// flat, with roughness on it
    #[default]
    SelfAffine,
    /// sqrt(R^2 - r^2) - R, absent beyond R
    Sphere,
    /// -r^2/2R
    Paraboloid,
    /// -r tan(angle)
    Cone,
    /// A cos(2 pi MX x/LX) cos(2 pi MY y/LY)
    Wave,
    /// 0 up to R, absent beyond
    FlatPunch,
}

impl Body {
    /// The parameters that the form lacks or does not have, with whether it lacks them.
    pub fn misfits(&self) -> Vec<(&'static str, bool)> {
        let round = [BodyForm::Sphere, BodyForm::Paraboloid, BodyForm::FlatPunch];
        let given = [
            ("radius", self.radius.is_some(), round.contains(&self.form)),
            ("angle", self.angle.is_some(), self.form == BodyForm::Cone),
            ("amplitude", self.amplitude.is_some(), self.form == BodyForm::Wave),
            ("periods", self.periods.is_some(), self.form == BodyForm::Wave && self.periods.is_some()),
        ];
        given.into_iter().filter(|(_, given, needed)| given != needed).map(|(name, _, needed)| (name, needed)).collect()
    }

    /// The surface of the body with `roughness` of the shape of the grid on it; nodes beyond the body are absent.
    ///
    /// # Errors
    /// [`Error::Value`] if a parameter is not as its field says, or the grid does not resolve a wave.
    pub fn surface(&self, grid: Grid, roughness: Option<Surface>) -> Result<Surface> {
        let flat = self.form == BodyForm::SelfAffine && self.tilt.is_none();
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
        let length = |name, given: Option<Quantity>| given.map_or(Ok(0.0), |given| Error::positive(name, given.value));
        let (radius, amplitude) = (length("radius", self.radius)?, length("amplitude", self.amplitude)?);
        let slope = self.angle.unwrap_or_default().to_radians().tan();
        if let Some(value) = self.angle.filter(|angle| !(*angle > 0.0 && *angle < 90.0)) {
            let requirement = "a number of degrees, positive and below 90";
            return Err(Error::Value { name: "angle", value, requirement });
        }
        let (mx, my) = pair(self.periods.as_deref()).unwrap_or((1, 0));
        let ((nx, ny), (lx, ly)) = (grid.shape(), grid.lengths());
        for (name, periods, nodes) in [("periods MX", mx, nx), ("periods MY", my, ny)] {
            if self.form == BodyForm::Wave && 2 * periods as usize > nodes {
                let requirement = "at most half the number of nodes";
                return Err(Error::Value { name, value: periods.into(), requirement });
            }
        }
        let (along_x, along_y) = pair(self.tilt.as_deref()).unwrap_or_default();
        let form = |x: f64, y: f64| {
            let r2 = x * x + y * y;
            match self.form {
                BodyForm::SelfAffine => 0.0,
                // without the cancellation of nearly equal lengths
                BodyForm::Sphere => -r2 / (radius + (radius * radius - r2).sqrt()),
                BodyForm::Paraboloid => -r2 / (2.0 * radius),
                BodyForm::Cone => -slope * r2.sqrt(),
                BodyForm::Wave => {
                    amplitude * (TAU * f64::from(mx) * x / lx).cos() * (TAU * f64::from(my) * y / ly).cos()
                }
                BodyForm::FlatPunch if r2 <= radius * radius => 0.0,
                BodyForm::FlatPunch => f64::NAN,
            }
        };
        Ok(grid.sample(|x, y| form(x, y) + along_x * x + along_y * y))
    }
}

impl fmt::Display for BodyForm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::SelfAffine => "self-affine",
            Self::Sphere => "sphere",
            Self::Paraboloid => "paraboloid",
            Self::Cone => "cone",
            Self::Wave => "wave",
            Self::FlatPunch => "flat-punch",
        })
    }
}

/// One value or two, of which the second is zero if it is left out.
fn pair<T: Copy + Default>(values: Option<&[T]>) -> Option<(T, T)> {
    match values? {
        [x] => Some((*x, T::default())),
        [x, y, ..] => Some((*x, *y)),
        [] => None,
    }
}

/// Self-affine roughness, if it has an amplitude; see [`SelfAffine`].
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "options", derive(clap::Args), command(next_help_heading = "Roughness"))]
#[cfg_attr(feature = "options", command(group(clap::ArgGroup::new("height_or_slope").args(["rms_height", "rms_slope"]))))]
pub struct Roughness {
    /// Root mean square of the heights of the roughness, a length
    #[cfg_attr(feature = "options", arg(long, value_name = "H", value_parser = LENGTH.positive()))]
    #[cfg_attr(feature = "options", arg(allow_hyphen_values = true))]
    pub rms_height: Option<Quantity>,
    /// Root mean square of the slope of the roughness
    #[cfg_attr(feature = "options", arg(long, value_name = "S", allow_hyphen_values = true, value_parser = positive))]
    pub rms_slope: Option<f64>,
    /// Hurst exponent, from 0 to 1
    #[cfg_attr(feature = "options", arg(long, value_name = "H", default_value = "0.8", allow_hyphen_values = true))]
    pub hurst: f64,
    /// Wave number of the longest waves, in units of 2 pi/LX
    #[cfg_attr(feature = "options", arg(long, value_name = "KL", default_value = "4", allow_hyphen_values = true))]
    pub k_l: f64,
    /// Wave number up to which the spectrum is constant [default: KL, for none]
    #[cfg_attr(feature = "options", arg(long, value_name = "KR", allow_hyphen_values = true))]
    pub k_r: Option<f64>,
    /// Wave number of the shortest waves, below half the number of nodes
    #[cfg_attr(feature = "options", arg(long, value_name = "KS", default_value = "64", allow_hyphen_values = true))]
    pub k_s: f64,
    /// Let only phases be random, and not the moduli of the waves
    #[cfg_attr(feature = "options", arg(long))]
    pub random_phase: bool,
    /// Seed of the random numbers, from 0: each makes another surface
    #[cfg_attr(feature = "options", arg(long, value_name = "N", default_value = "0", allow_hyphen_values = true))]
    pub seed: u64,
}

impl Roughness {
    /// The generator of the roughness; none without an amplitude, or with two.
    pub fn self_affine(&self) -> Option<SelfAffine> {
        let &Self { hurst, k_l, k_s, random_phase, seed, .. } = self;
        let amplitude = match (self.rms_height, self.rms_slope) {
            (Some(height), None) => Amplitude::RmsHeight(height.value),
            (None, Some(slope)) => Amplitude::RmsSlope(slope),
            _ => return None,
        };
        let rough = SelfAffine::default().hurst(hurst).k_l(k_l).k_r(self.k_r.unwrap_or(k_l)).k_s(k_s);
        Some(rough.amplitude(amplitude).random_phase(random_phase).seed(seed))
    }
}
