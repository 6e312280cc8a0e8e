//! The course of a sweep or a cycle, and the rows of its table.

use std::borrow::Cow;

use asperity::path::{Path, PathEnd, PathSettings};
use asperity::{Branch, ContactSearch, Control, Error, Grid, Held, Real, Result, Sweep};
use ndarray::{Array2, Axis, Slice};
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::account::row::Kind;
use crate::account::{Account, Answer, Row, Search, Step, stiffness};
use crate::clock::Instant;
use crate::key::{Adhesion, After, Boundary, Scalar, Scene};
use crate::outcome::Outcome;
use crate::processes::Processes;
use crate::session::pace::Pace;
use crate::session::way::Way;
use crate::session::{OneGrid, Session, Watch};
use crate::table::identity::Identity;
use crate::table::journal::{damaged, refused};
use crate::table::{Opening, Table};

/// The course of a sweep or a cycle: its way, and the place on it from which the next state follows.
#[derive(Clone, Debug)]
pub(crate) struct Course<T> {
    way: Way,
    /// The findings that are asked for after each state
    after: After,
    /// The mean gap at first touch, if its table belongs to an interface
    touch: Option<f64>,
    place: Place<T>,
    /// Whether no state follows
    pub is_over: bool,
    /// The pace of a cycle
    pace: Option<Pace>,
}

/// The place on a course from which the next state follows. As data it continues bit for bit.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Place<T> {
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

    /// Where surfaces have not parted, on the grid of the operator.
    fn marks(&mut self) -> Vec<&mut Array2<bool>> {
        match &mut self.strategy {
            Strategy::Sweep(sweep) => sweep.marks().collect(),
            Strategy::Search(search) => search.marks().collect(),
            Strategy::Cycle(path) => path.marks().collect(),
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
        for marks in place.marks() {
            *marks = grid.whole(&*marks).into_owned();
        }
        Cow::Owned(place)
    }

    /// The place with the rows of this process, of whole fields.
    pub(crate) fn shared(mut self, grid: &Grid) -> Self {
        if grid.is_shared() {
            fn share<A: Clone>(field: &mut Array2<A>, grid: &Grid) {
                *field = field.slice_axis(Axis(0), Slice::from(grid.rows())).to_owned();
            }
            self.fields().into_iter().for_each(|field| share(field, grid));
            self.marks().into_iter().for_each(|marks| share(marks, grid));
        }
        self
    }
}

impl<T: Scalar> Course<T> {
    /// A course from its beginning, with the findings that are asked for after each state, with the table of an
    /// interface, if the mean gap of first touch is given, and with the loads on the whole map.
    ///
    /// # Errors
    /// As [`Path::new`].
    pub fn new(way: Way, after: After, touch: Option<f64>, on_whole: impl Fn(Control) -> Control) -> Result<Self> {
        let strategy = match &way {
            Way::Sweep(_) => Strategy::Sweep(Sweep::default()),
            Way::Search(_) => Strategy::Search(ContactSearch::default()),
            Way::Cycle(loads, settings) => {
                Strategy::Cycle(Box::new(Path::new(loads.iter().copied().map(on_whole), *settings)?))
            }
        };
        let place = Place { strategy, states: 0, events: 0, branch: None };
        let pace = match &way {
            Way::Cycle(loads, settings) => Some(Pace::new(loads.len().saturating_sub(1), settings)),
            _ => None,
        };
        Ok(Self { way, after, touch, place, is_over: false, pace })
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

    /// The figures of a cycle so far.
    pub fn end(&self) -> Option<PathEnd> {
        if let Strategy::Cycle(path) = &self.place.strategy { Some(path.end()) } else { None }
    }

    /// The pace of a cycle.
    pub fn pace(&self) -> Option<&Pace> {
        self.pace.as_ref()
    }

    /// Takes the time of an operator application of the problem for what a cycle is likely to take.
    ///
    /// # Errors
    /// As [`Session::seconds_of_application`].
    pub fn expect(&mut self, session: &Session<T>) -> Result<()> {
        let Some(pace) = &mut self.pace else { return Ok(()) };
        pace.expect(session.seconds_of_application()?, session.adheres());
        Ok(())
    }

    /// Opens a table of the course for a problem with an identity and fields on a grid, and returns it with the course
    /// from where its last row leads, or from a start.
    ///
    /// # Errors
    /// As [`Table::open`].
    pub fn open(
        self,
        opening: Opening,
        start: Option<Array2<T>>,
        nodes: &Grid,
        processes: &Processes,
    ) -> Outcome<(Table, Self)> {
        let identity = opening.identity.into_iter().chain(self.identity()).collect();
        let out = opening.out.clone();
        let (table, place) = Table::open(Opening { identity, ..opening }, processes)?;
        let Some(place) = place else { return Ok((table, self.starting_from(start))) };
        let place: Place<T> = postcard::from_bytes(&place).map_err(|_| refused(&out, damaged(&out)))?;
        let pace = self.pace.map(|pace| pace.behind(place.states, place.events));
        Ok((table, Self { place: place.shared(nodes), pace, ..self }))
    }

    /// Appends the row of the state that was found last to a table of fields on a grid.
    ///
    /// # Errors
    /// As [`Table::append`].
    pub fn append(
        &self,
        table: &mut Table,
        (found, row): (&Answer<T>, &Row),
        nodes: &Grid,
        processes: &Processes,
    ) -> Outcome<()> {
        let place = self.place.whole(nodes);
        let bytes = table.saves().then(|| Ok(postcard::to_stdvec(&place)?)).transpose();
        let place = processes.agree(bytes)?;
        table.append(row, place, &*found.part()?, processes)
    }

    /// The kind of its table.
    fn kind(&self) -> Kind {
        match self.way {
            Way::Cycle(..) => Kind::Cycle,
            _ if self.touch.is_some() => Kind::Interface,
            Way::Sweep(_) => Kind::Sweep,
            Way::Search(_) => Kind::Search,
        }
    }

    /// The name of the command.
    pub fn command(&self) -> &'static str {
        match self.way {
            Way::Cycle(..) => "cycle",
            _ if self.touch.is_some() => "interface",
            _ => "sweep",
        }
    }

