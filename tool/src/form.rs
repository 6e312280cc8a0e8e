//! The form of a body: the heights of `asperity surface` without their roughness.

use std::f64::consts::TAU;
use std::fmt;

use asperity::{Grid, Surface};
use clap::{Args, ValueEnum};
use ndarray::Array2;

use crate::allowed::finite;
use crate::outcome::Outcome;
use crate::quantity::{LENGTH, Quantity};

/// The form and its parameters.
#[derive(Args, Clone)]
pub struct FormOptions {
    /// Form of the body, with its apex on the node in the middle
    #[arg(long, value_enum, default_value_t = Form::SelfAffine, help_heading = "Form")]
    pub form: Form,
    /// Radius of a sphere or a flat punch, radius of curvature of a paraboloid
    #[arg(long, value_name = "R", allow_hyphen_values = true, value_parser = LENGTH.positive(), help_heading = "Form")]
    radius: Option<Quantity>,
    /// Angle between the side of a cone and the half-space, in degrees: 90 less half the angle at its apex
    #[arg(long, value_name = "DEGREES", allow_hyphen_values = true, value_parser = acute, help_heading = "Form")]
    angle: Option<f64>,
    /// Amplitude A of a wave
    #[arg(long, value_name = "A", allow_hyphen_values = true, value_parser = LENGTH.positive(), help_heading = "Form")]
    amplitude: Option<Quantity>,
    /// Periods of a wave along x, and along y [default: 1 0]
    #[arg(long, value_names = ["MX", "MY"], num_args = 1..=2, allow_negative_numbers = true, help_heading = "Form")]
    periods: Option<Vec<u32>>,
    /// Slope of a plane that is added, along x and along y [default: 0 0]
    #[arg(long, value_names = ["SX", "SY"], num_args = 1..=2, allow_negative_numbers = true, value_parser = finite)]
    #[arg(help_heading = "Form")]
    tilt: Option<Vec<f64>>,
}

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub enum Form {
    /// flat, with roughness on it
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

impl FormOptions {
    /// Refuses a form without its parameters, and parameters of other forms.
    pub fn check(&self) -> Outcome<()> {
        let round = [Form::Sphere, Form::Paraboloid, Form::FlatPunch];
        for (name, given, needed) in [
            ("--radius", self.radius.is_some(), round.contains(&self.form)),
            ("--angle", self.angle.is_some(), self.form == Form::Cone),
            ("--amplitude", self.amplitude.is_some(), self.form == Form::Wave),
            ("--periods", self.periods.is_some(), self.form == Form::Wave && self.periods.is_some()),
        ] {
            match (given, needed) {
                (true, false) => return Err(format!("--form {} has no {name}: leave it out", self.form).into()),
                (false, true) => return Err(format!("--form {} lacks {name}: give it", self.form).into()),
                _ => {}
            }
        }
        Ok(())
    }

    /// The surface of the form with `roughness` on it, of the shape of the grid; nodes beyond the body are absent.
    pub fn surface(&self, grid: Grid, roughness: Option<Surface>) -> Outcome<Surface> {
        let flat = self.form == Form::SelfAffine && self.tilt.is_none();
        if let (true, Some(roughness)) = (flat, &roughness) {
            return Ok(roughness.clone());
        }
        let mut heights = self.heights(&grid)?;
        if let Some(roughness) = roughness {
            heights += roughness.heights();
        }
        Ok(Surface::with_absent(grid, heights)?)
    }

    /// The heights of the form, NaN beyond the body.
    fn heights(&self, grid: &Grid) -> Outcome<Array2<f64>> {
        let [radius, amplitude] =
            [self.radius, self.amplitude].map(|quantity| quantity.map_or(0.0, |quantity| quantity.value));
        let slope = self.angle.unwrap_or_default().to_radians().tan();
        let (mx, my) = pair(self.periods.as_deref()).unwrap_or((1, 0));
        let ((nx, ny), (lx, ly)) = (grid.shape(), grid.lengths());
        for (name, periods, nodes) in [("MX", mx, nx), ("MY", my, ny)] {
            if self.form == Form::Wave && 2 * periods as usize > nodes {
                let most = nodes / 2;
                return Err(format!("--periods {name} is {periods}: {nodes} nodes resolve {most} at most").into());
            }
        }
        let (along_x, along_y) = pair(self.tilt.as_deref()).unwrap_or_default();
        let form = |x: f64, y: f64| {
            let r2 = x * x + y * y;
            match self.form {
                Form::SelfAffine => 0.0,
                // without the cancellation of nearly equal lengths
                Form::Sphere => -r2 / (radius + (radius * radius - r2).sqrt()),
                Form::Paraboloid => -r2 / (2.0 * radius),
                Form::Cone => -slope * r2.sqrt(),
                Form::Wave => amplitude * (TAU * f64::from(mx) * x / lx).cos() * (TAU * f64::from(my) * y / ly).cos(),
                Form::FlatPunch => {
                    if r2 <= radius * radius {
                        0.0
                    } else {
                        f64::NAN
                    }
                }
            }
        };
        Ok(grid.sample(|x, y| form(x, y) + along_x * x + along_y * y))
    }
}

impl fmt::Display for Form {
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

/// An angle between 0 and 90 degrees.
fn acute(text: &str) -> Result<f64, String> {
    match text.trim().parse() {
        Ok(angle) if angle > 0.0 && angle < 90.0 => Ok(angle),
        _ => Err("it must be a number of degrees, positive and below 90".to_owned()),
    }
}
