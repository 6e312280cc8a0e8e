//! The state of a contact problem in one precision: its solver, its last solution, and the rows along loads.

use std::ops::ControlFlow;
use std::sync::Arc;

use asperity::contact::{Original, Region};
use asperity::solver::Iteration;
use asperity::{Control, Grid, Solution, Surface};
use asperity_maps::io::npz;
use asperity_plot::{LoadScale, distribution};
use asperity_scene::outcome::Outcome;
use asperity_scene::units::Units;
use asperity_scene::{
    Account, After, Asked, Course, Formula, Found, Inputs, Load, Posed, Scalar, Scene, Skin, Told, Way, check_finite,
    csv, gap_to_write, rows, shortfalls, warnings_of_input,
};
use ndarray::Array2;
use serde_json::{Map, Value, json};

use crate::engine::extremes;
use crate::given::reason;
use crate::lines::START;

/// The observer of a solve: it sees the nodes of the grid, each iteration, and the tolerance of the solve on it.
pub type Observe<'a> = &'a mut (dyn FnMut(usize, &Iteration, f64) + Send);

/// What was done to the heights before a solve.
pub struct Origin<'a> {
    /// The unit from which they were converted.
    pub converted_from: Option<&'a str>,
    /// The threshold by which scars were removed.
    pub scars_removed: Option<f64>,
}

/// A problem in one precision.
pub struct State<T: Scalar> {
    scene: Scene,
    surface: Arc<Surface>,
    formula: Formula,
    original: Option<Original>,
    inputs: Inputs,
    units: Units,
    /// Those of the input.
    warnings: Vec<Told>,
    scars_removed: Option<f64>,
    posed: Option<Posed<T>>,
    last: Option<Last<T>>,
    /// A gap from which to start that is of another problem.
    before: Option<Array2<T>>,
    /// The loads that are followed, to their end.
    course: Option<Course<T>>,
    /// The lines of the table of their states; none before they are followed.
    table: Vec<String>,
}

/// A solution with its account.
struct Last<T: Scalar> {
    found: Found<T>,
    account: Account,
    /// The gap from which an adhesive solve started, if that was not the default.
    start: Option<Array2<T>>,
}

