//! The course of a sweep or a cycle, and the rows of its table.

use std::borrow::Cow;
use std::ffi::OsStr;
use std::ops::ControlFlow;
use std::path::Path as File;

use asperity::path::{Event, Path, PathSettings};
use asperity::solver::Iteration;
use asperity::{Branch, ContactSearch, Control, Grid, Real, Result, Sweep};
use ndarray::{Array2, Axis, Slice};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use crate::account::entries::{Search, Step};
use crate::account::found::Found;
use crate::account::interface;
use crate::account::{Account, stiffness};
use crate::clock::Instant;
use crate::key::adhesion::Adhesion;
use crate::key::after::After;
use crate::key::boundary::Boundary;
use crate::session::pace::Pace;
use crate::session::posed::Posed;
use crate::session::way::Way;
use crate::table::identity::Identity;

/// The course of a sweep or a cycle: its way, and the place on it from which the next state follows.
#[derive(Clone, Debug)]
pub struct Course<T> {
    way: Way,
    /// Whether the surface yields
    yields: bool,
    /// Whether the law has the range of the grid
    of_grid: bool,
    /// The findings that are asked for after each state
    after: After,
    /// The mean gap at first touch, if its table is that of an interface
    touch: Option<f64>,
    place: Place<T>,
    /// The pace of a cycle
    pace: Option<Pace>,
}

/// The place on a course from which the next state follows. As data it goes on bit for bit.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Place<T> {
    strategy: Strategy<T>,
    /// The number of states so far, and of events
    states: usize,
    events: usize,
    /// The branch of the first state, in the table of an interface
    branch: Option<Branch>,
}

/// The strategy that finds the states.
#[derive(Clone, Debug, Serialize, Deserialize)]
enum Strategy<T> {
    Sweep(Sweep<T>),
    Search(ContactSearch<T>),
    Cycle(Box<Path<T>>),
}

/// The row of a state in a table: its account, and the figures that tables alone have.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The account, complete.
    #[serde(flatten)]
    pub account: Account,
    /// The approach of the mean planes since first touch, in the table of an interface.
    pub closure: Option<f64>,
    /// The number of separate contacts.
    pub clusters: usize,
    /// The nodes of the largest one.
    pub largest_cluster: usize,
    /// The name of the file of the heights, in the place of its path.
    pub heights: Option<String>,
    /// The seed of a random surface.
    pub seed: Option<u64>,
    /// The contact fraction that was wanted, if its load was searched for.
    pub wanted_contact_fraction: Option<f64>,
    /// Whether it was reached.
    pub reached: Option<bool>,
    /// The place on a cycle.
    #[serde(flatten)]
    pub step: Option<Step>,
    /// The cells of the columns for what is asked for after each state.
    #[serde(flatten)]
    pub after: Map<String, Value>,
}

const STATE: &str = "control control_value mean_pressure mean_contact_pressure mean_gap normal_force approach \
                     edge_traction contact_fraction corrected_contact_fraction perimeter clusters largest_cluster \
                     repulsive_fraction attractive_fraction elastic_energy adhesive_energy min_gap";
const OUTCOME: &str = "relative_error load_error iterations operator_applications status";
pub(crate) const INPUTS: &str = "modulus law work_of_adhesion range heights part seed";
const BALANCE: &str = "work dissipated imbalance event energy_drop";
const PLASTIC: &str = "hardness plastic_fraction plastic_depth_max plastic_depth_mean plastic_energy";

/// The contact by the adhesive energy, and in the limit of no range, of a law that has the range of the grid.
const LIMIT: &str = "adhesive_contact_fraction jkr_contact_fraction";

const WITHDRAWAL: &str = "withdrawal";

impl<T: Real> Place<T> {
    /// The fields, on the grid of the operator.
    fn fields(&mut self) -> Vec<&mut Array2<T>> {
        match &mut self.strategy {
            Strategy::Sweep(sweep) => sweep.fields().collect(),
            Strategy::Search(search) => search.fields().collect(),
            Strategy::Cycle(path) => path.fields().collect(),
        }
    }