    /// The names of the columns of its table, of surfaces with this adhesion.
    pub fn columns(&self, adhesion: &Adhesion) -> Vec<&'static str> {
        self.kind().columns(&self.after, adhesion)
    }

    /// The loads of the rows, where these are known before.
    pub fn loads(&self) -> Option<Vec<f64>> {
        match &self.way {
            Way::Search(fractions) => Some(fractions.clone()),
            Way::Sweep(loads) => Some(values(loads)),
            Way::Cycle(..) => None,
        }
    }

    /// The inputs on which the rows depend, besides the problem and the loads that are known before.
    pub(crate) fn identity(&self) -> Identity {
        let entries = match &self.way {
            Way::Cycle(loads, PathSettings { steps, smallest_step, imbalance, smooth, .. }) => json!({
                "control": kind(loads),
                "loads": listed(&values(loads)),
                "steps": steps.to_string(),
                "smallest_step": smallest_step.map(|step| step.to_string()),
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
    /// As [`Path::check`].
    pub fn check(&self, one: &OneGrid<T>) -> Result<()> {
        let periodic = one.facts.scene.elastic.boundary == Boundary::Periodic;
        if let (Way::Cycle(loads, _), true) = (&self.way, periodic)
            && loads.first().is_some_and(|load| load.holds() == Held::Approach)
        {
            // the compression of the whole is no part of the energy of waves
            let reason = "its balance of energy needs a free boundary: give mean gaps, or sweep the approaches";
            return Err(Error::Unsuited { what: "cycle by approaches", reason });
        }
        let Strategy::Cycle(path) = &self.place.strategy else { return Ok(()) };
        path.check(&one.solver, &one.problem)
    }

    /// The next state; none at the end, and where the solve on a cycle was stopped.
    ///
    /// # Errors
    /// Errors of the solvers of the library; after one the place is lost.
    pub fn next(&mut self, one: &mut OneGrid<T>, observe: Watch<'_>) -> Result<Option<Answer<T>>> {
        if self.is_over {
            return Ok(None);
        }
        let (clock, Scene { elastic, adhesion, .. }) = (Instant::now(), &one.facts.scene);
        let (boundary, yields) = (elastic.boundary, adhesion.yields());
        let Place { strategy, states, events, .. } = &mut self.place;
        let load = self.way.loads().get(*states).map(|load| one.facts.on_whole(*load));
        let OneGrid { solver, problem, .. } = &mut *one;
        if yields && *states == 0 {
            // another course, or a state that was not kept, may have flattened it
            problem.flatten(Array2::zeros(problem.grid().field_shape()).view())?;
        }
        let (solution, search, step) = match (strategy, &self.way) {
            (Strategy::Sweep(sweep), _) => {
                let Some(load) = load else { return Ok(None) };
                (sweep.next_observed(solver, problem, load, observe)?, None, None)
            }
            (Strategy::Search(search), Way::Search(fractions)) => {
                let Some(&fraction) = fractions.get(*states) else { return Ok(None) };
                let found = search.at_observed(solver, problem, fraction, observe)?;
                let searched = Search::record(fraction, &found);
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
                let step = Step::record(&found, direction(way.loads(), found.leg, boundary));
                (found.solution, None, Some(step))
            }
        };
        *states += 1;
        let found = Answer { search, step, ..one.examine(solution, clock)? };
        one.followed(found, &self.after).map(Some)
    }

    /// The row of the state that was found last, with its account, which a look completes. A withdrawal ends with a state
    /// that is apart and under hardly any of the greatest tension.
    ///
    /// # Errors
    /// As [`Sight::look`](crate::Sight::look).
    pub fn row(&mut self, found: &mut Answer<T>, mut account: Account, seed: Option<u64>) -> Result<Row> {
        let statistics = found.sight.look_at(&mut account, &found.solution)?;
        if self.touch.is_some() {
            // its own, or the branch of the first state, on which the others follow
            self.place.branch = account.branch.or(self.place.branch);
            account.branch = self.place.branch;
        }
        let shares = [account.contact_fraction, account.attractive_fraction];
        let apart = found.step.as_ref().is_some_and(|step| step.direction == WITHDRAWAL) && shares == [0.0; 2];
        if let Strategy::Cycle(path) = &mut self.place.strategy
            && apart
            && -account.mean_pressure <= FAINT * path.end().greatest_tension
        {
            path.end_leg();
        }
        let touch = match self.touch {
            // the nodes that face the surface bear the load, and give way by more than the mean of all
            Some(touch) => Some(touch + found.sight.facing_displacement(&account.inputs.elastic, &found.solution)?),
            None => None,
        };
        Ok(Row::record(found, &account, &statistics.cluster_sizes, touch, seed))
    }
}

/// The share of the greatest tension at which a withdrawal may end.
const FAINT: f64 = 1e-3;

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
    let pressing = match to.holds() {
        Held::MeanGap => false,
        Held::Spring(_) => boundary == Boundary::Free,
        _ => true,
    };
    if (to.value() > from.value()) == pressing { "approach" } else { WITHDRAWAL }
}
