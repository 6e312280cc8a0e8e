//! The state of a contact problem in one precision: its solver, its last solution, and the rows along loads.

use std::ops::ControlFlow;
use std::sync::Arc;

use asperity::contact::{Region, bulk_range};
use asperity::solver::Iteration;
use asperity::{Solution, Surface};
use asperity_maps::io::npz;
use asperity_plot::{Distribution, LoadScale};
use asperity_scene::{
    Account, After, Answer, Case, Inputs, Outcome, Part, Rows, Scalar, Session, Skin, Units, Way, csv, gap_to_write,
    rows, shortfalls,
};
use ndarray::Array2;
use serde_json::{Map as Object, Value, json};

use crate::lines::START;

/// The refusal of a state before there is a way.
pub const NOT_BEGUN: &str = "there are no loads to follow: begin first";

/// The observer of a solve: it sees the nodes of the grid, each iteration, and the tolerance of the solve on it.
pub type Observe<'a> = &'a mut (dyn FnMut(usize, &Iteration, f64) + Send);

/// The fields that a solution may have.
const FIELDS: [&str; 5] = ["gap", "pressure", "contact_pressure", "displacement", "plastic_depth"];

/// A problem in one precision.
pub struct State<T: Scalar> {
    session: Session<T>,
    surface: Arc<Surface>,
    part: Part,
    /// The states along loads, once they are followed.
    rows: Option<Rows<T>>,
    last: Option<Last<T>>,
    /// A gap from which to start that is of another problem.
    before: Option<Array2<T>>,
    /// The lines of the table of the states along loads; none before they are followed.
    table: Vec<String>,
}

/// A solution with its account.
struct Last<T: Scalar> {
    found: Answer<T>,
    account: Account,
    /// The gap from which an adhesive solve started, if that was not the default.
    start: Option<Array2<T>>,
}

impl<T: Scalar> State<T> {
    /// The session on a surface, of which a part is shown; solves continue from a gap of `before`.
    pub fn new(session: Session<T>, surface: Arc<Surface>, part: Part, before: Option<Array2<f64>>) -> Self {
        let before = before.filter(|gap| gap.dim() == surface.grid().shape()).map(T::field);
        Self { session, surface, part, rows: None, last: None, before, table: Vec::new() }
    }

    /// The gap of the last solution, or of another problem.
    pub fn gap(&self) -> Option<Array2<f64>> {
        self.known().map(|gap| gap.mapv(T::widen))
    }

    fn known(&self) -> Option<&Array2<T>> {
        self.last.as_ref().map(|last| &last.found.solution.gap).or(self.before.as_ref())
    }

    /// The last solution.
    fn last(&self) -> Outcome<&Last<T>> {
        Ok(self.last.as_ref().ok_or("nothing is solved yet: solve first")?)
    }

    /// A field of a solution by its name, on the part with results, if the solution has it.
    fn named(&self, name: &str, solution: &Solution<T>) -> Outcome<Option<Array2<T>>> {
        Ok(match name {
            "gap" => Some(gap_to_write(solution).into_owned()),
            "pressure" => Some(solution.pressure.clone()),
            "contact_pressure" => Some(solution.contact_pressure.clone()),
            "displacement" => {
                let mut own = gap_to_write(solution).into_owned();
                let heights = self.part(self.surface.heights().to_owned())?;
                own.zip_mut_with(&heights, |gap, height| *gap += T::lit(*height));
                solution.plastic_depth.iter().for_each(|depth| own -= depth);
                Some(own)
            }
            "plastic_depth" => solution.plastic_depth.clone(),
            _ => None,
        })
    }

    /// A field on the part with results.
    fn part<A: Clone>(&self, field: Array2<A>) -> Outcome<Array2<A>> {
        Ok(self.part.of_field(field)?)
    }