/// A problem in either precision.
pub trait Solves {
    fn scene(&self) -> &Scene;
    fn gap(&self) -> Option<Array2<f64>>;
    fn full_pressure(&self, loads: &[Load]) -> Result<f64, String>;
    fn solve(
        &mut self,
        asked: &Asked,
        from_last: bool,
        quantities: Option<Value>,
        observe: Observe<'_>,
    ) -> Outcome<(Value, bool)>;
    fn begin(&mut self, way: Way, quantities: Option<Value>) -> Outcome<Value>;
    fn next(&mut self, observe: Observe<'_>) -> Outcome<Option<Value>>;
    fn field(&self, name: &str) -> Outcome<Vec<f32>>;
    fn regions(&self) -> Outcome<Vec<u8>>;
    fn histograms(&self, bins: usize) -> Outcome<Value>;
    fn file(&self, name: &str) -> Outcome<Vec<u8>>;
}

impl<T: Scalar> State<T> {
    /// The problem of a scene on a surface, with the origin of its heights; solves go on from a gap of `before`.
    pub fn new(
        scene: Scene,
        (surface, origin, original): (Surface, Origin<'_>, Option<Original>),
        inputs: Inputs,
        units: Units,
        before: Option<Array2<f64>>,
    ) -> Outcome<Self> {
        let formula = scene.adhesion.formula(None)?;
        let law = formula.clone().law::<T>();
        let warnings = warnings_of_input((&surface, origin.converted_from), &scene.elastic, &*law, &units);
        let before = before.filter(|gap| gap.dim() == surface.grid().shape()).map(T::field);
        let surface = Arc::new(surface);
        let scars_removed = origin.scars_removed;
        let (posed, last, course, table) = (None, None, None, Vec::new());
        Ok(Self {
            scene,
            surface,
            formula,
            original,
            inputs,
            units,
            warnings,
            scars_removed,
            posed,
            last,
            before,
            course,
            table,
        })
    }

    /// The problem as it has solved nothing yet.
    fn fresh(&self) -> asperity::Result<Posed<T>> {
        self.scene.posed(self.surface.clone(), self.formula.clone().law(), None, self.original)
    }

    /// The problem anew, with the slopes of its surface for the inputs.
    fn anew(&mut self) -> Outcome<Posed<T>> {
        let mut posed = self.fresh()?;
        self.inputs.slopes = posed.slopes()?;
        Ok(posed)
    }

    /// The last solution.
    fn last(&self) -> Outcome<&Last<T>> {
        Ok(self.last.as_ref().ok_or("nothing is solved yet: solve first")?)
    }

    /// The account of what was found, with its warnings.
    fn account(&self, command: &'static str, found: &Found<T>) -> Outcome<Account> {
        let mut warnings = self.warnings.clone();
        warnings
            .extend(found.warnings(&self.warnings, self.scars_removed)?.iter().map(|warning| self.units.told(warning)));
        Ok(found.account(command, &self.inputs, None, warnings)?)
    }

    /// The grid of the results.
    fn shown(&self) -> Grid {
        self.original.map_or(*self.surface.grid(), |original| *original.grid())
    }

    /// The fields of a solution by their names, on the part of which results are.
    fn named(&self, solution: &Solution<T>) -> Outcome<Vec<(&'static str, Array2<T>)>> {
        let mut own = gap_to_write(solution).into_owned();
        let heights = self.part(self.surface.heights().to_owned())?;
        own.zip_mut_with(&heights, |gap, height| *gap += T::lit(*height));
        solution.plastic_depth.iter().for_each(|depth| own -= depth);
        let fields = [
            ("gap", Some(gap_to_write(solution).into_owned())),
            ("pressure", Some(solution.pressure.clone())),
            ("contact_pressure", Some(solution.contact_pressure.clone())),
            ("displacement", Some(own)),
            ("plastic_depth", solution.plastic_depth.clone()),
        ];
        Ok(fields.into_iter().filter_map(|(name, field)| Some((name, field?))).collect())
    }

    /// A field on the part of which results are.
    fn part<A: Clone>(&self, field: Array2<A>) -> Outcome<Array2<A>> {
        Ok(self.original.map_or_else(|| Ok(field.clone()), |original| original.of(field.view()))?)
    }

    /// The answer to a solve.
    fn answer(&self, last: &Last<T>) -> Outcome<Value> {
        let (account, part) = (&last.account, last.found.part()?);
        let of = |field: &Array2<T>| extremes(field.iter().map(|value| value.widen()));
        let pressure = if self.scene.adhesion.adheres() { &part.pressure } else { &part.contact_pressure };
        let [tension, compression] = [-1.0, 1.0].map(|sign| {
            let values: Vec<f64> = pressure.iter().map(|value| sign * value.widen()).collect();
            LoadScale::of(&values, None).end
        });
        let rows = rows(&[account], &self.units, Skin::Keywords);
        let rows: Vec<_> = rows.into_iter().map(|(name, texts)| (name, texts.concat())).collect();
        let mut ends = Map::from_iter([
            ("gap".to_owned(), json!(of(&part.gap))),
            ("pressure".to_owned(), json!(of(&part.pressure))),
            ("contact_pressure".to_owned(), json!(of(&part.contact_pressure))),
        ]);
        ends.extend(part.plastic_depth.as_ref().map(|depth| ("plastic_depth".to_owned(), json!(of(depth)))));
        let told: Vec<_> = shortfalls(account, Skin::Keywords).into_iter().map(|(_, text)| text).collect();
        Ok(json!({
            "account": account,
            "rows": rows,
            "shortfalls": told,
            "shape": part.grid.shape(),
            "lengths": part.grid.lengths(),
            "unit": self.units.length,
            "pressure_unit": self.units.pressure,
            "extremes": ends,
            "limits": { "pressure": [-tension, compression] },
        }))
    }
}

impl<T: Scalar> Solves for State<T> {
    fn scene(&self) -> &Scene {
        &self.scene
    }

    fn gap(&self) -> Option<Array2<f64>> {
        let gap = self.last.as_ref().map(|last| &last.found.solution.gap).or(self.before.as_ref());
        gap.map(|gap| gap.mapv(T::widen))
    }

    fn full_pressure(&self, loads: &[Load]) -> Result<f64, String> {
        self.fresh().map_err(|error| error.to_string())?.full_pressure(loads)
    }