    /// The place with whole fields, where processes share a grid; all of them have to ask.
    pub(crate) fn whole(&self, grid: &Grid) -> Cow<'_, Self> {
        if !grid.is_shared() {
            return Cow::Borrowed(self);
        }
        let mut place = self.clone();
        for field in place.fields() {
            *field = grid.whole(&*field).into_owned();
        }
        Cow::Owned(place)
    }

    /// The place with the rows of this process, of whole fields.
    pub(crate) fn shared(mut self, grid: &Grid) -> Self {
        if grid.is_shared() {
            self.fields()
                .into_iter()
                .for_each(|field| *field = field.slice_axis(Axis(0), Slice::from(grid.rows())).to_owned());
        }
        self
    }
}

impl<T: Real> Course<T> {
    /// A course from its beginning, with the findings that are asked for after each state.
    ///
    /// # Errors
    /// Those of [`Path::new`].
    pub fn new(way: Way, after: After) -> Result<Self> {
        let strategy = match &way {
            Way::Sweep(_) => Strategy::Sweep(Sweep::default()),
            Way::Search(_) => Strategy::Search(ContactSearch::default()),
            Way::Cycle(loads, settings) => Strategy::Cycle(Box::new(Path::new(loads.iter().copied(), *settings)?)),
        };
        let place = Place { strategy, states: 0, events: 0, branch: None };
        let pace = way.pace();
        Ok(Self { way, after, touch: None, yields: false, of_grid: false, place, pace })
    }

    /// The course with the table of an interface whose surfaces first touch at a mean gap.
    pub fn of_interface(self, touch: f64) -> Self {
        Self { touch: Some(touch), ..self }
    }

    /// The course of surfaces with this adhesion, which may yield.
    pub fn with(self, adhesion: &Adhesion) -> Self {
        let of_grid = adhesion.law().is_some_and(|law| law.of_grid);
        Self { yields: adhesion.yields(), of_grid, ..self }
    }

    /// The course from a gap in the place of the default start.
    pub fn starting_from(self, start: Option<Array2<T>>) -> Self {
        let Some(start) = start else { return self };
        let strategy = match self.place.strategy {
            Strategy::Sweep(_) => Strategy::Sweep(Sweep::starting_from(start)),
            Strategy::Search(_) => Strategy::Search(ContactSearch::starting_from(start)),
            Strategy::Cycle(path) => Strategy::Cycle(Box::new(path.starting_from(start))),
        };
        Self { place: Place { strategy, ..self.place }, ..self }
    }

    /// The course continued from the [place](Self::place) of another one, bit for bit.
    pub fn continuing(self, place: Place<T>) -> Self {
        let pace = self.pace.map(|pace| pace.behind(place.states, place.events));
        Self { place, pace, ..self }
    }

    /// The pace of a cycle.
    pub fn pace(&self) -> Option<&Pace> {
        self.pace.as_ref()
    }

    /// Takes the time of an operator application of the problem for what a cycle is likely to take.
    ///
    /// # Errors
    /// Those of [`Posed::seconds_of_application`].
    pub fn expect(&mut self, posed: &Posed<T>) -> Result<()> {
        let Some(pace) = &mut self.pace else { return Ok(()) };
        pace.expect(posed.seconds_of_application()?);
        Ok(())
    }

    /// The place from which the next state follows.
    pub fn place(&self) -> &Place<T> {
        &self.place
    }