    /// The answer to a solve.
    fn answer(&self, last: &Last<T>, started: bool) -> Outcome<Value> {
        let (account, part) = (&last.account, last.found.part()?);
        let of = |field: &Array2<T>| extremes(field.iter().map(|value| value.widen()));
        let gaps = bulk_range(part.gap.iter().map(|value| value.widen()).filter(|gap| *gap > 0.0)).unwrap_or_default();
        let pressure =
            if self.session.facts.scene.adhesion.adheres() { &part.pressure } else { &part.contact_pressure };
        let [tension, compression] = [-1.0, 1.0].map(|sign| {
            let values: Vec<f64> = pressure.iter().map(|value| sign * value.widen()).collect();
            LoadScale::from_values(&values, None).end
        });
        let rows = rows(&[account], &self.session.facts.units, Skin::Keywords);
        let rows: Vec<_> = rows.into_iter().map(|(name, texts)| (name, texts.concat())).collect();
        let ends = [
            ("gap", Some(of(&part.gap))),
            ("pressure", Some(of(pressure))),
            ("contact_pressure", Some(of(&part.contact_pressure))),
            ("plastic_depth", part.plastic_depth.as_ref().map(&of)),
        ];
        let ends: Object<_, _> =
            ends.into_iter().filter_map(|(name, end)| Some((name.to_owned(), json!(end?)))).collect();
        let told: Vec<_> = shortfalls(account, Skin::Keywords).into_iter().map(|(_, text)| text).collect();
        Ok(json!({
            "account": account,
            "rows": rows,
            "shortfalls": told,
            "shape": part.grid.shape(),
            "lengths": part.grid.lengths(),
            "unit": self.session.facts.units.length,
            "pressure_unit": self.session.facts.units.pressure,
            "started": if started { "last" } else { "default" },
            "extremes": ends,
            "limits": { "pressure": [-tension, compression], "gap": gaps },
        }))
    }

    /// Solves under a load, from the last solution where there is one that fits.
    pub fn solve(&mut self, case: &Case, from_last: bool, observe: Observe<'_>) -> Outcome<(Value, bool)> {
        let shape = self.surface.grid().shape();
        let full = self.session.full_pressure(&[case.load()?])?;
        let nested = case.request(full, false)?.nested == Some(true);
        let started = self.known().is_some_and(|gap| from_last && gap.dim() == shape && !nested);
        let asked = &case.request(full, started)?;
        let adheres = case.scene().adhesion.adheres();
        let start = self.last.take().map(|last| last.found.solution.gap).or(self.before.take()).filter(|_| started);
        self.rows = None;
        let mut session = self.session.clone();
        let Inputs { given, initial_gap, .. } = &mut session.facts.inputs;
        (*given, *initial_gap) = (case.quantities().texts(), started.then(|| START.to_owned()));
        let kept = start.clone().filter(|_| adheres);
        let mut solved = session.solve(asked, start, &mut |grid, state, tolerance| {
            observe(grid.nodes(), state, tolerance);
            ControlFlow::Continue(())
        })?;
        solved.look()?;
        let last = Last { found: solved.found, account: solved.account, start: kept };
        let answer = self.answer(&last, started)?;
        self.last = Some(last);
        Ok((answer, started && adheres))
    }

    /// Begins a way through loads.
    pub fn begin(&mut self, case: &Case) -> Outcome<Value> {
        let (loads, mut session) = (case.loads()?, self.session.clone());
        let way = Way::cycle(&loads, session.full_pressure(&loads)?, case.given().path())?;
        let control = way.control(&session.facts.scene);
        session.facts.inputs.given = case.quantities().texts();
        let rows = self.rows.insert(session.begin(way, After::default(), false, None, None)?);
        let columns = rows.columns();
        let names = self.session.facts.units.columns(&columns, control.name(), self.surface.grid().is_line());
        self.table = vec![csv::header(&names)];
        Ok(json!({ "columns": columns, "names": names, "warnings": rows.facts().warnings.of_input() }))
    }

    /// The next state; none at the end.
    pub fn next(&mut self, observe: Observe<'_>) -> Outcome<Option<Value>> {
        let (nodes, tolerance) = (self.surface.grid().nodes(), self.session.facts.scene.tolerance());
        let rows = self.rows.as_mut().ok_or(NOT_BEGUN)?;
        let found = rows.next(&mut |state| {
            observe(nodes, state, tolerance);
            ControlFlow::Continue(())
        })?;
        let Some((found, row)) = found else { return Ok(None) };
        let cells = row.cells(&rows.columns());
        self.table.push(csv::line(&cells));
        let told: Vec<_> = shortfalls(&row.account, Skin::Keywords).into_iter().map(|(_, text)| text).collect();
        let pace = rows.pace();
        let answer = json!({
            "row": cells,
            "warnings": row.account.warnings,
            "shortfalls": told,
            "share": pace.map(|pace| pace.share()),
            "told": pace.map(|pace| pace.describe()),
        });
        self.last = Some(Last { found, account: row.account, start: None });
        Ok(Some(answer))
    }

