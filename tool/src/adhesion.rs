//! The adhesion between the surfaces: its law with the parameters, where it varies, and the wall.

use std::fmt;
use std::path::PathBuf;

use asperity::adhesion::{CutOff, Varying};
use asperity::{
    AdhesionLaw, Error, Exponential, Grid, LennardJones, MaugisDugdale, Morse, NoAdhesion, PowerLaw, Real, Tabulated,
};
use asperity_maps::io::read_field;
use asperity_scene::{Wall, tabulated};
use clap::{Args, ValueEnum};
use ndarray::Array2;

use crate::allowed::positive;
use crate::heights;
use crate::numbers::plain;
use crate::outcome::Outcome;
use crate::processes::Processes;
use crate::quantity::{ENERGY, ENERGY_PER_AREA, LENGTH, Quantity};

/// The adhesion between the surfaces.
#[derive(Args)]
pub struct AdhesionOptions {
    /// Adhesion law; asperity laws tells what each is and what it needs
    #[arg(long, value_enum, default_value_t = Law::None, help_heading = "Adhesion")]
    pub law: Law,
    /// Work of adhesion, an energy per area
    #[arg(long, value_name = "W", allow_hyphen_values = true, value_parser = ENERGY_PER_AREA.non_negative())]
    #[arg(help_heading = "Adhesion")]
    pub work_of_adhesion: Option<Quantity>,
    /// Range of adhesion, a length; for lennard-jones and van-der-waals the distance of the surfaces in contact
    #[arg(long, value_name = "RHO", allow_hyphen_values = true, value_parser = LENGTH.positive())]
    #[arg(help_heading = "Adhesion")]
    pub range: Option<Quantity>,
    /// Exponent of the energy of a power law
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = positive, help_heading = "Adhesion")]
    pub exponent: Option<f64>,
    /// Hamaker's constant of van-der-waals, an energy
    #[arg(long, value_name = "A", allow_hyphen_values = true, value_parser = ENERGY.positive())]
    #[arg(help_heading = "Adhesion")]
    pub hamaker: Option<Quantity>,
    /// Table of a law: lines of a gap, rising from 0, and a traction, attraction positive, the last one 0
    #[arg(long, value_name = "FILE", help_heading = "Adhesion")]
    pub law_table: Option<PathBuf>,
    /// Gap at which a law that never ends is cut off, smoothly and with all of its work of adhesion
    #[arg(long, value_name = "D", allow_hyphen_values = true, value_parser = LENGTH.positive())]
    #[arg(help_heading = "Adhesion")]
    pub cut_off: Option<Quantity>,
    /// Work of adhesion at each node, in a file as for the heights and of their shape, in the place of one for all
    #[arg(long, value_name = "FILE", help_heading = "Adhesion")]
    pub work_of_adhesion_map: Option<PathBuf>,
    /// What keeps the surfaces apart: a rigid wall, or the repulsion of lennard-jones or morse alone
    #[arg(long, value_enum, default_value_t = Wall::Hard, help_heading = "Adhesion")]
    pub wall: Wall,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
pub enum Law {
    /// no adhesion
    None,
    /// constant traction W/RHO up to a gap of RHO
    MaugisDugdale,
    /// traction W/RHO exp(-gap/RHO)
    Exponential,
    /// powers 9 and 3 between half-spaces; with a wall at RHO, from which the gap then counts
    LennardJones,
    /// two exponentials, which repel at negative gaps
    Morse,
    /// energy -W (1 + gap/(N RHO))^-N
    Power,
    /// between half-spaces at RHO in contact, unretarded
    VanDerWaals,
    /// a monotone cubic through the points of a file
    Table,
}

/// The law that the options choose, with what their files hold.
pub struct Adhesion<'a> {
    options: &'a AdhesionOptions,
    law: Option<Tabulated>,
    /// The numbers of the table of the law
    pub table: Option<Array2<f64>>,
    /// The works of adhesion of the map
    pub works: Option<Works>,
}

/// Works of adhesion that vary over the surface, on its grid.
pub struct Works {
    grid: Grid,
    /// The rows that this process holds
    pub rows: Array2<f64>,
    most: f64,
    /// The node with the largest work of adhesion: μ_ρ is that of this node
    strongest: (usize, usize),
}

impl Works {
    fn new(grid: Grid, rows: Array2<f64>) -> asperity::Result<Self> {
        // of a law of one unit they are multiples of one
        let varying = Varying::on(&grid, MaugisDugdale::new(1.0, 1.0)?, rows.view())?;
        let (most, strongest) = (AdhesionLaw::<f64>::hints(&varying).work_of_adhesion, varying.strongest());
        Ok(Self { grid, rows, most, strongest })
    }

    /// The whole of them, on the first of the processes that share the grid, and nothing on the others.
    fn gathered(&self) -> Option<Self> {
        let rows = self.grid.gathered(&self.rows)?.into_owned();
        Some(Self { grid: self.grid.alone(), rows, ..*self })
    }
}

