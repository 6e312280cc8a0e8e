//! The adhesion laws by their names, each with its description, its parameters and its construction.

use std::path::Path;

use asperity::adhesion::Formula;
use asperity::{Error, Exponential, Jkr, LennardJones, MaugisDugdale, Morse, NoAdhesion, PowerLaw, Result, Tabulated};
use asperity_maps::io::read_field;
use ndarray::Array2;

use crate::key::{Adhesion, AdhesionKeys, Key, Keys, Skin, Wall, needed, worded};

/// An adhesion law by its name.
pub struct Law {
    /// The name in options and reports.
    pub name: &'static str,
    /// The formula over the gap g, attraction positive.
    pub formula: &'static str,
    /// The keys of the parameters that it needs, of [`AdhesionKeys`].
    pub needs: &'static [&'static str],
    /// A remark on the parameters.
    pub remark: &'static str,
    /// The source.
    pub source: &'static str,
    /// Whether it never ends, so that it can be cut off.
    pub never_ends: bool,
    /// Whether the grid sets its range, so that it has none of its own.
    pub of_grid: bool,
    /// Whether it repels surfaces that come too close, so that they need no wall.
    pub repels: bool,
    /// The law of the parameters of an adhesion, or of its table.
    pub(crate) make: fn(&Adhesion, Option<&Tabulated>) -> Result<Formula>,
}

/// The key of the parameter that a map may take the place of.
pub(crate) const WORK: &str = "work_of_adhesion";

/// No law; other laws differ from it in the fields that they name.
const NONE: Law = Law {
    name: "none",
    formula: "no adhesion",
    needs: &[],
    remark: "",
    source: "",
    never_ends: false,
    of_grid: false,
    repels: false,
    make: |_, _| Ok(NoAdhesion.into()),
};

/// The adhesion laws.
pub static LAWS: [Law; 9] = [
    NONE,
    Law {
        name: "jkr",
        formula: "traction 2W/r (1 - x)^3 (1 + 3x + 6x^2), x = g/r < 1, with the shortest r that the grid resolves",
        needs: &[WORK],
        remark: "; the limit of no range, with r = sqrt(13 W dx/E*) on nodes dx apart",
        source: "Johnson, Kendall and Roberts, Proc. R. Soc. A 324 (1971)",
        of_grid: true,
        make: |of, _| Ok(Jkr::new(needed(of.work_of_adhesion)?)?.into()),
        ..NONE
    },
    Law {
        name: "maugis-dugdale",
        formula: "traction W/RHO for gaps below RHO, 0 beyond",
        needs: &[WORK, "range"],
        source: "Maugis, J. Colloid Interface Sci. 150 (1992)",
        make: |of, _| Ok(MaugisDugdale::new(needed(of.work_of_adhesion)?, needed(of.range)?)?.into()),
        ..NONE
    },
    Law {
        name: "exponential",
        formula: "traction W/RHO exp(-g/RHO)",
        needs: &[WORK, "range"],
        source: "Rey, Anciaux and Molinari, Comput. Mech. 60 (2017)",
        never_ends: true,
        make: |of, _| Ok(Exponential::new(needed(of.work_of_adhesion)?, needed(of.range)?)?.into()),
        ..NONE
    },
    Law {
        name: "lennard-jones",
        formula: "traction 8W/(3 RHO) (x^3 - x^9), x = RHO/g; with a wall, x = RHO/(RHO + g)",
        needs: &[WORK, "range"],
        remark: ", the equilibrium separation",
        source: "Greenwood, Proc. R. Soc. A 453 (1997); Yu and Polycarpou, J. Tribol. 126 (2004)",
        never_ends: true,
        repels: true,
        make: |of, _| {
            let law = LennardJones::new(needed(of.work_of_adhesion)?, needed(of.range)?)?;
            Ok(if of.wall == Wall::None { law } else { law.cut() }.into())
        },
        ..NONE
    },
    Law {
        name: "morse",
        formula: "traction 2W/RHO (exp(-g/RHO) - exp(-2g/RHO))",
        needs: &[WORK, "range"],
        source: "Morse, Phys. Rev. 34 (1929), as a law between surfaces",
        never_ends: true,
        repels: true,
        make: |of, _| Ok(Morse::new(needed(of.work_of_adhesion)?, needed(of.range)?)?.into()),
        ..NONE
    },
    Law {
        name: "power",
        formula: "traction W/RHO (1 + g/(N RHO))^-(N + 1)",
        needs: &[WORK, "range", "exponent"],
        source: "as for forces between bodies that fall with a power of their distance",
        never_ends: true,
        make: |of, _| Ok(PowerLaw::new(needed(of.work_of_adhesion)?, needed(of.range)?, needed(of.exponent)?)?.into()),
        ..NONE
    },
    Law {
        name: "van-der-waals",
        formula: "traction A/(6 pi (RHO + g)^3)",
        needs: &["hamaker", "range"],
        remark: ", the distance in contact; cut off where retardation begins",
        source: "Israelachvili, Intermolecular and Surface Forces (2011), section 13",
        never_ends: true,
        make: |of, _| Ok(PowerLaw::van_der_waals(needed(of.hamaker)?, needed(of.range)?)?.into()),
        ..NONE
    },
    Law {
        name: "table",
        formula: "the monotone cubic through the points of a table of gaps and tractions",
        needs: &["law_table"],
        remark: ", lines of a gap and a traction",
        source: "Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5 (1984)",
        make: |_, table| match table {
            Some(table) => Ok(table.clone().into()),
            None => Err(Error::Unsuited { what: "law", reason: "it lacks its table: give gaps and tractions" }),
        },
        ..NONE
    },
];

impl Law {
    /// The law of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        LAWS.iter().find(|law| law.name == name)
    }

    /// The parameters with their symbols, in the words of a skin.
    pub fn parameters(&self, skin: Skin) -> String {
        let needed = Self::keys().filter(|key| self.needs.contains(&key.name));
        let told = |key: &Key| format!("{} {}", worded(&format!("{{{}}}", key.name), skin), key.kind.symbols.join(" "));
        let needed: Vec<_> = needed.map(told).collect();
        if needed.is_empty() { "none".to_owned() } else { needed.join(", ") + self.remark }
    }

    /// The keys of the parameters that laws need.
    pub(crate) fn keys() -> impl Iterator<Item = &'static Key> {
        AdhesionKeys::KEYS.iter().filter(|key| LAWS.iter().any(|law| law.needs.contains(&key.name)))
    }
}

/// The law of a table of gaps and tractions in a file, and the table.
///
/// # Errors
/// Errors of the file, and [`Error::File`] unless the table has two columns that make a law.
pub fn read_law(path: &Path) -> Result<(Tabulated, Array2<f64>)> {
    let table = read_field(path)?;
    if table.ncols() != 2 {
        let columns = table.ncols();
        return Err(Error::file(
            path,
            format!("has {columns} columns, not two: put a gap and a traction on each line"),
        ));
    }
    let [gaps, tractions] = [0, 1].map(|column| table.column(column).to_vec());
    let law = Tabulated::new(&gaps, &tractions).map_err(|error| Error::file(path, format!("is no law: {error}")))?;
    Ok((law, table))
}
