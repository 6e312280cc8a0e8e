//! `asperity sweep`: equilibria at a list of loads, as a table.

use std::path::PathBuf;

use asperity::Surface;
use asperity_scene::theories::Theories;
use asperity_scene::{Format, Kind, Outcome, Scalar, Scene, keys};
use serde_json::json;

use crate::command::Call;
use crate::pictures::PlotOptions;
use crate::printing::in_options;
use crate::table::{Fill, Table, TableOptions, format_of};

keys! {
    /// Solve a contact problem under many loads, one after the other.
    ///
    /// Each load starts from the solutions under the loads before it. Numbers may have units, all of them or none, as for
    /// asperity solve. Each load gives a row of the file: the load, the mean gap, the contact area and its statistics, the
    /// energies, and how the solve ended. contact_fraction counts nodes in contact; corrected_contact_fraction is the area
    /// within the contact edge, which gap and pressure locate between the nodes; clusters counts separate contacts, and
    /// largest_cluster the nodes of the largest. The same command continues an interrupted sweep, also after loads were
    /// added to the end of the list; the file is the same, byte for byte. For that it keeps FILE.state next to the file,
    /// which may be deleted at the end. asperity run FILE.scene.toml repeats or continues the sweep. With a hardness the
    /// surface keeps its plastic depth from load to load. Exits with 0 if all rows converged, 2 if not (they are still
    /// written), and 1 if the input is refused or the file cannot be written.
    ///
    /// # Examples
    ///   Contact area and stiffness against load, twenty loads over two decades:
    ///     asperity sweep --heights heights.npy --mean-pressures 1e-3:1e-1:20:log --stiffness \
    ///       --out area.csv --plot area.pdf
    ///   With units; rows and header are then in SI units:
    ///     asperity sweep --heights heights.npy --lengths 20um --modulus 70GPa \
    ///       --mean-pressures 1MPa:1GPa:12:log --out steel.csv
    ///   Approach and withdrawal with adhesion, eleven mean gaps each:
    ///     asperity sweep --heights heights.npy --law exponential --work-of-adhesion 1e-4 \
    ///       --range 4e-3 --mean-gaps 0.05:0.03:11,0.03:0.05:11 --out hysteresis.jsonl
    Options {
        "Output" {
            /// File for the rows, .csv or .jsonl (one JSON object per line)
            out: PathBuf = Kind::file().required(),
            /// Format of the file, whatever its name is
            format: Option<Format> = Kind::word(Format::words, &["FORMAT"]),
            /// Folder for the fields, made if needed: gap-0001.npy, pressure-0001.npy, contact_pressure-0001.npy and so on
            fields: Option<PathBuf> = Kind::folder(),
            /// Draw theories of the surface in the chart of {plot}: Persson's for the contact fraction and the mean gap,
            /// and that of Greenwood and Williamson for the contact fraction under light loads. Without adhesion, on a
            /// half-space with a periodic boundary
            theory: bool = Kind::switch().needs(&["plot"]),
        }
    }
}

/// Runs the command; whether all rows converged.
pub fn run(call: &Call<'_>) -> Outcome<bool> {
    let options = &call.scene.keys::<Options>();
    let Options { out, format, fields, .. } = options;
    let format = format.map_or_else(|| format_of(out, ", or give --format"), Ok)?;
    let table = TableOptions::new(call, out, format, fields.as_deref())?;
    call.processes.first(|| PlotOptions::new(call.scene).check(out, table.force))?;
    table.fill(options)
}

impl Fill for Options {
    fn theories(&self, surface: &Surface, scene: &Scene) -> Outcome<Option<Theories>> {
        self.theory.then(|| in_options(Theories::new(surface, scene))).transpose()
    }

    fn fill<T: Scalar>(&self, table: &mut Table<'_, T>) -> Outcome<bool> {
        let rows = table.solve()?;
        table.first(|| {
            PlotOptions::new(table.options.scene).draw(&rows, &table.rows.facts().units, table.theories.as_ref())
        })?;
        table.options.printing.report(|| table.report(json!({ "last": rows.last() })));
        Ok(table.converged(match table.searches() {
            true => "or leave out jumps",
            false => "or --tolerance",
        }))
    }
}