impl Law {
    /// The parameters, which it needs: their options.
    fn parameters(self) -> &'static [&'static str] {
        match self {
            Self::None => &[],
            Self::MaugisDugdale | Self::Exponential | Self::LennardJones | Self::Morse => {
                &["--work-of-adhesion", "--range"]
            }
            Self::Power => &["--work-of-adhesion", "--range", "--exponent"],
            Self::VanDerWaals => &["--hamaker", "--range"],
            Self::Table => &["--law-table"],
        }
    }

    /// Whether it never ends.
    fn never_ends(self) -> bool {
        !matches!(self, Self::None | Self::MaugisDugdale | Self::Table)
    }

    /// Whether it repels surfaces that come too close.
    fn repels(self) -> bool {
        matches!(self, Self::LennardJones | Self::Morse)
    }

    /// The formula, the parameters and the source, for people.
    pub fn description(self) -> [&'static str; 3] {
        match self {
            Self::None => ["no adhesion", "none", ""],
            Self::MaugisDugdale => [
                "traction W/RHO for gaps below RHO, 0 beyond",
                "--work-of-adhesion W, --range RHO",
                "Maugis, J. Colloid Interface Sci. 150 (1992)",
            ],
            Self::Exponential => [
                "traction W/RHO exp(-g/RHO)",
                "--work-of-adhesion W, --range RHO",
                "Rey, Anciaux and Molinari, Comput. Mech. 60 (2017)",
            ],
            Self::LennardJones => [
                "traction 8W/(3 RHO) (x^3 - x^9), x = RHO/g; with --wall hard, x = RHO/(RHO + g)",
                "--work-of-adhesion W, --range RHO, the equilibrium separation",
                "Greenwood, Proc. R. Soc. A 453 (1997); Yu and Polycarpou, J. Tribol. 126 (2004)",
            ],
            Self::Morse => [
                "traction 2W/RHO (exp(-g/RHO) - exp(-2g/RHO))",
                "--work-of-adhesion W, --range RHO",
                "Morse, Phys. Rev. 34 (1929), as a law between surfaces",
            ],
            Self::Power => [
                "traction W/RHO (1 + g/(N RHO))^-(N + 1)",
                "--work-of-adhesion W, --range RHO, --exponent N",
                "as of forces between bodies that fall with a power of their distance",
            ],
            Self::VanDerWaals => [
                "traction A/(6 pi (RHO + g)^3)",
                "--hamaker A, --range RHO, the distance in contact; --cut-off D where retardation begins",
                "Israelachvili, Intermolecular and Surface Forces (2011), section 13",
            ],
            Self::Table => [
                "the monotone cubic through the points of a table of gaps and tractions",
                "--law-table FILE, lines of a gap and a traction",
                "Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5 (1984)",
            ],
        }
    }
}

impl AdhesionOptions {
    /// Refuses a law without its parameters, parameters that are not those of the law, and a wall that does not fit.
    pub fn check(&self) -> Outcome<()> {
        let file = |path: &Option<PathBuf>| path.as_ref().map(|path| path.display().to_string());
        let number = |value: Option<Quantity>| value.map(|value| plain(value.value));
        let parameters = [
            ("--work-of-adhesion", number(self.work_of_adhesion), "an energy per area"),
            ("--range", number(self.range), "a length"),
            ("--exponent", self.exponent.map(|value| value.to_string()), "a number"),
            ("--hamaker", number(self.hamaker), "an energy"),
            ("--law-table", file(&self.law_table), "a file of gaps and tractions"),
        ];
        let (law, mapped) = (self.law, self.work_of_adhesion_map.is_some());
        if law == Law::None {
            let more = [
                ("--cut-off", number(self.cut_off), ""),
                ("--work-of-adhesion-map", file(&self.work_of_adhesion_map), ""),
            ];
            if let Some((name, Some(value), _)) = parameters.iter().chain(&more).find(|(_, value, _)| value.is_some()) {
                let remedy = "choose --law exponential or --law maugis-dugdale, or leave it out";
                return Err(format!("{name} is {value}, but there is no adhesion: {remedy}").into());
            }
        }
        for (name, value, what) in &parameters {
            let needed = law.parameters().contains(name) && !(mapped && *name == "--work-of-adhesion");
            match value {
                None if needed => return Err(format!("--law {law} lacks {name}: give it, {what}").into()),
                Some(_) if mapped && *name == "--work-of-adhesion" => {
                    let text = "--work-of-adhesion is given beside --work-of-adhesion-map, which says it at every node";
                    return Err(format!("{text}: leave one of them out").into());
                }
                Some(value) if !needed => {
                    return Err(format!("{name} is {value}, but --law {law} has no use for it: leave it out").into());
                }
                _ => {}
            }
        }
        if let (Some(distance), false) = (self.cut_off, law.never_ends()) {
            return Err(format!("--cut-off is {distance}, but --law {law} ends by itself: leave it out").into());
        }
        if self.wall == Wall::None && !law.repels() {
            return Err(format!(
                "--wall none leaves the surfaces to the law, but --law {law} does not repel: choose lennard-jones or \
                 morse, or --wall hard"
            )
            .into());
        }
        Ok(())
    }