    /// The limits of no range of the cycle at its end; nothing where no coarser grid tells them.
    pub fn cycle_limit(&mut self, observe: Observe<'_>) -> Outcome<Option<Value>> {
        let Some(rows) = &mut self.rows else { return Ok(None) };
        let nodes = rows.coarser_shape().map_or(0, |(nx, ny)| nx * ny);
        let tolerance = self.session.facts.scene.tolerance();
        let found = rows.cycle_limit(&mut |state| {
            observe(nodes, state, tolerance);
            ControlFlow::Continue(())
        })?;
        Ok(found.map(|limit| json!(limit)))
    }

    /// A field of the last solution.
    pub fn field(&self, name: &str) -> Outcome<Vec<f32>> {
        let field = self.named(name, &*self.last()?.found.part()?)?;
        let field = field
            .ok_or_else(|| format!("{name} is no field of this solution: give gap, pressure or contact_pressure"))?;
        Ok(field.iter().map(|value| value.widen() as f32).collect())
    }

    /// The nodes of the last solution by their contact.
    pub fn regions(&self) -> Outcome<Vec<u8>> {
        let solution = &self.last()?.found.solution;
        let regions = self.part(solution.regions())?;
        let depth = solution.plastic_depth.as_ref().map(|depth| self.part(depth.clone())).transpose()?;
        let mut yielded = depth.iter().flatten().map(|depth| *depth > T::zero());
        let code = |region: &Region| match (region, yielded.next()) {
            (_, Some(true)) => 4,
            (Region::Contact, _) => 1,
            (Region::Absent, _) => 2,
            (Region::Attractive, _) => 3,
            _ => 0,
        };
        Ok(regions.iter().map(code).collect())
    }

    /// The histograms of gap and contact pressure.
    pub fn histograms(&self, bins: usize) -> Outcome<Value> {
        let part = self.last()?.found.part()?;
        let Units { length, pressure, .. } = &self.session.facts.units;
        let positive = |field: &Array2<T>, unit: &Option<String>| {
            histogram(field.iter().map(|value| value.widen()).filter(|value| *value > 0.0), bins, unit.as_deref())
        };
        Ok(json!({
            "gap": positive(&part.gap, length),
            "contact_pressure": positive(&part.contact_pressure, pressure),
        }))
    }

    /// The bytes of a file to take away.
    pub fn file(&self, name: &str) -> Outcome<Vec<u8>> {
        match name {
            "report.json" => Ok(format!("{:#}\n", json!(self.last()?.account)).into_bytes()),
            "fields.npz" => {
                let part = self.last()?.found.part()?;
                let fields =
                    FIELDS.iter().map(|name| Ok((*name, self.named(name, &part)?))).collect::<Outcome<Vec<_>>>()?;
                let fields: Vec<_> =
                    fields.iter().filter_map(|(name, field)| Some((*name, field.as_ref()?.view()))).collect();
                Ok(npz(&self.part.grid(), &fields)?)
            }
            START => {
                let start = self.last()?.start.as_ref().ok_or("the last solve started from the default")?;
                Ok(npz(self.surface.grid(), &[("heights", start.view())])?)
            }
            "table.csv" if !self.table.is_empty() => Ok((self.table.join("\n") + "\n").into_bytes()),
            other => Err(format!("{other} is no file of this solution").into()),
        }
    }
}

/// The distribution of values with a unit, in so many classes.
pub fn histogram(values: impl Iterator<Item = f64> + Clone, classes: usize, unit: Option<&str>) -> Value {
    let Distribution { curve, beyond, .. } = Distribution::from_values(values, classes, unit);
    json!({ "curve": curve, "beyond": beyond })
}

/// The least and the greatest of the values that are finite; nothing of none.
pub fn extremes(values: impl Iterator<Item = f64>) -> (Option<f64>, Option<f64>) {
    let (low, high) = values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    (Some(low).filter(|low| low.is_finite()), Some(high).filter(|high| high.is_finite()))
}