    /// The name of the command.
    pub fn command(&self) -> &'static str {
        match self.way {
            Way::Cycle(..) => "cycle",
            _ if self.touch.is_some() => "interface",
            _ => "sweep",
        }
    }

    /// The names of the columns of its table.
    pub fn columns(&self) -> Vec<&'static str> {
        let stiffness = if self.after.stiffness { "contact_stiffness normal_stiffness" } else { "" };
        let (before, behind) = match self.way {
            _ if self.touch.is_some() => (vec![interface::COLUMNS], interface::OUTCOME),
            Way::Sweep(_) => (vec![STATE, OUTCOME, INPUTS, stiffness], ""),
            Way::Search(_) => (vec![STATE, OUTCOME, INPUTS, "wanted_contact_fraction reached", stiffness], ""),
            Way::Cycle(..) => (vec!["leg direction", STATE, BALANCE, OUTCOME, INPUTS, stiffness], ""),
        };
        let plastic = if self.yields { PLASTIC } else { "" };
        let limit = if self.of_grid { LIMIT } else { "" };
        let before = before.into_iter().chain([limit, plastic]).flat_map(str::split_whitespace);
        before.chain(self.after.columns()).chain(behind.split_whitespace()).collect()
    }

    /// The loads of the rows, where these are known before.
    pub fn loads(&self) -> Option<Vec<f64>> {
        match &self.way {
            Way::Search(fractions) => Some(fractions.clone()),
            Way::Sweep(loads) => Some(values(loads)),
            Way::Cycle(..) => None,
        }
    }

    /// The inputs on which the rows depend, beside those of the problem and the loads that are known before.
    pub(crate) fn identity(&self) -> Identity {
        let entries = match &self.way {
            Way::Cycle(loads, PathSettings { steps, smallest_step, imbalance, smooth, .. }) => json!({
                "control": kind(loads),
                "loads": listed(&values(loads)),
                "steps": steps.to_string(),
                "smallest_step": smallest_step.to_string(),
                "imbalance": imbalance.to_string(),
                "sharp": (!smooth).to_string(),
            }),
            way => json!({
                "control": if let Way::Sweep(loads) = way { kind(loads) } else { "contact-fraction".to_owned() },
                "stiffness": if self.after.stiffness { "asked for" } else { "left out" },
            }),
        };
        let mut entries = entries.as_object().cloned().unwrap_or_default();
        entries.extend(self.touch.map(|_| ("table".to_owned(), "interface".into())));
        entries.extend(self.after.identity().into_iter().map(|(key, value)| (key.to_owned(), value.into())));
        entries
    }

    /// Refuses a cycle that the problem does not have.
    ///
    /// # Errors
    /// Those of [`Posed::parts`] and [`Path::new`].
    pub fn check(&self, posed: &mut Posed<T>) -> Result<()> {
        let (solver, problem) = posed.parts()?;
        if let Strategy::Cycle(path) = &self.place.strategy { path.check(solver, problem) } else { Ok(()) }
    }

    /// The next state; none at the end, and where the solve on a cycle was stopped.
    ///
    /// # Errors
    /// Those of the solvers of the library; after one the place is lost.
    pub fn next(
        &mut self,
        posed: &mut Posed<T>,
        observe: &mut (dyn FnMut(&Iteration) -> ControlFlow<()> + Send),
    ) -> Result<Option<Found<T>>> {
        let (clock, boundary) = (Instant::now(), posed.boundary());
        let (solver, problem) = posed.parts()?;
        let Place { strategy, states, events, .. } = &mut self.place;
        if self.yields && *states == 0 {
            // another course, or a state that was not kept, may have flattened it
            problem.flatten(Array2::zeros(problem.grid().field_shape()).view())?;
        }
        let (solution, search, step) = match (strategy, &self.way) {
            (Strategy::Sweep(sweep), way) => {
                let Some(&load) = way.loads().get(*states) else { return Ok(None) };
                (sweep.next_observed(solver, problem, load, observe)?, None, None)
            }
            (Strategy::Search(search), Way::Search(fractions)) => {
                let Some(&fraction) = fractions.get(*states) else { return Ok(None) };
                let found = search.at_observed(solver, problem, fraction, observe)?;
                let searched = Search::of(fraction, &found);
                (found.solution, Some(searched), None)
            }
            (Strategy::Search(_), _) => return Ok(None),
            (Strategy::Cycle(path), way) => {
                if let Some(pace) = &mut self.pace {
                    pace.begin(path.share());
                }
                let Some(found) = path.next_observed(solver, problem, observe)? else { return Ok(None) };
                if let Some(pace) = &mut self.pace {
                    pace.add(path.share(), found.event.is_some(), clock.elapsed().as_secs_f64());
                }
                *events += usize::from(found.event.is_some());
                let step = Step {
                    leg: found.leg,
                    direction: direction(way.loads(), found.leg, boundary),
                    work: found.work,
                    dissipated: found.dissipated,
                    imbalance: found.imbalance,
                    event: found.event.as_ref().map(Event::name),
                    energy_drop: found.event.as_ref().and_then(Event::jump).map(|jump| jump.energy_drop),
                };
                (found.solution, None, Some(step))
            }
        };
        *states += 1;
        let found = Found { search, step, ..posed.found(solution, clock)? };
        posed.followed(found, &self.after).map(Some)
    }

    /// The row of the state that was found last, with its account, which a look completes. A withdrawal in which it is
    /// apart ends there.
    ///
    /// # Errors
    /// Those of [`Sight::look`](crate::Sight::look).
    pub fn row(&mut self, found: &mut Found<T>, mut account: Account, seed: Option<u64>) -> Result<Row> {
        let statistics = found.sight.look_at(&mut account, &found.solution)?;
        let (sizes, step) = (&statistics.cluster_sizes, found.step.clone());
        if self.touch.is_some() {
            // its own, or that of the first state, on which the others follow
            self.place.branch = account.branch.or(self.place.branch);
            account.branch = self.place.branch;
        }
        let shares = [Some(account.contact_fraction), account.attractive_fraction];
        let apart = step.as_ref().is_some_and(|step| step.direction == WITHDRAWAL) && shares == [Some(0.0); 2];
        if let Strategy::Cycle(path) = &mut self.place.strategy
            && apart
        {
            path.end_leg();
        }
        let heights = account.inputs.heights.as_deref().and_then(|path| File::new(path).file_name());
        Ok(Row {
            closure: self.touch.map(|touch| touch - account.mean_gap),
            clusters: sizes.len(),
            largest_cluster: sizes.first().copied().unwrap_or(0),
            heights: heights.map(OsStr::to_string_lossy).map(Into::into),
            seed,
            wanted_contact_fraction: account.search.map(|search| search.wanted),
            reached: account.search.map(|search| search.reached),
            step,
            after: found.after.cells(),
            account,
        })
    }
}