    /// The law without a map of works of adhesion; reads its table.
    pub fn uniform(&self) -> Outcome<Adhesion<'_>> {
        let table = self.law_table.as_deref().map(read_field).transpose()?;
        let law = match (&self.law_table, &table) {
            (Some(path), Some(table)) => Some(tabulated(path, table)?),
            _ => None,
        };
        Ok(Adhesion { options: self, law, table, works: None })
    }

    /// Reads the files, of the map of works of adhesion the rows of the grid that this process holds.
    pub fn read(&self, grid: &Grid, processes: &Processes) -> Outcome<Adhesion<'_>> {
        let read = || {
            let rows = self.work_of_adhesion_map.as_deref();
            let rows = rows.map(|path| heights::rows_on("--work-of-adhesion-map", path, grid)).transpose()?;
            Ok((self.uniform()?, rows))
        };
        let (uniform, rows) = processes.agree(read())?;
        // whatever the laws refuse, before anything is solved; of the law itself, of any work of adhesion
        uniform.law::<f64>()?;
        let works = rows.map(|rows| Works::new(*grid, rows)).transpose();
        match (works.and_then(|works| uniform.with(works)), &self.work_of_adhesion_map) {
            (Err(error @ Error::Elsewhere { .. }), _) => Err(error.into()),
            (Err(error), Some(path)) => Err(Error::file(path, format!("does not fit the law: {error}")).into()),
            (accepted, _) => Ok(accepted?),
        }
    }
}

impl Adhesion<'_> {
    /// The same with works of adhesion, if the law accepts them.
    fn with(self, works: Option<Works>) -> asperity::Result<Self> {
        let adhesion = Self { works, ..self };
        adhesion.law::<f64>()?;
        Ok(adhesion)
    }

    /// The law; its parameters are there after [`AdhesionOptions::check`].
    pub fn law<T: Real>(&self) -> asperity::Result<Box<dyn AdhesionLaw<T>>> {
        let options = self.options;
        let most = self.works.as_ref().map(|works| works.most);
        let [work, range, hamaker] = [options.work_of_adhesion, options.range, options.hamaker]
            .map(|quantity| quantity.map_or(1.0, |quantity| quantity.value));
        let (work, exponent) = (most.unwrap_or(work), options.exponent.unwrap_or_default());
        match options.law {
            Law::None => Ok(Box::new(NoAdhesion)),
            Law::MaugisDugdale => self.varied(MaugisDugdale::new(work, range)?),
            Law::Exponential => self.ended(Exponential::new(work, range)?),
            Law::LennardJones => {
                let law = LennardJones::new(work, range)?;
                self.ended(if options.wall == Wall::Hard { law.cut() } else { law })
            }
            Law::Morse => self.ended(Morse::new(work, range)?),
            Law::Power => self.ended(PowerLaw::new(work, range, exponent)?),
            Law::VanDerWaals => self.ended(PowerLaw::van_der_waals(hamaker, range)?),
            Law::Table => match &self.law {
                Some(law) => self.varied(law.clone()),
                None => Ok(Box::new(NoAdhesion)),
            },
        }
    }

    /// The law, cut off where the options say.
    fn ended<T, L>(&self, law: L) -> asperity::Result<Box<dyn AdhesionLaw<T>>>
    where
        T: Real,
        L: AdhesionLaw<T> + AdhesionLaw<f64> + 'static,
    {
        match self.options.cut_off {
            Some(distance) => self.varied(CutOff::new(law, distance.value)?),
            None => self.varied(law),
        }
    }

    /// The law, with the work of adhesion of the map.
    fn varied<T, L>(&self, law: L) -> asperity::Result<Box<dyn AdhesionLaw<T>>>
    where
        T: Real,
        L: AdhesionLaw<T> + AdhesionLaw<f64> + 'static,
    {
        Ok(match &self.works {
            Some(works) => Box::new(Varying::on(&works.grid, law, works.rows.view())?),
            None => Box::new(law),
        })
    }

    /// The node with the largest work of adhesion, where that varies: μ_ρ is that of this node.
    pub fn strongest(&self) -> Option<(usize, usize)> {
        self.works.as_ref().map(|works| works.strongest)
    }

    /// The same on the first of the processes that share the grid, with the whole of the map, and nothing on the
    /// others.
    pub fn gathered(&self) -> Option<Self> {
        let works = self.works.as_ref().map(Works::gathered);
        let Self { options, law, table, .. } = self;
        match works {
            Some(None) => None,
            works => Some(Adhesion { options, law: law.clone(), table: table.clone(), works: works.flatten() }),
        }
    }
}

impl fmt::Display for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.to_possible_value().as_ref().map_or("", |value| value.get_name()))
    }
}