    fn solve(
        &mut self,
        asked: &Asked,
        from_last: bool,
        quantities: Option<Value>,
        observe: Observe<'_>,
    ) -> Outcome<(Value, bool)> {
        let shape = self.surface.grid().shape();
        let known = self.last.as_ref().map(|last| &last.found.solution.gap).or(self.before.as_ref());
        let started = known.is_some_and(|gap| from_last && gap.dim() == shape && asked.nested != Some(true));
        asked.check(&self.scene.adhesion, self.scene.method, started).map_err(reason)?;
        let known = self.last.take().map(|last| last.found.solution.gap).or(self.before.take());
        let start = known.filter(|_| started);
        // of the second of them nothing is of the first, and its nested grids need the surface
        let mut posed = match self.posed.take() {
            Some(posed) if started => posed,
            _ => self.anew()?,
        };
        self.inputs.given = quantities;
        self.inputs.initial_gap = started.then(|| START.to_owned());
        if started && self.scene.adhesion.yields() {
            let problem = posed.parts()?.1;
            let flat = Array2::zeros(problem.grid().field_shape());
            problem.flatten(flat.view())?;
        }
        let kept = start.clone().filter(|_| self.scene.adhesion.adheres());
        let start = start.or_else(|| posed.start_afar(&[asked.control]).map(T::field));
        let found = posed.solve(asked, start, &mut |grid, state, tolerance| {
            observe(grid.nodes(), state, tolerance);
            ControlFlow::Continue(())
        });
        self.posed = Some(posed);
        let mut found = found?;
        check_finite(&found.solution).map_err(reason)?;
        let mut account = self.account("solve", &found)?;
        found.sight.look_at(&mut account, &found.solution)?;
        let last = Last { found, account, start: kept };
        let mut answer = self.answer(&last)?;
        answer["started"] = if started { "last" } else { "default" }.into();
        self.last = Some(last);
        Ok((answer, started))
    }

    fn begin(&mut self, way: Way, quantities: Option<Value>) -> Outcome<Value> {
        let mut posed = self.anew()?;
        let loads: Vec<Control> = way.loads().to_vec();
        let course = Course::new(way, After::default())?.with(&self.scene.adhesion);
        let start = posed.start_afar(&loads).map(T::field);
        course.check(&mut posed)?;
        let columns = course.columns();
        (self.inputs.given, self.inputs.initial_gap) = (quantities, None);
        let control = loads.first().map_or("mean-pressure", |load| load.name());
        let names = self.units.columns(&columns, control, self.surface.grid().is_line());
        (self.posed, self.course, self.table) =
            (Some(posed), Some(course.starting_from(start)), vec![csv::header(&names)]);
        Ok(json!({ "columns": columns, "names": names, "warnings": self.warnings }))
    }

    fn next(&mut self, observe: Observe<'_>) -> Outcome<Option<Value>> {
        if self.table.is_empty() {
            return Err("there are no loads to follow: begin first".into());
        }
        // none at the end
        let Some((mut course, mut posed)) = self.course.take().zip(self.posed.take()) else { return Ok(None) };
        let (nodes, tolerance) = (self.surface.grid().nodes(), self.scene.tolerance());
        let found = course.next(&mut posed, &mut |state| {
            observe(nodes, state, tolerance);
            ControlFlow::Continue(())
        })?;
        self.posed = Some(posed);
        let Some(mut found) = found else { return Ok(None) };
        check_finite(&found.solution).map_err(reason)?;
        let account = self.account(course.command(), &found)?;
        let row = course.row(&mut found, account, None)?;
        let cells = row.cells(&course.columns());
        self.table.push(csv::line(&cells));
        let told: Vec<_> = shortfalls(&row.account, Skin::Keywords).into_iter().map(|(_, text)| text).collect();
        let pace = course.pace();
        let answer = json!({
            "row": cells,
            "warnings": row.account.warnings,
            "shortfalls": told,
            "share": pace.map(|pace| pace.share()),
            "told": pace.map(|pace| pace.told()),
        });
        self.last = Some(Last { found, account: row.account, start: None });
        self.course = Some(course);
        Ok(Some(answer))
    }

    fn field(&self, name: &str) -> Outcome<Vec<f32>> {
        let part = self.last()?.found.part()?;
        let field = match name {
            "gap" => gap_to_write(&part).into_owned(),
            "pressure" => part.pressure.clone(),
            "contact_pressure" => part.contact_pressure.clone(),
            other => {
                self.named(&part)?.into_iter().find_map(|(name, field)| (name == other).then_some(field)).ok_or_else(
                    || format!("{other} is no field of this solution: give gap, pressure or contact_pressure"),
                )?
            }
        };
        Ok(field.iter().map(|value| value.widen() as f32).collect())
    }

    fn regions(&self) -> Outcome<Vec<u8>> {
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

    fn histograms(&self, bins: usize) -> Outcome<Value> {
        let part = self.last()?.found.part()?;
        let positive = |field: &Array2<T>| {
            distribution(field.iter().map(|value| value.widen()).filter(|value| *value > 0.0), bins)
        };
        Ok(json!({ "gap": positive(&part.gap), "contact_pressure": positive(&part.contact_pressure) }))
    }

    fn file(&self, name: &str) -> Outcome<Vec<u8>> {
        match name {
            "report.json" => Ok(format!("{:#}\n", json!(self.last()?.account)).into_bytes()),
            "fields.npz" => {
                let fields = self.named(&*self.last()?.found.part()?)?;
                let fields: Vec<_> = fields.iter().map(|(name, field)| (*name, field.view())).collect();
                Ok(npz(&self.shown(), &fields)?)
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
