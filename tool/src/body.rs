//! The elastic body beside its modulus: a layer, a coating, or a half-space.

use asperity::elastic::Base;
use asperity_scene::{Boundary, Elastic};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};

use crate::allowed::poisson;
use crate::quantity::{LENGTH, PRESSURE, Quantity};

/// The body that deforms, a half-space unless it is a layer or has a coating.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Body")]
pub struct BodyOptions {
    /// Thickness of an elastic layer on a rigid base, in the place of a half-space; needs --poisson
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = LENGTH.positive())]
    #[arg(conflicts_with = "coating")]
    layer: Option<Quantity>,
    /// Hold of the base on the layer: bonded, or sliding without friction [default: bonded]
    #[arg(long, value_parser = bases())]
    base: Option<Base>,
    /// Thickness of an elastic coating on the half-space, of which --modulus is that of the substrate; needs
    /// --coating-modulus, --coating-poisson and --poisson
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = LENGTH.positive())]
    coating: Option<Quantity>,
    /// Contact modulus E/(1 - nu^2) of the coating, a pressure
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = PRESSURE.positive())]
    coating_modulus: Option<Quantity>,
    /// Poisson's ratio of the coating
    #[arg(long, value_name = "NU", allow_hyphen_values = true, value_parser = poisson)]
    coating_poisson: Option<f64>,
    /// Poisson's ratio of the layer, or of the substrate under a coating
    #[arg(long, value_name = "NU", allow_hyphen_values = true, value_parser = poisson)]
    poisson: Option<f64>,
}

fn bases() -> impl TypedValueParser<Value = Base> {
    let base = |name: String| if name == "sliding" { Base::Sliding } else { Base::Bonded };
    PossibleValuesParser::new(["bonded", "sliding"]).map(base)
}

impl BodyOptions {
    /// The body of a boundary and a contact modulus.
    pub fn elastic(self, boundary: Boundary, modulus: f64) -> Elastic {
        let number = |given: Option<Quantity>| given.map(|given| given.value);
        Elastic {
            boundary,
            modulus,
            poisson: self.poisson,
            layer: number(self.layer),
            base: self.base.or(self.layer.is_some().then_some(Base::Bonded)),
            coating: number(self.coating),
            coating_modulus: number(self.coating_modulus),
            coating_poisson: self.coating_poisson,
            ..Elastic::default()
        }
    }
}