impl Row {
    /// The cells of the columns of these names. None of them depends on the clock.
    pub fn cells(&self, names: &[&str]) -> Map<String, Value> {
        let all = serde_json::to_value(self).unwrap_or_default();
        names.iter().map(|&name| (name.to_owned(), all[name].clone())).collect()
    }
}

/// The kind of some loads, with all that they have in common.
fn kind(loads: &[Control]) -> String {
    let name = loads.first().map_or("none", |load| load.name());
    let mut stiffnesses: Vec<_> = loads.iter().copied().filter_map(stiffness).collect();
    if stiffnesses.windows(2).all(|two| two[0] == two[1]) {
        stiffnesses.truncate(1);
    }
    if stiffnesses.is_empty() { name.to_owned() } else { format!("{name} of stiffness {}", listed(&stiffnesses)) }
}

/// The values of some loads.
fn values(loads: &[Control]) -> Vec<f64> {
    loads.iter().map(|load| load.value()).collect()
}

/// Numbers as text.
fn listed(numbers: &[f64]) -> String {
    numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(" ")
}

/// The direction of a leg of a cycle; the start has none.
fn direction(loads: &[Control], leg: usize, boundary: Boundary) -> &'static str {
    let Some(&[from, to]) = leg.checked_sub(1).and_then(|before| loads.get(before..=leg)) else { return "start" };
    // the loads under which bodies come together as they grow
    let pressing = match to {
        Control::MeanGap(_) => false,
        Control::Spring { .. } => boundary == Boundary::Free,
        _ => true,
    };
    if (to.value() > from.value()) == pressing { "approach" } else { WITHDRAWAL }
}
